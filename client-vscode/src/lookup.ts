// Locate the language server: a pure function of the editor's environment.
import { posix, win32 } from "node:path";

export const SERVER = "robbdd-lsp";

/** All inputs of the lookup; no other state is read. */
export interface Surroundings {
  /** The setting `robbdd.server.path` as the user wrote it. */
  readonly setting: string;
  /** Whether programs of the workspace may be started. */
  readonly trusted: boolean;
  /** File system paths of the workspace folders, in order. */
  readonly folders: readonly string[];
  /** The interpreter of the Python environment selected in the editor. */
  readonly python: string | undefined;
  /** The environment variable PATH. */
  readonly searchPath: string;
  /** The program in the environment created by the extension, if any. */
  readonly installed: string | undefined;
  readonly home: string;
  readonly platform: NodeJS.Platform;
  /** Whether a path names an executable file. */
  readonly isExecutable: (path: string) => boolean;
}

/** Origin of a server installed by the extension. */
export const OWN = "the extension's own environment";
export type Origin = "setting" | "Python environment" | ".venv of the workspace" | "PATH" | typeof OWN;

export type Lookup =
  | { readonly found: true; readonly command: string; readonly origin: Origin }
  | {
      readonly found: false;
      readonly problem: string;
      readonly tried: readonly string[];
      /** Whether installing the server would help. */
      readonly installable: boolean;
    };

interface Candidate {
  readonly path: string;
  readonly origin: Origin;
}

/**
 * Find the server: the setting, the selected Python environment, `.venv` of a workspace folder, PATH, the extension's
 * environment; the first that exists wins. An invalid setting is a problem of its own: a fallback would start another
 * server than the user requested.
 */
export function findServer(around: Surroundings): Lookup {
  const setting = around.setting.trim();
  if (setting !== "") {
    return fromSetting(setting, around);
  }
  const own: Candidate[] =
    around.installed === undefined ? [] : [{ path: around.installed, origin: OWN }];
  const candidates = [...fromWorkspace(around), ...fromSearchPath(around), ...own];
  const hit = candidates.find((candidate) => around.isExecutable(candidate.path));
  if (hit !== undefined) {
    return { found: true, command: hit.path, origin: hit.origin };
  }
  const trust = around.trusted
    ? ""
    : " The workspace is not trusted, so its own Python environment was not considered.";
  return {
    found: false,
    problem:
      `The RobBDD language server (${SERVER}) was not found. It can be installed ` +
      `into a Python environment for this extension only.${trust}`,
    tried: candidates.map((candidate) => candidate.path),
    installable: true,
  };
}

function fromSetting(setting: string, around: Surroundings): Lookup {
  const path = expand(setting, around);
  const wrong = (reason: string): Lookup => ({
    found: false,
    problem: `The setting robbdd.server.path is "${setting}", ${reason}. Correct it, or clear it to search for ${SERVER}.`,
    tried: [path],
    installable: false,
  });
  if (!pathsOf(around).isAbsolute(path)) {
    return wrong("which is not an absolute path");
  }
  return around.isExecutable(path)
    ? { found: true, command: path, origin: "setting" }
    : wrong("which is not a program that can be started");
}

function expand(setting: string, around: Surroundings): string {
  const paths = pathsOf(around);
  const path = setting.replaceAll("${workspaceFolder}", around.folders[0] ?? "${workspaceFolder}");
  return /^~(?=$|[/\\])/.test(path) ? paths.join(around.home, path.slice(1)) : path;
}

function fromWorkspace(around: Surroundings): Candidate[] {
  if (!around.trusted) {
    return [];
  }
  const paths = pathsOf(around);
  const scripts = around.platform === "win32" ? "Scripts" : "bin";
  const selected: Candidate[] =
    around.python === undefined
      ? []
      : [{ path: paths.join(scriptsBeside(around.python, around), program(around)), origin: "Python environment" }];
  const local = around.folders.map((folder): Candidate => ({
    path: paths.join(folder, ".venv", scripts, program(around)),
    origin: ".venv of the workspace",
  }));
  return [...selected, ...local];
}

/** On Windows, a base installation keeps its interpreter one folder above its scripts. */
function scriptsBeside(python: string, around: Surroundings): string {
  const folder = pathsOf(around).dirname(python);
  const beside = around.platform !== "win32" || /[/\\]Scripts$/i.test(folder);
  return beside ? folder : win32.join(folder, "Scripts");
}

function fromSearchPath(around: Surroundings): Candidate[] {
  return searchFolders(around).map((folder) => ({
    path: pathsOf(around).join(folder, program(around)),
    origin: "PATH",
  }));
}

/**
 * The folders of PATH from which programs may be started. Relative entries are skipped: they would mean the current
 * folder, and so perhaps the workspace.
 */
export function searchFolders(around: Surroundings): string[] {
  const paths = pathsOf(around);
  return around.searchPath
    .split(paths.delimiter)
    .filter((entry) => paths.isAbsolute(entry))
    .filter((entry) => around.trusted || !around.folders.some((folder) => contains(paths, folder, entry)));
}

function contains(paths: typeof posix, folder: string, path: string): boolean {
  const relative = paths.relative(folder, path);
  return relative === "" || (!relative.startsWith("..") && !paths.isAbsolute(relative));
}

function program(around: Surroundings): string {
  return around.platform === "win32" ? `${SERVER}.exe` : SERVER;
}

function pathsOf(around: Surroundings): typeof posix {
  return around.platform === "win32" ? win32 : posix;
}
