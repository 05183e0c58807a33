// Panels that compare two stored runs, with the replays of both.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { chooseRuns } from "../replay/choice";
import type { ReplayView } from "../replay/view";
import { type Comparison, isComparison, summaryOf } from "./answer";
import type { RunPair, ToComparison } from "./messages";

const TYPE = "robbdd.comparison";

export class ComparisonView implements vscode.Disposable {
  /** By the numbers of the runs and their project. */
  private readonly shown = new Map<string, Panel<ToComparison>>();
  private readonly serializer: vscode.Disposable;

  constructor(
    private readonly server: Server,
    private readonly replays: ReplayView,
    private readonly extension: vscode.Uri,
  ) {
    this.serializer = vscode.window.registerWebviewPanelSerializer(TYPE, {
      deserializeWebviewPanel: (view, state: unknown) => this.restore(view, state),
    });
  }

  /** Compare two runs of a model's project, chosen by the user. */
  async choose(uri: string): Promise<void> {
    const pair = (await this.server.ready()) ? await chooseRuns(this.server, uri) : undefined;
    if (pair !== undefined) {
      await this.open(pair);
    }
  }

  /** Compare the runs that `target` names, a `RunPair`. */
  async open(target: unknown, column?: vscode.ViewColumn): Promise<void> {
    const pair = pairOf(target);
    const comparison = pair === undefined ? undefined : await this.server.ask("robbdd/compare", pair);
    if (pair === undefined || !isComparison(comparison)) {
      return;
    }
    const open = this.shown.get(keyOf(comparison));
    if (open === undefined) {
      const title = `Run ${pair.before} → ${pair.after}: ${summaryOf(comparison)}`;
      this.show(beside(TYPE, title, column), pair, comparison);
    } else {
      open.view.reveal(undefined, true);
    }
  }

  dispose(): void {
    for (const part of [this.serializer, ...this.shown.values()]) {
      part.dispose();
    }
  }

  private async restore(view: vscode.WebviewPanel, state: unknown): Promise<void> {
    const pair = pairOf(isRecord(state) ? state["pair"] : undefined);
    await this.server.begin();
    const comparison = pair === undefined ? undefined : await this.server.request("robbdd/compare", pair);
    if (pair !== undefined && isComparison(comparison)) {
      this.show(view, pair, comparison);
    } else {
      // A run has been removed, or the project is another one.
      view.dispose();
    }
  }

  private show(view: vscode.WebviewPanel, pair: RunPair, comparison: Comparison): void {
    const panel: Panel<ToComparison> = new Panel<ToComparison>(
      view,
      this.extension,
      "comparison",
      () => {
        panel.post({ type: "comparison", pair, comparison });
      },
      (message) => void this.replay(pair, message, view.viewColumn),
    );
    const key = keyOf(comparison);
    this.shown.set(key, panel);
    view.onDidDispose(() => {
      this.shown.delete(key);
    });
  }

  /** Replay an execution in one of the runs, or in both next to each other, the first one in `column`. */
  private async replay({ uri, before, after }: RunPair, message: Record<string, unknown>, column = vscode.ViewColumn.Two): Promise<void> {
    const clause = message["clause"];
    const other = column === vscode.ViewColumn.Two ? vscode.ViewColumn.Three : vscode.ViewColumn.Two;
    const sides = [
      { run: before, index: message["before"] },
      { run: after, index: message["after"] },
    ].filter(({ index }) => typeof index === "number");
    for (const [number, side] of sides.entries()) {
      await this.replays.open({ uri, ...side, clause }, number === 0 ? column : other);
    }
  }
}

function keyOf({ before, after }: Comparison): string {
  return `${before.folder} ${after.folder}`;
}

function pairOf(target: unknown): RunPair | undefined {
  if (!isRecord(target) || typeof target["uri"] !== "string") {
    return undefined;
  }
  const { uri, before, after } = target;
  return typeof before === "number" && typeof after === "number" ? { uri, before, after } : undefined;
}
