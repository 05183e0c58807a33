// Where the server's hints stand in this editor.
import type * as vscode from "vscode";

const FAILED = /^\s*[✗?]/;

/**
 * Puts the verdict on a clause that does not hold before its text: behind it the editor draws the failure of the test,
 * over whatever stands there.
 */
export function failuresFirst(document: vscode.TextDocument, hints: vscode.InlayHint[]): vscode.InlayHint[] {
  for (const hint of hints.filter(({ label }) => typeof label === "string" && FAILED.test(label))) {
    const { firstNonWhitespaceCharacterIndex: first, text } = document.lineAt(hint.position.line);
    // The editor draws nothing at the row of a table.
    if (text[first] !== "|") {
      hint.position = hint.position.with({ character: first });
      hint.paddingLeft = false;
      hint.paddingRight = true;
    }
  }
  return hints;
}
