// Starts the language server, and registers the commands and the preview.

import * as vscode from "vscode";
import * as commands from "./commands";
import { Previews } from "./preview";
import { Server } from "./server";

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const output = vscode.window.createOutputChannel("sdfc commands");
  const server = new Server();
  const previews = new Previews(context, server);
  const command = (name: string, run: () => unknown) =>
    vscode.commands.registerCommand(`sdf.${name}`, run);
  context.subscriptions.push(
    output,
    server,
    previews,
    command("preview", () => {
      const document = commands.scene();
      if (document) previews.show(document);
    }),
    command("render", () => commands.render(output)),
    command("check", () => commands.check(output)),
    command("format", () => vscode.commands.executeCommand("editor.action.formatDocument")),
    command("restart", () => server.restart()),
    vscode.workspace.onDidChangeConfiguration((event) => {
      if (event.affectsConfiguration("sdf.path")) void server.restart();
    }),
  );
  // Without trust, a folder could name a program of its own.
  if (vscode.workspace.isTrusted) await server.start();
  else context.subscriptions.push(vscode.workspace.onDidGrantWorkspaceTrust(() => server.start()));
}
