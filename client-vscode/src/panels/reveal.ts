// Navigate from a panel to a text.
import * as vscode from "vscode";
import type { Range } from "../places";

/** Select a place in its document, in an editor that already shows it if any, never in the panel's column. */
export async function reveal(uri: string, range: Range, panel: vscode.ViewColumn | undefined): Promise<void> {
  const shown = vscode.window.visibleTextEditors.find(({ document }) => document.uri.toString() === uri);
  const document = await vscode.workspace.openTextDocument(vscode.Uri.parse(uri));
  const column = shown?.viewColumn ?? (panel === vscode.ViewColumn.One ? vscode.ViewColumn.Two : vscode.ViewColumn.One);
  await vscode.window.showTextDocument(document, {
    viewColumn: column,
    selection: new vscode.Range(range.start.line, range.start.character, range.end.line, range.end.character),
  });
}
