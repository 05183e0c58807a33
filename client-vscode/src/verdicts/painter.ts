// Draw verdicts in their colours: the editor has only one colour for all hints and one for all lenses, including icons.
import * as vscode from "vscode";
import { isVerdictHints } from "../answers/validators.mjs";
import { type Mark, appearanceOf, marksOfHints, marksOfLenses } from "./marks";

/** Gap between a verdict and the text. */
const GAP = "1.5ch";

type Answer<Entry> = vscode.ProviderResult<Entry[]>;

/** Removes the verdicts from a server's hints and lenses and draws them itself, until disposed. */
export class VerdictPainter implements vscode.Disposable {
  private readonly hints = new Layer((document) => {
    const shown = vscode.workspace.getConfiguration("editor", document).get("inlayHints.enabled");
    return shown === "on" || shown === "onUnlessPressed";
  });
  private readonly lenses = new Layer(
    (document) => vscode.workspace.getConfiguration("editor", document).get("codeLens") === true,
  );
  private readonly layers = [this.hints, this.lenses];
  private readonly listeners = [
    vscode.window.onDidChangeVisibleTextEditors((editors) => {
      this.draw(editors);
    }),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("editor.inlayHints") || change.affectsConfiguration("editor.codeLens")) {
        this.draw(vscode.window.visibleTextEditors);
      }
    }),
    vscode.workspace.onDidCloseTextDocument((document) => {
      for (const layer of this.layers) {
        layer.show(document, []);
      }
    }),
  ];

  /**
   * Draw the verdicts of a document, and return those of the hints of its visible part that are not verdicts. `ask` requests
   * the verdicts of the whole document: all its hints would take ten times as long in a long document.
   */
  async takeHints(
    document: vscode.TextDocument,
    hints: Answer<vscode.InlayHint>,
    ask: () => Promise<unknown>,
  ): Promise<vscode.InlayHint[] | null | undefined> {
    const { version } = document;
    const [found, verdicts] = await Promise.all([hints, ask().catch(() => undefined)]);
    // After an edit, the editor requests them again.
    if (document.version === version && isVerdictHints(verdicts)) {
      this.hints.show(document, marksOfHints(document, verdicts));
    }
    return found?.filter((hint) => appearanceOf(hint) === undefined);
  }

  /** Request the lenses of a document and return those that are not verdicts. */
  async takeLenses(
    document: vscode.TextDocument,
    ask: () => Answer<vscode.CodeLens>,
  ): Promise<vscode.CodeLens[] | null | undefined> {
    const { version } = document;
    const found = await ask();
    if (found && document.version === version) {
      this.lenses.show(document, marksOfLenses(document, found));
    }
    return found?.filter((lens) => appearanceOf(lens) === undefined);
  }

  dispose(): void {
    for (const part of [...this.listeners, ...this.layers]) {
      part.dispose();
    }
  }

  private draw(editors: readonly vscode.TextEditor[]): void {
    for (const editor of editors) {
      for (const layer of this.layers) {
        layer.draw(editor);
      }
    }
  }
}

/** The marks of one kind, by document. */
class Layer implements vscode.Disposable {
  private readonly type = vscode.window.createTextEditorDecorationType({});
  private readonly known = new WeakMap<vscode.TextDocument, { readonly version: number; readonly marks: readonly Mark[] }>();

  constructor(private readonly isWanted: (document: vscode.TextDocument) => boolean) {}

  /** Show these marks in the current text of a document, in all its editors, replacing previous ones. */
  show(document: vscode.TextDocument, marks: readonly Mark[]): void {
    this.known.set(document, { version: document.version, marks });
    for (const editor of vscode.window.visibleTextEditors.filter((one) => one.document === document)) {
      this.draw(editor);
    }
  }

  /** Draw the known marks in an editor; if the text has changed, the editor has moved its marks. */
  draw(editor: vscode.TextEditor): void {
    const known = this.known.get(editor.document);
    if (!this.isWanted(editor.document)) {
      editor.setDecorations(this.type, []);
    } else if (known?.version === editor.document.version) {
      editor.setDecorations(this.type, known.marks.map(decoration));
    }
  }

  dispose(): void {
    this.type.dispose();
  }
}

function decoration({ verdict, stale, rejudged, words, line, character, side, tooltip }: Mark): vscode.DecorationOptions {
  const text: vscode.ThemableDecorationAttachmentRenderOptions = {
    contentText: words,
    color: new vscode.ThemeColor(`robbdd.${stale ? "stale" : verdict}Foreground`),
    fontStyle: stale || rejudged ? "italic" : "normal",
    margin: side === "after" ? `0 0 0 ${GAP}` : `0 ${GAP} 0 0`,
  };
  return {
    range: new vscode.Range(line, character, line, character),
    renderOptions: { [side]: text },
    ...(tooltip === "" ? {} : { hoverMessage: new vscode.MarkdownString().appendText(tooltip) }),
  };
}
