// Panels of recorded executions: the data is requested from the server and played in the page.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { complain, inform } from "../../notices";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { reveal } from "../reveal";
import { type Trace, ageOf, isTrace, titleOf } from "./answer";
import { chooseRecording } from "./choice";
import { isExecution, momentIn } from "./link";
import type { Recording, ToReplay } from "./messages";
import { clauseOf, recordingOf } from "./request";
import { askLink, copyLink, modelOf, savePicture } from "./sharing";

const TYPE = "robbdd.replay";

/** What to show first; undefined for what is most relevant. */
interface Start {
  readonly clause?: string | undefined;
  /** s */
  readonly time?: number;
}

export class ReplayView implements vscode.Disposable {
  /** By execution. */
  private readonly replays = new Map<string, Replay>();
  private readonly serializer: vscode.Disposable;

  constructor(
    private readonly server: Server,
    private readonly extension: vscode.Uri,
    /** Of the extension, for links to it. */
    private readonly id: string,
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
    this.show(trace, recording, { clause: clauseOf(target) }, column);
  }

  /** Show the moment that a link names, from the user or from anybody else; without a link, let the user paste one. */
  async openLink(link: string | undefined): Promise<void> {
    const text = link ?? (await askLink());
    const moment = text === undefined ? undefined : momentIn(text);
    if (moment === undefined) {
      if (text !== undefined) {
        complain("This is no link to a replay.");
      }
      return;
    }
    const model = await modelOf(moment);
    if (model === undefined || !(await this.server.ready())) {
      return;
    }
    const uri = model.toString();
    const { run, index, variant, variation, repetition, seed, clause, time } = moment;
    const named = await this.server.request("robbdd/trace", { uri, run, index });
    // A run with this number may be another one here: the execution decides.
    const found = isTrace(named) && isExecution(named.scenario, moment) ? named : await this.server.request("robbdd/trace", { uri, variant, variation, repetition });
    if (!isTrace(found) || !isExecution(found.scenario, moment)) {
      complain(`This link shows an execution of ${moment.model} (seed ${seed}) that no run stored here has. Run the scenario with this seed, then open the link again.`);
      return;
    }
    if (found !== named) {
      inform(`Run ${run} is not stored here; run ${found.run} has the same scenario with the same seed.`);
    }
    this.show(found, { uri }, { clause, time });
  }

  private show(trace: Trace, recording: Recording, start: Start, column?: vscode.ViewColumn): void {
    const open = this.replays.get(keyOf(trace));
    if (open === undefined) {
      this.adopt(beside(TYPE, panelTitle(trace), column), exactly(recording, trace), trace, start);
      return;
    }
    open.panel.view.reveal(column, true);
    open.panel.post({ type: "age", text: ageOf(trace.clauses) });
    if (start.clause !== undefined) {
      open.panel.post({ type: "clause", clause: start.clause });
    }
    if (start.time !== undefined) {
      open.panel.post({ type: "time", time: start.time });
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
    this.adopt(view, recording, trace, {});
  }

  private adopt(view: vscode.WebviewPanel, recording: Recording, trace: Trace, start: Start): void {
    const key = keyOf(trace);
    this.replays.set(key, new Replay(view, this.extension, this.id, recording, trace, start));
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
    id: string,
    recording: Recording,
    private readonly trace: Trace,
    { clause, time }: Start,
  ) {
    let start = { ...(clause === undefined ? {} : { clause }), ...(time === undefined ? {} : { time }) };
    this.panel = new Panel<ToReplay>(
      view,
      extension,
      "replay",
      () => {
        this.panel.post({ type: "trace", recording, trace, ...start });
        // A restored page shows its last state.
        start = {};
      },
      (message) => {
        if (message["type"] === "open") {
          this.show(message["clause"]);
        } else if (message["type"] === "link") {
          void this.copyLink(recording.uri, id, message);
        } else if (message["type"] === "picture" && typeof message["data"] === "string") {
          void savePicture(message["data"], titleOf(trace.scenario));
        }
      },
    );
  }

  private async copyLink(uri: string, id: string, { time, clause }: Record<string, unknown>): Promise<void> {
    if (typeof time === "number" && typeof clause === "number") {
      this.panel.post({ type: "said", words: await copyLink(this.trace, uri, id, time, clause) });
    }
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

function panelTitle({ run, scenario }: Trace): string {
  return `Replay ${titleOf(scenario)}${run > 0 ? ` (run ${run})` : ""}`;
}

/** The server's choice, so that a restored panel shows the same. */
function exactly({ uri }: Recording, { run, folder, scenario }: Trace): Recording {
  return { uri, run: run > 0 ? run : vscode.Uri.parse(folder).fsPath, index: scenario.index };
}
