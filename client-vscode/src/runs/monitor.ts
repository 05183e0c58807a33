// Runs in progress: print their messages and update the status item.
import * as vscode from "vscode";
import { reach } from "../milestones";
import type { RunProgress } from "../presentation";
import type { RunNotification } from "./messages";
import { RunReport } from "./report";

/** A requested run that did not begin; `scenario` is the IRI of a variant, `token` the run's intended name. */
export interface Refusal {
  readonly uri: string;
  readonly scenario?: string;
  readonly token?: string;
  readonly problem: string;
}

/** Milliseconds between two updates of the status item during a run. */
const UPDATE_PAUSE = 100;

export class RunMonitor implements vscode.Disposable {
  private readonly channel = vscode.window.createOutputChannel("RobBDD Runs");
  private readonly reports = new Map<string, RunReport>();
  private summary = "";
  private update: NodeJS.Timeout | undefined;
  private running = false;
  private readonly heard = new vscode.EventEmitter<RunNotification>();
  private readonly refused = new vscode.EventEmitter<Refusal>();
  private readonly over = new vscode.EventEmitter<string | undefined>();
  readonly onMessage = this.heard.event;
  readonly onRefused = this.refused.event;
  /** No more messages of the named run, or of any run, will follow, whether they ended or not. */
  readonly onOver = this.over.event;

  constructor(private readonly onChange: (runs: readonly RunProgress[], summary: string) => void) {}

  show(): void {
    this.channel.show(true);
  }

  accept(notification: RunNotification): void {
    const { uri, message, run } = notification;
    let report = this.reports.get(run);
    if (report === undefined || message.type === "RunStarted") {
      report = new RunReport(vscode.workspace.asRelativePath(vscode.Uri.parse(uri)));
      this.reports.set(run, report);
    }
    this.print(report.add(message));
    this.settle(run, report);
    if (message.type === "RunStarted" || report.finished) {
      this.publish();
    } else {
      this.publishSoon();
    }
    this.heard.fire(notification);
    if (message.type === "ClauseJudged" && message.verdict === "holds") {
      reach("somethingHeld");
    }
  }

  /** Print something about a run that has ended. */
  tell(lines: readonly string[]): void {
    this.print(lines);
  }

  /** Nothing was run, for a reason to be shown at the scenarios. */
  refuse(refusal: Refusal): void {
    this.refused.fire(refusal);
  }

  /** No more messages of a run will follow. */
  end(run: string): void {
    this.interrupt(run, "The run ended before it was complete.");
    this.over.fire(run);
  }

  /** The server is gone, and all its runs. */
  abandon(): void {
    for (const run of [...this.reports.keys()]) {
      this.interrupt(run, "The language server stopped during the run.");
    }
    this.over.fire(undefined);
  }

  dispose(): void {
    clearTimeout(this.update);
    this.channel.dispose();
    this.heard.dispose();
    this.refused.dispose();
    this.over.dispose();
  }

  private interrupt(run: string, reason: string): void {
    const report = this.reports.get(run);
    if (report !== undefined) {
      this.print(report.interrupt(reason));
      this.settle(run, report);
      this.publish();
    }
  }

  private settle(run: string, report: RunReport): void {
    if (report.finished) {
      this.summary = report.summary();
      this.reports.delete(run);
    }
  }

  private print(lines: readonly string[]): void {
    if (lines.length > 0) {
      this.channel.appendLine(lines.join("\n"));
    }
  }

  private publishSoon(): void {
    this.update ??= setTimeout(() => {
      this.publish();
    }, UPDATE_PAUSE);
  }

  private publish(): void {
    clearTimeout(this.update);
    this.update = undefined;
    const runs = [...this.reports.values()].map((report): RunProgress => {
      const { total, passed, failed, errored } = report.tally;
      return { finished: passed + failed + errored, total };
    });
    if (this.running !== runs.length > 0) {
      this.running = runs.length > 0;
      void vscode.commands.executeCommand("setContext", "robbdd.running", this.running);
    }
    this.onChange(runs, this.summary);
  }
}
