// The panels of previews, one for each scene.

import * as vscode from "vscode";
import { ResponseError } from "vscode-languageclient/node";
import type { FromPage, ToPage } from "./messages";
import type { Ask } from "./session";
import { Session } from "./session";
import type { Server } from "./server";

/** The most pixels on a side that the server draws. */
const MAX_SIDE = 2048;

export class Previews implements vscode.Disposable {
  private readonly open = new Map<string, { panel: vscode.WebviewPanel; session: Session }>();
  private readonly disposables: vscode.Disposable[] = [];

  constructor(
    private readonly context: vscode.ExtensionContext,
    private readonly server: Server,
  ) {
    // A change of an import changes the scene as well, also by another program.
    const changed = () => {
      for (const { session } of this.open.values()) session.changed();
    };
    const files = vscode.workspace.createFileSystemWatcher("**/*.sdf");
    this.disposables.push(
      files,
      files.onDidChange(changed),
      vscode.workspace.onDidChangeTextDocument((event) => {
        if (event.document.languageId === "sdf") changed();
      }),
      server.onDidStart(changed),
    );
  }

  /** Opens the preview of a scene beside its text, or shows the one that is open. */
  show(document: vscode.TextDocument): void {
    const key = document.uri.toString();
    const known = this.open.get(key);
    if (known) return known.panel.reveal(undefined, true);
    const name = document.uri.path.split("/").pop() ?? "scene";
    const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    const panel = vscode.window.createWebviewPanel("sdf.preview", `Preview ${name}`, place, {
      enableScripts: true,
      retainContextWhenHidden: true,
      localResourceRoots: ["dist", "media"].map((it) => this.file(it)),
    });
    const post = (message: ToPage) => void panel.webview.postMessage(message);
    const session = new Session(
      this.server.uri(document.uri),
      this.ask,
      {
        params: (params, values) => post({ kind: "params", params, values }),
        picture: (picture) => post({ kind: "picture", picture }),
        problem: (message) => post({ kind: "problem", message }),
      },
      () => vscode.workspace.getConfiguration("sdf").get("preview.delay", 150),
    );
    panel.webview.onDidReceiveMessage((message: FromPage) => void receive(session, message));
    panel.onDidDispose(() => {
      session.dispose();
      this.open.delete(key);
    });
    this.open.set(key, { panel, session });
    panel.webview.html = this.page(panel.webview);
  }

  dispose(): void {
    for (const { panel } of this.open.values()) panel.dispose();
    for (const it of this.disposables) it.dispose();
  }

  private readonly ask: Ask = async (method, params, signal) => {
    const source = new vscode.CancellationTokenSource();
    const cancel = () => source.cancel();
    signal.addEventListener("abort", cancel);
    try {
      return await this.server.request(method, params, source.token);
    } catch (error) {
      throw error instanceof ResponseError ? new Error(error.message) : error;
    } finally {
      signal.removeEventListener("abort", cancel);
      source.dispose();
    }
  };

  private file(...parts: string[]): vscode.Uri {
    return vscode.Uri.joinPath(this.context.extensionUri, ...parts);
  }

  private page(webview: vscode.Webview): string {
    const script = webview.asWebviewUri(this.file("dist", "panel.js")).toString();
    const style = webview.asWebviewUri(this.file("media", "panel.css")).toString();
    const policy =
      `default-src 'none'; img-src data:; style-src ${webview.cspSource}; ` +
      `script-src ${webview.cspSource}`;
    return `<!DOCTYPE html>
<html lang="en">
<head>
  <meta charset="utf-8">
  <meta http-equiv="Content-Security-Policy" content="${policy}">
  <link rel="stylesheet" href="${style}">
  <title>Preview</title>
</head>
<body>
  <div id="stage" tabindex="0" role="application"
    title="Drag to turn, Shift and drag to move, wheel to zoom, double click for the scene's camera">
    <img id="picture" alt="The scene">
  </div>
  <div id="controls"></div>
  <footer>
    <div id="status" role="status">Drawing…</div>
    <button id="reset" hidden title="Gives all params their defaults">Reset params</button>
    <button id="home" title="Shows the scene from its own camera">Reset camera</button>
  </footer>
  <script src="${script}"></script>
</body>
</html>`;
  }
}

function receive(session: Session, message: FromPage): Promise<void> {
  switch (message.kind) {
    case "ready":
    case "size":
      return session.resize(...fitted(message.width, message.height));
    case "set":
      return session.set(message.name, message.value);
    case "look":
      return session.look(message.camera ?? undefined);
    case "reset":
      return session.reset();
  }
}

/** The size of the picture for a page of this size: at most the setting on its longer side. */
function fitted(width: number, height: number): [number, number] {
  const setting = vscode.workspace.getConfiguration("sdf").get("preview.size", 640);
  const longest = Math.min(Math.max(setting, 16), MAX_SIDE);
  const factor = Math.min(1, longest / Math.max(width, height, 1));
  return [Math.max(1, Math.round(width * factor)), Math.max(1, Math.round(height * factor))];
}
