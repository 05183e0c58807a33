// What follows when the server has written feature files.
import * as vscode from "vscode";

/** Open the first of the feature files that `robbdd.gherkin` returned; when there is none the server has said why. */
export async function openFeatures(result: unknown): Promise<void> {
  const files = featureFiles(result);
  const [first] = files;
  if (first === undefined) {
    return;
  }
  await vscode.window.showTextDocument(vscode.Uri.parse(first), { viewColumn: vscode.ViewColumn.Beside });
  if (files.length > 1) {
    vscode.window.setStatusBarMessage(`RobBDD: ${files.length} feature files written`, 5000);
  }
}

function featureFiles(result: unknown): string[] {
  const files: unknown = typeof result === "object" && result !== null && "files" in result ? result.files : [];
  return Array.isArray(files) ? files.filter((file) => typeof file === "string") : [];
}
