// A link that holds a scene: `#1.` and the base64url of compressed JSON.

const VERSION = "1";
/// The largest scene that is read from a link, in bytes.
const MAX_SIZE = 4 << 20;

/// Returns the fragment of a link.
export async function toFragment(shared) {
  const bytes = await piped(new TextEncoder().encode(JSON.stringify(shared)),
    new CompressionStream("deflate-raw"));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return `#${VERSION}.${text.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

/// Returns what a fragment holds, or null if it holds no scene. Throws if it is damaged.
export async function fromFragment(fragment) {
  const found = fragment.match(/^#(\d+)\.([\w-]+)$/);
  if (!found) return null;
  if (found[1] !== VERSION) throw new Error(`the link has version ${found[1]}; this page reads ${VERSION}`);
  try {
    const text = atob(found[2].replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
    const shared = JSON.parse(new TextDecoder().decode(
      await piped(bytes, new DecompressionStream("deflate-raw"))));
    return checked(shared);
  } catch {
    throw new Error("the link is damaged: it holds no scene");
  }
}

/// Returns the parts of a link that have the right types. Anyone can write a link.
function checked({ source, values, camera, time }) {
  if (typeof source !== "string") throw new Error("no scene");
  const numbers = (found, fits) =>
    Object.fromEntries(Object.entries(found ?? {}).filter(([, value]) => fits(value)));
  const isValue = (value) => {
    const lanes = [value].flat();
    return lanes.length > 0 && lanes.length <= 4 && lanes.every(Number.isFinite);
  };
  return {
    source,
    values: numbers(values, isValue),
    camera: numbers(camera, Number.isFinite),
    time: Number.isFinite(time) ? time : 0,
  };
}

async function piped(bytes, stream) {
  const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
  const parts = [];
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(parts).arrayBuffer());
    size += value.length;
    if (size > MAX_SIZE) throw new Error("too large");
    parts.push(value);
  }
}
