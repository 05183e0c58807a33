// Contents of the status item, independent of the editor's interface so that it can be tested as a function.

export type ServerState =
  | { readonly kind: "starting" }
  | { readonly kind: "ready"; readonly command: string; readonly version?: string | undefined }
  | { readonly kind: "stopped" }
  | { readonly kind: "failed"; readonly problem: string }
  /** The server was not found, but can be installed. */
  | { readonly kind: "missing"; readonly problem: string }
  | { readonly kind: "installing" };

/** Result of an installation of the server; with a `problem` if it failed. */
export type Installed = { readonly kind: "installed" | "cancelled" } | { readonly kind: "failed"; readonly problem: string };

/** The state after an unsuccessful installation: the previous one, or why there is no server. */
export function afterInstallation(ended: Installed, before: ServerState): ServerState {
  return ended.kind === "failed" ? { kind: "missing", problem: notInstalled(ended.problem) } : before;
}

export function notInstalled(problem: string): string {
  return `The RobBDD language server could not be installed: ${problem}${/[.?!]$/.test(problem) ? "" : "."}`;
}

export interface RunProgress {
  readonly finished: number;
  readonly total: number;
}

export interface Presentation {
  readonly text: string;
  readonly tooltip: string;
  /** What a screen reader says; icons have no words. */
  readonly said: string;
  readonly severity: "normal" | "warning" | "error";
  /** The command executed on a click. */
  readonly command: "robbdd.showLog" | "robbdd.showRuns" | "robbdd.statusActions" | "robbdd.installServer";
}

/**
 * Describe the server's state and activity in one item.
 *
 * `runs` are the runs in progress; `summary` is that of the last finished run, empty if there was none.
 */
export function present(server: ServerState, runs: readonly RunProgress[], summary: string): Presentation {
  switch (server.kind) {
    case "starting":
      return item("$(sync~spin) RobBDD", "The RobBDD language server is starting.", "robbdd.showLog");
    case "stopped":
      return item("$(circle-slash) RobBDD", "The RobBDD language server is stopped.", "robbdd.statusActions");
    case "failed":
      return { ...item("$(error) RobBDD", server.problem, "robbdd.statusActions"), severity: "error" };
    case "missing":
      return {
        ...item("$(cloud-download) RobBDD", `${server.problem} Click to install it.`, "robbdd.installServer"),
        severity: "warning",
      };
    case "installing":
      return item("$(sync~spin) RobBDD", "The RobBDD language server is being installed.", "robbdd.showLog");
    case "ready":
      return runs.length > 0 ? running(runs) : idle(server.command, summary);
  }
}

/** Whether a progress token of the server is that of a run. */
export function isRunProgress(token: number | string): boolean {
  return String(token).startsWith("robbdd-run-");
}

function running(runs: readonly RunProgress[]): Presentation {
  const finished = runs.reduce((sum, run) => sum + run.finished, 0);
  const total = runs.reduce((sum, run) => sum + run.total, 0);
  const text = `$(loading~spin) RobBDD ${finished}/${total}`;
  const tooltip = "Scenarios that have ended, of all in this run. Click for the messages; RobBDD: Cancel Run ends it.";
  return { ...item(text, tooltip, "robbdd.showRuns"), said: `RobBDD: ${finished} of ${total} scenarios have ended.` };
}

function idle(command: string, summary: string): Presentation {
  const server = `The RobBDD language server is ready (${command}).`;
  return summary === ""
    ? item("$(check) RobBDD", server, "robbdd.showLog")
    : item("$(check) RobBDD", `Last run: ${summary}\n\n${server}`, "robbdd.showRuns");
}

function item(text: string, tooltip: string, command: Presentation["command"]): Presentation {
  return { text, tooltip, said: `RobBDD: ${tooltip}`, severity: "normal", command };
}
