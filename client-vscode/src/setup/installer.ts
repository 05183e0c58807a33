// Create a private environment and install the server into it.
import { existsSync } from "node:fs";
import { homedir } from "node:os";
import { join } from "node:path";
import { SERVER } from "../lookup";
import { type PrivateServer, discard, freshFolder, recordInstalled } from "./environments";
import { runProgram } from "./processes";
import { OLDEST_PYTHON, type Step, type Tool, type Wanted, failureOf, installation, packageProblem, programIn, progressOf } from "./steps";

/** The server could not be installed; the message gives the reason for the user. */
export class InstallProblem extends Error {}

export interface Installation {
  /** The folder of the private environments. */
  readonly storage: string;
  readonly wanted: Wanted;
  /** Folders in which programs are searched, in this order. */
  readonly folders: readonly string[];
  /** The interpreter selected by the user. */
  readonly python: string | undefined;
  readonly signal: AbortSignal;
  /** Receives progress messages for the user. */
  readonly onProgress: (message: string) => void;
  /** Receives every output line of the programs. */
  readonly onLine: (line: string) => void;
}

const PYTHONS = ["python3", "python", "python3.14", "python3.13", "python3.12", "python3.11"];
const PROBE_LIMIT = 15_000;

/** Exits with 0 in an interpreter that is new enough. */
const PROBE = `import sys; sys.exit(sys.version_info < (${OLDEST_PYTHON.join(", ")}))`;

/** Install the server; raises `InstallProblem`. On failure or cancellation, everything created is deleted. */
export async function installServer(installation: Installation): Promise<PrivateServer> {
  const problem = packageProblem(installation.wanted.name);
  if (problem !== undefined) {
    throw new InstallProblem(problem);
  }
  const folder = freshFolder(installation.storage);
  try {
    return await installInto(folder, installation);
  } catch (error) {
    discard(folder);
    throw error;
  }
}

async function installInto(folder: string, { storage, signal, ...wishes }: Installation): Promise<PrivateServer> {
  const platform = process.platform;
  const { name, requirement } = wishes.wanted;
  wishes.onProgress("Looking for Python");
  const tool = await findTool(wishes.folders, wishes.python, storage, signal);
  for (const step of installation(tool, folder, { name, requirement: expandHome(requirement) }, platform)) {
    signal.throwIfAborted();
    wishes.onProgress(step.title);
    wishes.onLine(`> ${[step.program, ...step.args].join(" ")}`);
    await perform(step, storage, signal, (line) => {
      wishes.onLine(line);
      const progress = progressOf(line);
      if (progress !== undefined) {
        wishes.onProgress(progress);
      }
    });
  }
  const command = programIn(folder, SERVER, platform);
  if (!existsSync(command)) {
    throw new InstallProblem(`${name} was installed, but does not contain ${SERVER}`);
  }
  const server = { command, package: name };
  recordInstalled(storage, folder, server);
  return server;
}

async function perform(step: Step, cwd: string, signal: AbortSignal, onLine: (line: string) => void): Promise<void> {
  const { code, lines } = await runProgram(step.program, step.args, cwd, signal, onLine);
  signal.throwIfAborted();
  if (code !== 0) {
    throw new InstallProblem(failureOf(step, lines));
  }
}

/** uv if available: it is fast, and provides Python if there is none. Else a Python that is new enough. */
async function findTool(
  folders: readonly string[],
  selected: string | undefined,
  cwd: string,
  signal: AbortSignal,
): Promise<Tool> {
  const [uv] = existing(folders, "uv");
  if (uv !== undefined) {
    return { kind: "uv", program: uv };
  }
  const candidates = [...(selected === undefined ? [] : [selected]), ...PYTHONS.flatMap((name) => existing(folders, name))];
  for (const program of new Set(candidates)) {
    const limit = AbortSignal.any([signal, AbortSignal.timeout(PROBE_LIMIT)]);
    const { code } = await runProgram(program, ["-I", "-c", PROBE], cwd, limit);
    signal.throwIfAborted();
    if (code === 0) {
      return { kind: "python", program };
    }
  }
  const oldest = OLDEST_PYTHON.join(".");
  const older = candidates.length === 0 ? "" : `, only ${[...new Set(candidates)].join(", ")}`;
  throw new InstallProblem(`Neither uv nor Python ${oldest} or newer was found on PATH${older}. Install one of them.`);
}

function existing(folders: readonly string[], name: string): string[] {
  const file = process.platform === "win32" ? `${name}.exe` : name;
  return folders.map((folder) => join(folder, file)).filter((path) => existsSync(path));
}

function expandHome(wanted: string): string {
  return /^~(?=[/\\])/.test(wanted) ? join(homedir(), wanted.slice(1)) : wanted;
}
