// The item in the status bar.
import * as vscode from "vscode";
import { type RunProgress, type ServerState, present } from "./presentation";

export class StatusItem implements vscode.Disposable {
  private readonly item = vscode.window.createStatusBarItem("robbdd.status", vscode.StatusBarAlignment.Left);
  private server: ServerState = { kind: "stopped" };
  private runs: readonly RunProgress[] = [];
  private summary = "";

  constructor() {
    this.item.name = "RobBDD";
    this.render();
  }

  /** Shown from the server's first state on. */
  showServer(state: ServerState): void {
    this.server = state;
    this.render();
    this.item.show();
  }

  showRuns(runs: readonly RunProgress[], summary: string): void {
    this.runs = runs;
    this.summary = summary;
    this.render();
  }

  dispose(): void {
    this.item.dispose();
  }

  private render(): void {
    const { text, tooltip, said, severity, command } = present(this.server, this.runs, this.summary);
    this.item.text = text;
    this.item.tooltip = tooltip;
    this.item.command = command;
    this.item.accessibilityInformation = { label: said };
    this.item.backgroundColor =
      severity === "normal" ? undefined : new vscode.ThemeColor(`statusBarItem.${severity}Background`);
  }
}
