// The graph of a model next to its text: it follows edits and the cursor, and links back to the text.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { innermost } from "../../places";
import { type FilePanel, FilePanels } from "../filePanels";
import { Panel } from "../panel";
import { reveal } from "../reveal";
import { type GraphPicture, isGraphPicture, remark } from "./answer";
import type { ToGraph } from "./messages";

/** Milliseconds without an edit before a picture is updated. */
const PAUSE = 250;

export class GraphView extends FilePanels<Graph> {
  constructor(server: Server, extension: vscode.Uri) {
    super(server, "robbdd.graph", "Graph", (view, uri, restored) => new Graph(view, extension, server, uri, restored));
    this.subscriptions.push(
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => {
        for (const graph of this.panels.values()) {
          graph.moved(textEditor);
        }
      }),
    );
  }
}

/** One panel with the graph of one model. */
class Graph implements FilePanel {
  readonly panel: Panel<ToGraph>;
  private picture: GraphPicture | undefined;
  private highlighted: string | null = null;
  /** Request counter: an answer overtaken by a later request is dropped. */
  private asked = 0;
  private timer: NodeJS.Timeout | undefined;

  constructor(
    view: vscode.WebviewPanel,
    extension: vscode.Uri,
    private readonly server: Server,
    private readonly uri: string,
    /** The page restores its last view; the first picture must not move it. */
    private restored: boolean,
  ) {
    this.panel = new Panel(
      view,
      extension,
      "graph",
      () => void this.begin(),
      ({ iri }) => {
        this.show(iri);
      },
    );
  }

  loadSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.load(), PAUSE);
  }

  stop(): void {
    clearTimeout(this.timer);
  }

  /** Follow the cursor of an editor; for a large model, this may need a new picture around it. */
  moved(editor: vscode.TextEditor): void {
    if (!this.highlight(editor) && this.picture?.root != null && editor.document.uri.toString() === this.uri) {
      this.loadSoon();
    }
  }

  /** Request the picture again; for a large model, the part around the cursor, else the part shown. */
  private async load(): Promise<void> {
    this.asked += 1;
    const asked = this.asked;
    const editor = vscode.window.visibleTextEditors.find(({ document }) => document.uri.toString() === this.uri);
    const position = editor?.selection.active;
    const answer = await this.server.request("robbdd/graph", {
      uri: this.uri,
      ...(position === undefined ? {} : { position: { line: position.line, character: position.character } }),
      iri: this.highlighted ?? this.picture?.root?.iri ?? null,
    });
    if (asked === this.asked && isGraphPicture(answer)) {
      this.picture = answer;
      this.post();
      const followed = vscode.window.activeTextEditor ?? editor;
      if (followed !== undefined) {
        this.highlight(followed, !this.restored);
      }
      this.restored = false;
    }
  }

  /** Highlight the node at the cursor of an editor, which may show an imported file; false if there is none. */
  private highlight({ document, selection }: vscode.TextEditor, move = true): boolean {
    const found = innermost(this.picture?.places ?? [], document.uri.toString(), selection.active);
    if (found !== undefined && found.iri !== this.highlighted) {
      this.highlighted = found.iri;
      this.panel.post({ type: "highlight", iri: found.iri, move });
    }
    return found !== undefined;
  }

  /** A fresh page has no state: send it the current picture, or request one. */
  private async begin(): Promise<void> {
    if (this.picture === undefined) {
      await this.load();
    } else {
      this.post();
    }
  }

  private post(): void {
    if (this.picture === undefined) {
      return;
    }
    const { uri, svg, problem, root } = this.picture;
    const subject = root?.iri ?? "";
    this.panel.post({ type: "picture", uri, svg, remark: remark(this.picture), outdated: problem !== null, subject });
    this.panel.post({ type: "highlight", iri: this.highlighted, move: false });
  }

  private show(iri: unknown): void {
    const source = this.picture?.nodes.find((node) => node.iri === iri)?.source;
    if (source !== null && source !== undefined) {
      void reveal(source.uri, source.range, this.panel.view.viewColumn);
    }
  }
}
