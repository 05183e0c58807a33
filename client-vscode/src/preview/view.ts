// The Gherkin of a model in a read-only document next to it, which follows its text and the cursor.
import * as vscode from "vscode";
import { LANGUAGES, type Server } from "../client";
import { type Preview, isPreview, lineAt } from "./answer";

const SCHEME = "robbdd-preview";
/** Milliseconds without an edit before a preview is updated. */
const PAUSE = 250;
/** Languages of other extensions that colour Gherkin, best first; ours is the fallback. */
const COLOURS = ["cucumber", "gherkin", "feature", "robbdd-feature"];

export class PreviewView implements vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changed = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changed.event;
  /** Previews by the URI of the model. */
  private readonly shown = new Map<string, Preview>();
  private readonly mark = vscode.window.createTextEditorDecorationType({
    isWholeLine: true,
    backgroundColor: new vscode.ThemeColor("editor.wordHighlightBackground"),
    overviewRulerColor: new vscode.ThemeColor("editorOverviewRuler.wordHighlightForeground"),
  });
  private readonly subscriptions: vscode.Disposable[];
  private timer: NodeJS.Timeout | undefined;

  constructor(private readonly server: Server) {
    this.subscriptions = [
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (LANGUAGES.includes(document.languageId)) {
          this.refreshSoon();
        } else if (document.uri.scheme === SCHEME) {
          this.followAll();
        }
      }),
      vscode.workspace.onDidChangeConfiguration((change) => {
        if (change.affectsConfiguration("robbdd.gherkin")) {
          this.refreshSoon();
        }
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        this.follow(textEditor);
      }),
    ];
  }

  /** Show the Gherkin of a model next to it. */
  async open(model: vscode.Uri): Promise<void> {
    await this.load(model.toString());
    const uri = previewOf(model);
    const document = await vscode.workspace.openTextDocument(uri);
    const known = new Set(await vscode.languages.getLanguages());
    const language = COLOURS.find((name) => known.has(name));
    if (language !== undefined && document.languageId !== language) {
      await vscode.languages.setTextDocumentLanguage(document, language);
    }
    const options = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true, preview: false };
    await vscode.window.showTextDocument(document, options);
    this.followAll();
  }

  provideTextDocumentContent(uri: vscode.Uri): string {
    return this.shown.get(modelOf(uri))?.text ?? "";
  }

  /** Update all previews, because the server has changed. */
  refreshSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.refresh(), this.shown.size > 0 ? PAUSE : 0);
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.changed.dispose();
    this.mark.dispose();
    for (const subscription of this.subscriptions) {
      subscription.dispose();
    }
  }

  private async refresh(): Promise<void> {
    // A change of a document's language closes it briefly: closed documents are sent again when needed.
    const open = new Set(vscode.workspace.textDocuments.map(({ uri }) => uri.toString()));
    for (const [model, { text }] of [...this.shown]) {
      if (!open.has(previewOf(vscode.Uri.parse(model)).toString())) {
        this.shown.delete(model);
        continue;
      }
      await this.load(model);
      if (this.shown.get(model)?.text !== text) {
        this.changed.fire(previewOf(vscode.Uri.parse(model)));
      }
    }
  }

  private async load(model: string): Promise<void> {
    const answer = await this.server.request("robbdd/preview", { uri: model });
    if (isPreview(answer)) {
      this.shown.set(model, answer);
    }
  }

  private followAll(): void {
    for (const editor of vscode.window.visibleTextEditors) {
      this.follow(editor);
    }
  }

  /** Show, in a visible preview, the line at the cursor of its model or of an imported file. */
  private follow(editor: vscode.TextEditor): void {
    if (!LANGUAGES.includes(editor.document.languageId)) {
      return;
    }
    for (const beside of vscode.window.visibleTextEditors) {
      const preview = beside.document.uri.scheme === SCHEME ? this.shown.get(modelOf(beside.document.uri)) : undefined;
      if (preview === undefined) {
        continue;
      }
      const present = beside.visibleRanges[0]?.start.line ?? 0;
      const line = lineAt(preview.lines, editor.document.uri.toString(), editor.selection.active, present);
      if (line === undefined) {
        beside.setDecorations(this.mark, []);
        continue;
      }
      const range = new vscode.Range(line, 0, line, 0);
      beside.setDecorations(this.mark, [range]);
      beside.revealRange(range, vscode.TextEditorRevealType.InCenterIfOutsideViewport);
    }
  }
}

/** The address of a preview has the ending of a feature; the query names the model. */
function previewOf(model: vscode.Uri): vscode.Uri {
  const name = model.path.replace(/^.*\//, "").replace(/\.bdd$/, "");
  return vscode.Uri.from({ scheme: SCHEME, path: `/${name}.feature`, query: model.toString() });
}

function modelOf(preview: vscode.Uri): string {
  return preview.query;
}
