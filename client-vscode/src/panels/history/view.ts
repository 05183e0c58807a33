// Panels with the verdicts on a clause in all stored runs; they are updated when a run ends.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { inform } from "../../notices";
import type { RunMonitor } from "../../runs/monitor";
import { isRecord } from "../../values";
import type { ComparisonView } from "../comparison/view";
import { Panel, beside } from "../panel";
import type { ReplayView } from "../replay/view";
import { type ClauseHistory, isHistory } from "./answer";
import type { ClauseChoice, ToHistory } from "./messages";

const TYPE = "robbdd.history";

interface Shown {
  readonly panel: Panel<ToHistory>;
  history: ClauseHistory;
  readonly choice: ClauseChoice;
}

export class HistoryView implements vscode.Disposable {
  /** By the IRI of the clause. */
  private readonly shown = new Map<string, Shown>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: Server,
    private readonly replays: ReplayView,
    private readonly comparisons: ComparisonView,
    runs: RunMonitor,
    private readonly extension: vscode.Uri,
  ) {
    this.subscriptions = [
      vscode.window.registerWebviewPanelSerializer(TYPE, {
        deserializeWebviewPanel: (view, state: unknown) => this.restore(view, state),
      }),
      runs.onOver(() => void this.refresh()),
    ];
  }

  /** Show the history of the clause that `target` names or, without one, of the clause at the cursor. */
  async open(target: unknown): Promise<void> {
    const where = choiceOf(target) ?? atCursor();
    if (where === undefined) {
      inform("Put the cursor into a clause of a model: its history is shown.");
      return;
    }
    const history = await this.server.ask("robbdd/history", where);
    if (!isHistory(history)) {
      inform("There is no clause at the cursor.");
    } else if (history.runs.length === 0) {
      inform("No stored run has judged this clause yet: run its scenario first.");
    } else {
      const open = this.shown.get(history.clause);
      if (open === undefined) {
        const choice = { uri: where.uri, clause: history.clause };
        this.show(beside(TYPE, `History of ${history.name || "a clause"}`), choice, history);
      } else {
        this.update(open, history);
        open.panel.view.reveal(undefined, true);
      }
    }
  }

  dispose(): void {
    for (const part of [...this.subscriptions, ...[...this.shown.values()].map(({ panel }) => panel)]) {
      part.dispose();
    }
  }

  private async restore(view: vscode.WebviewPanel, state: unknown): Promise<void> {
    const choice = choiceOf(isRecord(state) ? state["choice"] : undefined);
    await this.server.begin();
    const history = choice === undefined ? undefined : await this.server.request("robbdd/history", choice);
    if (choice !== undefined && isHistory(history)) {
      this.show(view, choice, history);
    } else {
      // The project is another one.
      view.dispose();
    }
  }

  private async refresh(): Promise<void> {
    for (const shown of this.shown.values()) {
      const history = await this.server.request("robbdd/history", shown.choice);
      if (isHistory(history)) {
        this.update(shown, history);
      }
    }
  }

  private update(shown: Shown, history: ClauseHistory): void {
    shown.history = history;
    shown.panel.post({ type: "history", choice: shown.choice, history });
  }

  private show(view: vscode.WebviewPanel, choice: ClauseChoice, history: ClauseHistory): void {
    const panel: Panel<ToHistory> = new Panel<ToHistory>(
      view,
      this.extension,
      "history",
      () => {
        this.update(shown, shown.history);
      },
      ({ type, run, index, before, after }) => {
        if (type === "replay") {
          void this.replays.open({ uri: choice.uri, run, index, clause: choice.clause });
        } else {
          void this.comparisons.open({ uri: choice.uri, before, after }, view.viewColumn);
        }
      },
    );
    const shown: Shown = { panel, choice, history };
    this.shown.set(choice.clause, shown);
    view.onDidDispose(() => {
      this.shown.delete(choice.clause);
    });
  }
}

function choiceOf(target: unknown): ClauseChoice | undefined {
  if (!isRecord(target) || typeof target["uri"] !== "string" || typeof target["clause"] !== "string") {
    return undefined;
  }
  return { uri: target["uri"], clause: target["clause"] };
}

function atCursor(): { readonly uri: string; readonly position: { readonly line: number; readonly character: number } } | undefined {
  const editor = vscode.window.activeTextEditor;
  if (editor?.document.languageId !== "robbdd") {
    return undefined;
  }
  const { line, character } = editor.selection.active;
  return { uri: editor.document.uri.toString(), position: { line, character } };
}
