// Panels of one kind next to their files: at most one for each file. They follow edits and survive a reload of the window.
import * as vscode from "vscode";
import { LANGUAGES, type Server } from "../client";
import { isRecord } from "../values";
import { beside } from "./panel";

/** One panel with the content of one file. */
export interface FilePanel {
  readonly panel: { readonly view: vscode.WebviewPanel; dispose(): void };
  /** Request the content again, soon. */
  loadSoon(): void;
  /** The panel is closed. */
  stop(): void;
}

export class FilePanels<Shown extends FilePanel> implements vscode.Disposable {
  /** By the URI of the file. */
  protected readonly panels = new Map<string, Shown>();
  protected readonly subscriptions: vscode.Disposable[];

  /** `fill` creates the content of a panel, which may be restored after a reload of the window. */
  constructor(
    server: Server,
    private readonly type: string,
    private readonly title: string,
    private readonly fill: (view: vscode.WebviewPanel, uri: string, restored: boolean) => Shown,
  ) {
    this.subscriptions = [
      vscode.window.registerWebviewPanelSerializer(type, {
        deserializeWebviewPanel: async (view, state: unknown) => {
          await server.begin();
          this.restore(view, state);
        },
      }),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (LANGUAGES.includes(document.languageId)) {
          this.refreshSoon();
        }
      }),
    ];
  }

  /** Show the panel of a file next to it. */
  open(file: vscode.Uri): void {
    const uri = file.toString();
    const open = this.panels.get(uri);
    if (open === undefined) {
      this.adopt(beside(this.type, `${this.title} ${file.path.replace(/^.*\//, "")}`), uri, false);
    } else {
      open.panel.view.reveal(undefined, true);
    }
  }

  /** Update all panels, because a text or the server has changed. */
  refreshSoon(): void {
    for (const shown of this.panels.values()) {
      shown.loadSoon();
    }
  }

  dispose(): void {
    for (const part of [...this.subscriptions, ...[...this.panels.values()].map(({ panel }) => panel)]) {
      part.dispose();
    }
  }

  private restore(view: vscode.WebviewPanel, state: unknown): void {
    if (isRecord(state) && typeof state["uri"] === "string" && !this.panels.has(state["uri"])) {
      this.adopt(view, state["uri"], true);
    } else {
      view.dispose();
    }
  }

  private adopt(view: vscode.WebviewPanel, uri: string, restored: boolean): void {
    const shown = this.fill(view, uri, restored);
    this.panels.set(uri, shown);
    view.onDidDispose(() => {
      shown.stop();
      this.panels.delete(uri);
    });
  }
}
