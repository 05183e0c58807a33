// Follow-up when the server has written files.
import * as vscode from "vscode";

/** Open the first of the files returned by the server's command; without any, the server has shown the reason. */
export async function openFiles(result: unknown): Promise<void> {
  const files = writtenFiles(result);
  const [first] = files;
  if (first === undefined) {
    return;
  }
  await vscode.window.showTextDocument(vscode.Uri.parse(first), { viewColumn: vscode.ViewColumn.Beside });
  if (files.length > 1) {
    vscode.window.setStatusBarMessage(`RobBDD: ${files.length} files written`, 5000);
  }
}

function writtenFiles(result: unknown): string[] {
  const files: unknown = typeof result === "object" && result !== null && "files" in result ? result.files : [];
  return Array.isArray(files) ? files.filter((file) => typeof file === "string") : [];
}
