//! Stores the oracle's verdicts between runs.

use std::fmt::Write;

use sdfc_graph::eval::FrameValues;

use crate::camera::Camera;
use crate::edges::Kind;
use crate::oracle::{Oracle, Verdict};
use crate::truth::Truth;

/// Version of the oracle and of the file layout. Increase it when either changes.
const VERSION: u32 = 2;
/// Number of pixels of a stored truth that are verified before it is used.
const TRIED: usize = 64;
const TAGS: [&[u8]; 2] = [b"HMU", b"peu"];

/// Storage for truths between runs. It may lose entries and fail: missing entries are computed
/// again, and stored ones are verified.
pub trait TruthStore: Sync {
    /// Returns the entry with this key of 32 hexadecimal digits.
    fn get(&self, key: &str) -> Option<Vec<u8>>;
    /// Stores an entry.
    fn put(&self, key: &str, bytes: &[u8]);
}

impl Truth {
    /// Loads the truth from a store, or computes it like [`Truth::find`] and stores it.
    pub fn load_or_find(
        store: &dyn TruthStore,
        oracle: &Oracle,
        frame: &FrameValues,
        camera: Camera,
        progress: &(dyn Fn(usize) + Sync),
    ) -> Self {
        let key = key(oracle, frame, &camera);
        let kept = store.get(&key).and_then(|bytes| read(&bytes, camera));
        if let Some(truth) = kept.filter(|truth| truth.holds(oracle, frame)) {
            progress(camera.pixels());
            return truth;
        }
        let truth = Self::find(oracle, frame, camera, progress);
        store.put(&key, &written(&truth));
        truth
    }

    /// Returns true if the oracle confirms the verdicts of evenly spaced pixels.
    fn holds(&self, oracle: &Oracle, frame: &FrameValues) -> bool {
        let mut prober = oracle.prober(frame);
        let step = self.verdicts.len().div_ceil(TRIED).max(1);
        let mut tried = self.verdicts.iter().enumerate().skip(step / 2).step_by(step);
        tried.all(|(pixel, verdict)| prober.first_hit(&self.camera.ray(pixel)).verdict == *verdict)
    }
}

/// Returns a hash of everything that a truth depends on: the field's program, the frame's values
/// and the camera.
fn key(oracle: &Oracle, frame: &FrameValues, camera: &Camera) -> String {
    let mut hash = Fnv::default();
    // Writing to a hash cannot fail. Numbers are written with all their digits.
    let _ = write!(hash, "{VERSION} {} {oracle:?} {frame:?} {camera:?}", env!("CARGO_PKG_VERSION"));
    format!("{:032x}", hash.0)
}

/// 128-bit FNV-1a of text.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Write for Fnv {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0100_0000_0000_0000_0000_013b);
        }
        Ok(())
    }
}

/// Serialises a truth: the number of evaluations; then verdict, kind and distance of each pixel.
fn written(truth: &Truth) -> Vec<u8> {
    let mut bytes = truth.evaluations.to_le_bytes().to_vec();
    for (verdict, kind) in truth.verdicts.iter().zip(&truth.kinds) {
        let (tag, t) = match *verdict {
            Verdict::Hit(t) => (0, t),
            Verdict::Miss => (1, 0.0),
            Verdict::Undecided(t) => (2, t),
        };
        let kind = match kind {
            Kind::Plain => 0,
            Kind::Edge => 1,
            Kind::Undecided => 2,
        };
        bytes.extend([TAGS[0][tag], TAGS[1][kind]]);
        bytes.extend(t.to_le_bytes());
    }
    bytes
}

/// Deserialises what [`written`] wrote for that camera; `None` if the bytes are invalid.
fn read(bytes: &[u8], camera: Camera) -> Option<Truth> {
    let (evaluations, pixels) = bytes.split_first_chunk::<8>()?;
    let (pixels, rest) = pixels.as_chunks::<10>();
    if pixels.len() != camera.pixels() || !rest.is_empty() {
        return None;
    }
    let place = |of: usize, tag: u8| TAGS[of].iter().position(|known| *known == tag);
    let found = pixels.iter().map(|[verdict, kind, t @ ..]| {
        let t = f64::from_le_bytes(*t);
        let verdict = match place(0, *verdict)? {
            0 => Verdict::Hit(t),
            1 => Verdict::Miss,
            _ => Verdict::Undecided(t),
        };
        let kind = match place(1, *kind)? {
            0 => Kind::Plain,
            1 => Kind::Edge,
            _ => Kind::Undecided,
        };
        Some((verdict, kind))
    });
    let (verdicts, kinds) = found.collect::<Option<Vec<_>>>()?.into_iter().unzip();
    Some(Truth { camera, verdicts, kinds, evaluations: u64::from_le_bytes(*evaluations) })
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicUsize, Ordering};

    use sdfc_graph::{Dim, Graph, Program};

    use super::*;

    #[derive(Default)]
    struct Memory {
        truths: Mutex<HashMap<String, Vec<u8>>>,
        puts: AtomicUsize,
    }

    impl TruthStore for Memory {
        fn get(&self, key: &str) -> Option<Vec<u8>> {
            self.truths.lock().ok()?.get(key).cloned()
        }

        fn put(&self, key: &str, bytes: &[u8]) {
            self.puts.fetch_add(1, Ordering::Relaxed);
            if let Ok(mut truths) = self.truths.lock() {
                truths.insert(key.to_owned(), bytes.to_vec());
            }
        }
    }

    fn ball(radius: f64) -> Result<Oracle, crate::oracle::OracleError> {
        let mut graph = Graph::new();
        let p = graph.point(0, Dim::Three);
        let (length, radius) = (graph.length(p), graph.number(radius));
        let distance = Some(graph.sub(length, radius));
        Oracle::new(&Program { graph, distance, ..Program::default() })
    }

    const CAMERA: Camera = Camera {
        size: [16, 12],
        parallel: false,
        eye: [0.0, 0.0, 3.0],
        forward: [0.0, 0.0, -1.0],
        right: [0.5, 0.0, 0.0],
        up: [0.0, 0.375, 0.0],
        t_max: 10.0,
        pixel_radius: 0.03,
    };

    #[test]
    fn stored_truths_are_found_by_their_inputs_and_verified()
    -> Result<(), crate::oracle::OracleError> {
        let (store, frame) = (Memory::default(), FrameValues::default());
        let truth = |oracle: &Oracle, camera: Camera| {
            Truth::load_or_find(&store, oracle, &frame, camera, &|_| ())
        };
        let found = truth(&ball(0.5)?, CAMERA);
        let same = |a: &Truth, b: &Truth| {
            a.verdicts == b.verdicts && a.kinds == b.kinds && a.evaluations == b.evaluations
        };
        assert!(same(&found, &Truth::find(&ball(0.5)?, &frame, CAMERA, &|_| ())));
        assert!(same(&found, &truth(&ball(0.5)?, CAMERA)));
        assert_eq!(store.puts.load(Ordering::Relaxed), 1, "the second was kept");

        assert!(!same(&found, &truth(&ball(0.6)?, CAMERA)), "another field");
        let nearer = truth(&ball(0.5)?, Camera { eye: [0.0, 0.0, 2.0], ..CAMERA });
        assert!(!same(&found, &nearer), "another camera");

        // The truth of another view, and a truncated one, are not used.
        let key = key(&ball(0.5)?, &frame, &CAMERA);
        for wrong in [written(&nearer), written(&found)[..100].to_vec(), Vec::new()] {
            store.put(&key, &wrong);
            assert!(same(&found, &truth(&ball(0.5)?, CAMERA)));
        }
        Ok(())
    }
}
