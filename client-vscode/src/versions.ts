// Versions of the parts: whether server and extension fit, and a text for a report.
import { isServerVersions } from "./answers/validators.mjs";

export interface Versions {
  readonly extension: string;
  /** undefined: no server runs. */
  readonly server: { readonly command: string; readonly version?: string | undefined } | undefined;
  /** The server's answer to `robbdd/versions`. An older server gives none. */
  readonly environment: unknown;
  /** Name and version of the editor. */
  readonly editor: string;
  readonly system: string;
}

/** Whether a server fits this extension: the same major and minor version. A version of another form fits. */
export function fits(server: string, extension: string): boolean {
  const [one, other] = [server, extension].map((version) => /^(\d+)\.(\d+)/.exec(version));
  return one == null || other == null || (one[1] === other[1] && one[2] === other[2]);
}

/** The beginning of a report: what happened, and what it happened with. */
export function reportText({ extension, server, environment, editor, system }: Versions): string {
  const served = server === undefined ? "not running" : `${server.version ?? "of unknown version"} (${server.command})`;
  const { python, mujoco } = isServerVersions(environment) ? environment : { python: "unknown", mujoco: "unknown" };
  return `# Issue with RobBDD

What I did:

What I expected:

What happened (with the model, or a part of it that shows it):

## Versions

- extension: ${extension}
- language server: ${served}
- Python: ${python}
- MuJoCo: ${mujoco ?? "not installed"}
- editor: ${editor}
- system: ${system}

## Log

(The last lines of *RobBDD: Show Log*. \`robbdd doctor\` in a terminal tests each part of the installation.)
`;
}
