// Steps of an installation as plain data: this module touches no file and starts nothing.
import { posix, win32 } from "node:path";
import { pathToFileURL } from "node:url";

/** The distribution of the server, with the extra for videos. */
const DISTRIBUTION = "robbdd-tools[video]";

/** A package to install: its name for users, and its requirement for the installer. */
export interface Wanted {
  readonly name: string;
  readonly requirement: string;
}
export const OLDEST_PYTHON = [3, 11] as const;

/** A program with its arguments. */
export interface Step {
  /** Description for the user: "Installing …". */
  readonly title: string;
  readonly program: string;
  readonly args: readonly string[];
}

/** Creates environments: uv has its own installer, Python has venv and pip. */
export type Tool = { readonly kind: "uv"; readonly program: string } | { readonly kind: "python"; readonly program: string };

/**
 * The package to install: that of the setting `robbdd.server.package`, else the server of the extension's own version.
 *
 * @param wheel path of the unpacked wheel; without it the package index must have that version
 */
export function wantedPackage(setting: string, version: string, wheel?: string): Wanted {
  const own = `${DISTRIBUTION}==${version}`;
  const name = setting.trim() || own;
  const bundled = name === own && wheel !== undefined;
  return { name, requirement: bundled ? `${DISTRIBUTION} @ ${pathToFileURL(wheel).href}` : name };
}

/** Why a package name is invalid, or undefined. */
export function packageProblem(name: string): string | undefined {
  return name.startsWith("-")
    ? `The setting robbdd.server.package is "${name}": name a package or the path of a wheel, not an option of pip.`
    : undefined;
}

/** The steps that create an environment in a folder and install a package into it. */
export function installation(tool: Tool, folder: string, { name, requirement }: Wanted, platform: NodeJS.Platform): Step[] {
  const python = programIn(folder, "python", platform);
  const making = "Creating a Python environment";
  const installing = `Installing ${name}`;
  if (tool.kind === "uv") {
    const oldest = `>=${OLDEST_PYTHON.join(".")}`;
    return [
      { title: making, program: tool.program, args: ["venv", "--python", oldest, folder] },
      { title: installing, program: tool.program, args: ["pip", "install", "--python", python, "--", requirement] },
    ];
  }
  return [
    { title: making, program: tool.program, args: ["-I", "-m", "venv", folder] },
    {
      title: installing,
      program: python,
      args: ["-I", "-m", "pip", "install", "--disable-pip-version-check", "--no-input", "--progress-bar=off", "--", requirement],
    },
  ];
}

/** The path of a program in an environment. */
export function programIn(folder: string, name: string, platform: NodeJS.Platform): string {
  return platform === "win32" ? win32.join(folder, "Scripts", `${name}.exe`) : posix.join(folder, "bin", name);
}

/** Progress from an installer's output line, shortened for a notification; undefined for other lines. */
export function progressOf(line: string): string | undefined {
  const [, verb, rest] = /^\s*(Collecting|Downloading|Building|Prepared|Resolved|Installing)\s+(.*)$/.exec(line) ?? [];
  if (verb === undefined || rest === undefined) {
    return undefined;
  }
  if (verb === "Installing") {
    return "Unpacking the packages";
  }
  const [name = ""] = rest.split(/[\s<>=!~;([]/, 1);
  return /^(Prepared|Resolved)$/.test(verb) ? `${verb} ${rest}` : `${verb} ${name.split("/").at(-1) ?? name}`;
}

const KNOWN: readonly (readonly [RegExp, string])[] = [
  [
    /ensurepip is not available|No module named ensurepip/,
    "this Python cannot create environments. On Debian and Ubuntu: sudo apt install python3-venv",
  ],
  [/No space left on device|os error 28/i, "the disk is full"],
  [
    /NewConnectionError|Name or service not known|name resolution|dns error|timed out|ReadTimeout/i,
    "the package index cannot be reached. Is there a network, or a proxy to be set?",
  ],
  [/CERTIFICATE_VERIFY_FAILED|invalid peer certificate/i, "the package index's certificate is not trusted on this machine"],
];

/** Why a program failed: a known cause in plain words, else its own last error line. */
export function failureOf(step: Step, lines: readonly string[]): string {
  const known = KNOWN.find(([pattern]) => lines.some((line) => pattern.test(line)));
  if (known !== undefined) {
    return known[1];
  }
  const said = lines.map((line) => line.trim()).filter((line) => line !== "");
  const error = said.find((line) => /^(error|×)/i.test(line)) ?? said.at(-1);
  return error?.replace(/^(error:|×)\s*/i, "") ?? `${step.program} failed without an error message`;
}
