// Common base of all panels with a page: its files, its permissions, its message queue.
import { randomBytes } from "node:crypto";
import * as vscode from "vscode";
import { isRecord } from "../values";
import { page } from "./page";

/** One panel with the page `out/webviews/<name>.js`. Messages wait until the page listens, and again after a reload. */
export class Panel<Outgoing extends object> implements vscode.Disposable {
  private readonly subscriptions: vscode.Disposable[];

  /** `ready` is called whenever the page has loaded without state; `receive` with all its other messages. */
  constructor(
    readonly view: vscode.WebviewPanel,
    extension: vscode.Uri,
    name: string,
    private readonly ready: () => void,
    private readonly receive: (message: Record<string, unknown>) => void,
  ) {
    const folder = vscode.Uri.joinPath(extension, "out", "webviews");
    const file = (ending: string) => view.webview.asWebviewUri(vscode.Uri.joinPath(folder, name + ending)).toString();
    view.webview.options = { enableScripts: true, localResourceRoots: [folder] };
    view.iconPath = vscode.Uri.joinPath(extension, "images", "file.svg");
    this.subscriptions = [
      view.webview.onDidReceiveMessage((message: unknown) => {
        this.heard(message);
      }),
    ];
    view.webview.html = page({
      title: view.title,
      script: file(".js"),
      style: file(".css"),
      source: view.webview.cspSource,
      nonce: randomBytes(16).toString("base64url"),
    });
  }

  post(message: Outgoing): void {
    void this.view.webview.postMessage(message);
  }

  dispose(): void {
    for (const subscription of this.subscriptions) {
      subscription.dispose();
    }
    this.view.dispose();
  }

  private heard(message: unknown): void {
    if (!isRecord(message)) {
      return;
    }
    if (message["type"] === "ready") {
      this.ready();
    } else {
      this.receive(message);
    }
  }
}

/** Open a new panel without taking the focus: in `column`, else next to the text or, from another panel, in its place. */
export function beside(type: string, title: string, column?: vscode.ViewColumn): vscode.WebviewPanel {
  const fromPanel = vscode.window.tabGroups.activeTabGroup.activeTab?.input instanceof vscode.TabInputWebview;
  const viewColumn = column ?? (fromPanel ? vscode.ViewColumn.Active : vscode.ViewColumn.Beside);
  return vscode.window.createWebviewPanel(type, title, { viewColumn, preserveFocus: true });
}
