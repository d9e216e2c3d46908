// The commands that run the program on the file of the active editor.

import { execFile } from "node:child_process";
import { dirname } from "node:path";
import * as vscode from "vscode";
import { program } from "./server";

/** The scene of the active editor; a message if there is none. */
export function scene(): vscode.TextDocument | undefined {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId === "sdf") return document;
  void vscode.window.showInformationMessage("sdfc: open a scene (a file that ends in .sdf) first.");
  return undefined;
}

/** Draws the scene into a file that the user chooses. */
export async function render(output: vscode.OutputChannel): Promise<void> {
  const document = await saved();
  if (!document) return;
  const file = document.uri.fsPath;
  const target = await vscode.window.showSaveDialog({
    defaultUri: vscode.Uri.file(file.replace(/\.sdf$/, "") + ".png"),
    filters: { Pictures: ["png", "exr"] },
    title: "Render to",
  });
  if (!target) return;
  const args = ["render", file, "-o", target.fsPath];
  const place = { location: vscode.ProgressLocation.Notification, cancellable: true };
  const done = await vscode.window.withProgress({ ...place, title: "sdfc: drawing" }, (_, token) =>
    run(args, file, output, token),
  );
  if (done !== 0) return failed(done, output);
  const chosen = await vscode.window.showInformationMessage(`sdfc: wrote ${target.fsPath}`, "Open");
  if (chosen) await vscode.commands.executeCommand("vscode.open", target);
}

/** Checks the scene as `sdfc check` does, which also samples the promises of its shapes. */
export async function check(output: vscode.OutputChannel): Promise<void> {
  const document = await saved();
  if (!document) return;
  const file = document.uri.fsPath;
  const done = await run(["check", file], file, output);
  if (done !== 0) return failed(done, output);
  void vscode.window.showInformationMessage("sdfc: the scene has no errors.");
}

/** The scene of the active editor, written to its file. */
async function saved(): Promise<vscode.TextDocument | undefined> {
  const document = scene();
  if (!document || !(await document.save())) return undefined;
  return document;
}

/** The exit status; undefined if it was cancelled. */
function run(
  args: string[],
  file: string,
  output: vscode.OutputChannel,
  token?: vscode.CancellationToken,
): Promise<number | undefined> {
  output.appendLine(`> ${program()} ${args.join(" ")}`);
  return new Promise((resolve) => {
    const child = execFile(program(), args, { cwd: dirname(file) }, (error, out, errors) => {
      output.append(out + errors);
      if (token?.isCancellationRequested) return resolve(undefined);
      if (error && typeof error.code !== "number") output.appendLine(error.message);
      resolve(error ? (typeof error.code === "number" ? error.code : 3) : 0);
    });
    token?.onCancellationRequested(() => child.kill("SIGINT"));
  });
}

function failed(status: number | undefined, output: vscode.OutputChannel): void {
  if (status === undefined) return;
  output.show(true);
  const why = status === 1 ? "the scene has errors" : `the program ended with status ${status}`;
  void vscode.window.showErrorMessage(`sdfc: ${why}; the output has the details.`);
}
