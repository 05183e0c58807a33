// Start the programs that install the server, and end them with their child processes.
import { type ChildProcess, spawn } from "node:child_process";
import { join } from "node:path";
import { createInterface } from "node:readline";

export interface Ending {
  /** 0 on success; undefined if the program could not be started or was ended. */
  readonly code: number | undefined;
  /** Output lines of both streams. */
  readonly lines: readonly string[];
}

/**
 * Run a program to its end; each line is passed to `onLine` as it arrives.
 *
 * @param folder the folder to run in: never one of the workspace, whose files must not be imported as modules
 */
export function runProgram(
  program: string,
  args: readonly string[],
  folder: string,
  signal: AbortSignal,
  onLine: (line: string) => void = () => undefined,
): Promise<Ending> {
  const lines: string[] = [];
  const note = (line: string): void => {
    lines.push(line);
    onLine(line);
  };
  return new Promise((resolve) => {
    // A separate process group, so that child processes of an installer end with it.
    const child = spawn(program, args, {
      cwd: folder,
      detached: process.platform !== "win32",
      stdio: ["ignore", "pipe", "pipe"],
      windowsHide: true,
      env: { ...withoutPython(process.env), PYTHONUNBUFFERED: "1", PYTHONIOENCODING: "utf-8" },
    });
    createInterface({ input: child.stdout }).on("line", note);
    createInterface({ input: child.stderr }).on("line", note);
    const end = (): void => {
      endGroup(child);
    };
    signal.addEventListener("abort", end, { once: true });
    if (signal.aborted) {
      end();
    }
    const finish = (code: number | undefined): void => {
      signal.removeEventListener("abort", end);
      resolve({ code, lines });
    };
    child.once("error", (error) => {
      note(error.message);
      finish(undefined);
    });
    child.once("close", (code) => {
      finish(code ?? undefined);
    });
  });
}

/**
 * The environment without Python's own variables. `PYTHONPATH`, `PYTHONHOME` and others could replace the installer's
 * modules; `-I` protects only one interpreter, not those that uv and pip start.
 */
function withoutPython(environment: NodeJS.ProcessEnv): NodeJS.ProcessEnv {
  return Object.fromEntries(Object.entries(environment).filter(([name]) => !/^PYTHON/i.test(name)));
}

function endGroup(child: ChildProcess): void {
  if (child.pid === undefined) {
    return;
  }
  if (process.platform === "win32") {
    // By its path: Windows searches a bare name in the working directory first.
    const taskkill = join(process.env["SystemRoot"] ?? "C:\\Windows", "System32", "taskkill.exe");
    spawn(taskkill, ["/pid", String(child.pid), "/t", "/f"], { windowsHide: true });
    return;
  }
  try {
    process.kill(-child.pid, "SIGKILL");
  } catch {
    // It has ended by itself.
  }
}
