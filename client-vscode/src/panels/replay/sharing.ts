// Copy links to moments of replays, and find what a link names in the open folders; save pictures.
import * as vscode from "vscode";
import { complain, inform } from "../../notices";
import type { Trace } from "./answer";
import { type Moment, linkTo, momentIn, momentOf } from "./link";

/** Copy a link to a moment; returns what to tell the user. */
export async function copyLink(trace: Trace, model: string, extension: string, time: number, clause: number): Promise<string> {
  const uri = vscode.Uri.parse(model);
  if (vscode.workspace.getWorkspaceFolder(uri) === undefined) {
    return "No link: the model is in none of the open folders.";
  }
  const moment = momentOf(trace, vscode.workspace.asRelativePath(uri, false).replaceAll("\\", "/"), time, clause);
  if (moment === undefined) {
    return "No link: this execution is not in the project's store.";
  }
  await vscode.env.clipboard.writeText(linkTo(moment, vscode.env.uriScheme, extension));
  return "Link copied.";
}

/** Let the user paste a link; the one in the clipboard is offered. */
export async function askLink(): Promise<string | undefined> {
  const offered = await vscode.env.clipboard.readText();
  return vscode.window.showInputBox({
    title: "Open Link to a Moment",
    prompt: "Paste a link that was copied in a replay. It opens a stored execution of a model in the open folders.",
    value: momentIn(offered) === undefined ? "" : offered.trim(),
    ignoreFocusOut: true,
    validateInput: (text) => (momentIn(text) === undefined ? "This is no link to a replay." : undefined),
  });
}

/** The model of a moment in the open folders; if there is none, a message says which folder to open. */
export async function modelOf(moment: Moment): Promise<vscode.Uri | undefined> {
  for (const { uri } of vscode.workspace.workspaceFolders ?? []) {
    const model = vscode.Uri.joinPath(uri, moment.model);
    try {
      await vscode.workspace.fs.stat(model);
      return model;
    } catch {
      // It may be in another folder.
    }
  }
  complain(`This link shows run ${moment.run} of ${moment.model}, which is in none of the open folders. Open the folder of that project, then open the link again.`);
  return undefined;
}

/** Save a picture where the user wants it. */
export async function savePicture(png: string, name: string): Promise<void> {
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri;
  const file = `${name.replace(/[^\w-]+/g, "-")}.png`;
  const target = await vscode.window.showSaveDialog({
    ...(folder === undefined ? {} : { defaultUri: vscode.Uri.joinPath(folder, file) }),
    filters: { "PNG pictures": ["png"] },
    title: "Save the Picture of the Replay",
  });
  if (target !== undefined) {
    await vscode.workspace.fs.writeFile(target, Buffer.from(png, "base64"));
    inform(`Saved ${vscode.workspace.asRelativePath(target)}.`);
  }
}
