// Whether a program is sdfc.

import { execFile } from "node:child_process";

/** Why the program cannot be started; undefined if it can. */
export function fault(path: string): Promise<string | undefined> {
  return new Promise((resolve) => {
    execFile(path, ["--version"], { timeout: 10_000 }, (error, output) => {
      if (!error) resolve(output.startsWith("sdfc") ? undefined : "another program has this name");
      else if (error.code === "ENOENT") resolve("there is no such program");
      else resolve(error.message.split("\n")[0]);
    });
  });
}
