// The program `sdfc` and its language server.

import * as vscode from "vscode";
import { type CancellationToken, LanguageClient } from "vscode-languageclient/node";
import { fault } from "./fault";

const INSTALL = "https://github.com/sdfc/sdfc#start";

/** The program, as the settings name it. */
export function program(): string {
  return vscode.workspace.getConfiguration("sdf").get("path", "sdfc").trim() || "sdfc";
}

export class Server implements vscode.Disposable {
  private client: LanguageClient | undefined;
  private readonly started = new vscode.EventEmitter<void>();
  readonly onDidStart = this.started.event;

  /** Starts the server. If that is not possible, a message says why and what to do. */
  async start(): Promise<void> {
    const path = program();
    const why = await fault(path);
    if (why) return void this.complain(path, why);
    // Naming stdio as the transport would add an argument `--stdio`.
    const run = { command: path, args: ["lsp"] };
    const client = new LanguageClient("sdf", "sdfc", { run, debug: run }, {
      documentSelector: [{ language: "sdf" }],
      initializationOptions: { hoverPictures: true },
    });
    this.client = client;
    try {
      await client.start();
      this.started.fire();
    } catch (error) {
      this.client = undefined;
      this.complain(path, error instanceof Error ? error.message : String(error));
    }
  }

  async restart(): Promise<void> {
    await this.stop();
    await this.start();
  }

  request(method: string, params: object, token: CancellationToken): Promise<unknown> {
    if (!this.client) throw new Error(`the language server is not running: ${program()} lsp`);
    return this.client.sendRequest(method, params, token);
  }

  /** A URI as the server knows it. */
  uri(uri: vscode.Uri): string {
    return this.client?.code2ProtocolConverter.asUri(uri) ?? uri.toString();
  }

  async dispose(): Promise<void> {
    this.started.dispose();
    await this.stop();
  }

  private async stop(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    if (client?.needsStop()) await client.stop();
  }

  private async complain(path: string, why: string): Promise<void> {
    const message =
      `sdfc: the program "${path}" cannot be started: ${why}. ` +
      `Install sdfc, or set "sdf.path" to the program. Colours and snippets work without it.`;
    const chosen = await vscode.window.showErrorMessage(message, "Open Settings", "How to Install");
    if (chosen === "Open Settings") {
      await vscode.commands.executeCommand("workbench.action.openSettings", "sdf.path");
    } else if (chosen === "How to Install") {
      await vscode.env.openExternal(vscode.Uri.parse(INSTALL));
    }
  }
}
