// Studies are executed by the command line, as a task in a terminal: they take hours, and their progress is text.
import { dirname } from "node:path";
import * as vscode from "vscode";
import type { Server } from "./client";
import { complain } from "./notices";

/** What the command line does with a study. */
export type StudyAction = "run" | "resume" | "show";

const TITLES: Readonly<Record<StudyAction, string>> = { run: "Run Study", resume: "Resume Study", show: "Results of Study" };

/** Execute a study, continue it, or print its results, in a terminal. An edited study is saved first. */
export async function executeStudy(server: Server, uri: vscode.Uri, action: StudyAction): Promise<void> {
  if (action === "show" || isTrusted()) {
    await begin(server, uri, TITLES[action], [action, uri.fsPath]);
  }
}

/**
 * Execute an execution of a study again, with a recording, and wait for its end. Returns the exit code: 0 if its verdicts
 * and margins are those of the study, 1 if not; undefined if it was not executed.
 */
export async function replayExecution(server: Server, uri: vscode.Uri, number: number): Promise<number | undefined> {
  if (!isTrusted()) {
    return undefined;
  }
  const ends = new Map<vscode.TaskExecution, number | undefined>();
  let heard: () => void = () => undefined;
  const listener = vscode.tasks.onDidEndTaskProcess(({ execution, exitCode }) => {
    ends.set(execution, exitCode);
    heard();
  });
  try {
    const begun = await begin(server, uri, "Replay of Study", ["replay", uri.fsPath, String(number)]);
    while (begun !== undefined && !ends.has(begun)) {
      await new Promise<void>((resolve) => {
        heard = resolve;
      });
    }
    return begun && ends.get(begun);
  } finally {
    listener.dispose();
  }
}

function isTrusted(): boolean {
  if (!vscode.workspace.isTrusted) {
    complain("Nothing was run: studies run code of this workspace, which you do not trust yet.", {
      "Manage Workspace Trust": () => void vscode.commands.executeCommand("workbench.trust.manage"),
    });
  }
  return vscode.workspace.isTrusted;
}

async function begin(server: Server, uri: vscode.Uri, title: string, args: readonly string[]): Promise<vscode.TaskExecution | undefined> {
  const line = await server.commandLine();
  // The command line reads the disk.
  if (line === undefined || !(await vscode.workspace.saveAll(false))) {
    return undefined;
  }
  const execution = new vscode.ProcessExecution(line.command, ["study", ...args], { cwd: dirname(uri.fsPath), env: line.env });
  const kind = { type: "robbdd", study: uri.fsPath, action: args[0] };
  const task = new vscode.Task(kind, vscode.TaskScope.Workspace, title, "RobBDD", execution);
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, panel: vscode.TaskPanelKind.Dedicated, clear: true };
  return vscode.tasks.executeTask(task);
}
