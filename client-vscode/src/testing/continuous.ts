// Runs on save.
import * as vscode from "vscode";
import type { TestRunner } from "./runner";
import type { TestTree } from "./tree";
import type { Upkeep } from "./upkeep";

interface Continuous {
  readonly request: vscode.TestRunRequest;
  running: Promise<void>;
  current: vscode.CancellationTokenSource | undefined;
}

export class ContinuousRuns implements vscode.Disposable {
  private readonly entries = new Set<Continuous>();
  private readonly listener = vscode.workspace.onDidSaveTextDocument((document) => {
    this.saved(document.uri.toString());
  });

  constructor(
    private readonly tree: TestTree<vscode.TestItem>,
    private readonly upkeep: Upkeep,
    private readonly runner: TestRunner,
  ) {}

  /** Run a request whenever one of its files is saved, until cancelled. */
  add(request: vscode.TestRunRequest, token: vscode.CancellationToken): void {
    const entry: Continuous = { request, running: Promise.resolve(), current: undefined };
    this.entries.add(entry);
    token.onCancellationRequested(() => {
      this.entries.delete(entry);
      entry.current?.cancel();
    });
  }

  dispose(): void {
    this.listener.dispose();
  }

  /** Run again the tests that depend on a saved file; a run in progress is about the old text. */
  private saved(uri: string): void {
    for (const entry of this.entries) {
      const affected = new Set([uri, ...this.tree.dependents(uri)]);
      if (this.runner.choose(entry.request).some((run) => affected.has(run.uri))) {
        this.again(entry, uri, affected);
      }
    }
  }

  private again(entry: Continuous, uri: string, affected: ReadonlySet<string>): void {
    entry.current?.cancel();
    const source = new vscode.CancellationTokenSource();
    entry.current = source;
    entry.running = entry.running
      .then(async () => {
        if (!source.token.isCancellationRequested) {
          await this.upkeep.follow(uri);
          await this.runner.execute(entry.request, source.token, "robbdd.run", { among: affected });
        }
      })
      .finally(() => {
        source.dispose();
      });
  }
}
