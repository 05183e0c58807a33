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
  if (action !== "show" && !vscode.workspace.isTrusted) {
    complain("Nothing was run: studies run code of this workspace, which you do not trust yet.", {
      "Manage Workspace Trust": () => void vscode.commands.executeCommand("workbench.trust.manage"),
    });
    return;
  }
  const line = await server.commandLine();
  // The command line reads the disk.
  if (line === undefined || !(await vscode.workspace.saveAll(false))) {
    return;
  }
  const execution = new vscode.ProcessExecution(line.command, ["study", action, uri.fsPath], { cwd: dirname(uri.fsPath), env: line.env });
  const kind = { type: "robbdd", study: uri.fsPath, action };
  const task = new vscode.Task(kind, vscode.TaskScope.Workspace, TITLES[action], "RobBDD", execution);
  task.presentationOptions = { reveal: vscode.TaskRevealKind.Always, panel: vscode.TaskPanelKind.Dedicated, clear: true };
  await vscode.tasks.executeTask(task);
}
