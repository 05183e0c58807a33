// Panels of recorded executions: the data is requested from the server and played in the page.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { reveal } from "../reveal";
import { type Trace, ageOf, isTrace, local } from "./answer";
import { chooseRecording } from "./choice";
import type { Recording, ToReplay } from "./messages";
import { clauseOf, recordingOf } from "./request";

const TYPE = "robbdd.replay";

export class ReplayView implements vscode.Disposable {
  /** By execution. */
  private readonly replays = new Map<string, Replay>();
  private readonly serializer: vscode.Disposable;

  constructor(
    private readonly server: Server,
    private readonly extension: vscode.Uri,
  ) {
    this.serializer = vscode.window.registerWebviewPanelSerializer(TYPE, {
      deserializeWebviewPanel: async (view, state: unknown) => {
        await server.begin();
        await this.restore(view, state);
      },
    });
  }

  /** Show an execution of a model's project chosen by the user. */
  async choose(model: string): Promise<void> {
    // The command may have activated the extension.
    const recording = (await this.server.ready()) ? await chooseRecording(this.server, model) : undefined;
    if (recording !== undefined) {
      await this.open(recording);
    }
  }

  /** Show the execution that `target` describes: a `Recording`, optionally with a clause to select. */
  async open(target: unknown, column?: vscode.ViewColumn): Promise<void> {
    const recording = recordingOf(target);
    if (recording === undefined) {
      return;
    }
    const trace = await this.server.ask("robbdd/trace", recording);
    if (!isTrace(trace)) {
      return;
    }
    const clause = clauseOf(target);
    const open = this.replays.get(keyOf(trace));
    if (open === undefined) {
      this.adopt(beside(TYPE, titleOf(trace), column), exactly(recording, trace), trace, clause);
    } else {
      open.panel.view.reveal(column, true);
      open.panel.post({ type: "age", text: ageOf(trace.clauses) });
      if (clause !== undefined) {
        open.panel.post({ type: "clause", clause });
      }
    }
  }

  dispose(): void {
    for (const part of [this.serializer, ...[...this.replays.values()].map(({ panel }) => panel)]) {
      part.dispose();
    }
  }

  private async restore(view: vscode.WebviewPanel, state: unknown): Promise<void> {
    const recording = recordingOf(isRecord(state) ? state["recording"] : undefined);
    await this.server.settled();
    const trace = recording === undefined ? undefined : await this.server.request("robbdd/trace", recording);
    if (recording === undefined || !isTrace(trace)) {
      // The run has been removed, or the project is another one.
      view.dispose();
      return;
    }
    this.adopt(view, recording, trace, undefined);
  }

  private adopt(view: vscode.WebviewPanel, recording: Recording, trace: Trace, clause: string | undefined): void {
    const key = keyOf(trace);
    this.replays.set(key, new Replay(view, this.extension, recording, trace, clause));
    view.onDidDispose(() => {
      this.replays.delete(key);
    });
  }
}

/** One panel with one execution. */
class Replay {
  readonly panel: Panel<ToReplay>;

  constructor(
    view: vscode.WebviewPanel,
    extension: vscode.Uri,
    recording: Recording,
    private readonly trace: Trace,
    clause: string | undefined,
  ) {
    let wanted = clause;
    this.panel = new Panel<ToReplay>(
      view,
      extension,
      "replay",
      () => {
        this.panel.post({ type: "trace", recording, trace, ...(wanted === undefined ? {} : { clause: wanted }) });
        // A restored page shows its last state.
        wanted = undefined;
      },
      ({ clause: number }) => {
        this.show(number);
      },
    );
  }

  private show(clause: unknown): void {
    const source = typeof clause === "number" ? this.trace.clauses[clause]?.source : undefined;
    if (source !== null && source !== undefined) {
      void reveal(source.uri, source.range, this.panel.view.viewColumn);
    }
  }
}

function keyOf({ folder, scenario }: Trace): string {
  return `${folder} ${scenario.index}`;
}

function titleOf({ run, scenario }: Trace): string {
  return `Replay ${local(scenario.name)}${run > 0 ? ` (run ${run})` : ""}`;
}

/** The server's choice, so that a restored panel shows the same. */
function exactly({ uri }: Recording, { run, folder, scenario }: Trace): Recording {
  return { uri, run: run > 0 ? run : vscode.Uri.parse(folder).fsPath, index: scenario.index };
}
