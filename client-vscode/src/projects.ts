// Create projects from the server's templates.
import * as vscode from "vscode";
import { isNewProject, isTemplates } from "./answers/validators.mjs";
import type { Server } from "./client";
import { show } from "./models";
import { reach } from "./milestones";
import { complain, warn } from "./notices";

/** Ask for a template, a folder and a name, and open the first model of the created project. */
export async function newProject(server: Server): Promise<void> {
  if (!(await server.ready())) {
    return;
  }
  const answer = await server.request("robbdd/templates", {});
  if (!isTemplates(answer)) {
    warn("The RobBDD language server knows no templates. Is it of this version?");
    return;
  }
  const template = await vscode.window.showQuickPick(
    answer.map(({ name, about }) => ({ label: name, detail: about })),
    { title: "New RobBDD Project", placeHolder: "Which template?" },
  );
  const parent = template && (await chooseParent());
  const name = parent && (await askName(template.label));
  if (template === undefined || parent === undefined || name === undefined) {
    return;
  }
  const folder = vscode.Uri.joinPath(parent, name);
  const begun = await server.request("robbdd/newProject", { template: template.label, uri: folder.toString() });
  if (!isNewProject(begun) || begun.problem !== null) {
    complain(`No project was created: ${isNewProject(begun) ? begun.problem : "the server did not answer"}`);
    return;
  }
  reach("projectBegun");
  await open(folder, begun.models);
}

/** The workspace's only folder; else the user chooses. */
async function chooseParent(): Promise<vscode.Uri | undefined> {
  const [only, ...others] = vscode.workspace.workspaceFolders ?? [];
  if (only !== undefined && others.length === 0) {
    return only.uri;
  }
  const chosen = await vscode.window.showOpenDialog({
    canSelectFiles: false,
    canSelectFolders: true,
    openLabel: "Create the Project Here",
  });
  return chosen?.[0];
}

function askName(template: string): Thenable<string | undefined> {
  return vscode.window.showInputBox({
    title: "New RobBDD Project",
    prompt: "The name of its folder; its models' namespaces get this name as well.",
    value: template,
    // The window may take the focus, for example to tick a step of the walkthrough; that is no answer.
    ignoreFocusOut: true,
    validateInput: (value) => (/^[^/\\:*?"<>|]+$/.test(value.trim()) ? undefined : "A folder cannot have this name."),
  });
}

async function open(folder: vscode.Uri, [first]: readonly string[]): Promise<void> {
  if (first !== undefined) {
    await show(vscode.Uri.parse(first));
  }
  if (vscode.workspace.getWorkspaceFolder(folder) === undefined) {
    vscode.workspace.updateWorkspaceFolders(vscode.workspace.workspaceFolders?.length ?? 0, 0, { uri: folder });
  }
}
