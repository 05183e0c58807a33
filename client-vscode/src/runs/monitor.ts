// Runs under way: prints their messages and keeps the status item up to date.
import * as vscode from "vscode";
import type { RunProgress } from "../presentation";
import type { RunNotification } from "./messages";
import { RunReport } from "./report";

export class RunMonitor implements vscode.Disposable {
  private readonly channel = vscode.window.createOutputChannel("RobBDD Runs");
  private readonly reports = new Map<string, RunReport>();
  private summary = "";

  constructor(private readonly onChange: (runs: readonly RunProgress[], summary: string) => void) {}

  show(): void {
    this.channel.show(true);
  }

  accept({ uri, message }: RunNotification): void {
    let report = this.reports.get(uri);
    if (report === undefined || message.type === "RunStarted") {
      report = new RunReport(vscode.workspace.asRelativePath(vscode.Uri.parse(uri)));
      this.reports.set(uri, report);
    }
    this.print(report.add(message));
    this.settle(uri, report);
    this.publish();
  }

  /** The server is gone, and with it whatever it was running. */
  interrupt(): void {
    for (const [uri, report] of this.reports) {
      this.print(report.interrupt("The language server stopped during the run."));
      this.settle(uri, report);
    }
    this.publish();
  }

  dispose(): void {
    this.channel.dispose();
  }

  private settle(uri: string, report: RunReport): void {
    if (report.finished) {
      this.summary = report.summary();
      this.reports.delete(uri);
    }
  }

  private print(lines: readonly string[]): void {
    for (const line of lines) {
      this.channel.appendLine(line);
    }
  }

  private publish(): void {
    const runs = [...this.reports.values()].map((report): RunProgress => {
      const { total, passed, failed, undecided } = report.tally;
      return { finished: passed + failed + undecided, total };
    });
    void vscode.commands.executeCommand("setContext", "robbdd.running", runs.length > 0);
    this.onChange(runs, this.summary);
  }
}
