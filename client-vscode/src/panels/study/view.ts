// The results of a stored run over its variations, in a panel with links to the replay of each execution.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { complain } from "../../notices";
import { replayExecution } from "../../studies";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { isTrace } from "../replay/answer";
import { chooseRun } from "../replay/choice";
import type { ReplayView } from "../replay/view";
import { type StoredRun, isRuns, outcome } from "../runs";
import type { StudiedRun, StudyPart, ToStudy } from "./messages";
import { packed } from "./packed";
import { type JudgedScenario, isStudyResults, readResults, studiedScenarios, studyTitle } from "./results";

const TYPE = "robbdd.study";
const STUDY = ".study";

/** What a panel shows: the executions of a run or of a study. */
interface Shown {
  /** Identifies the panel: the folder of the run, or the file of the study. */
  readonly key: string;
  readonly studied: StudiedRun;
  readonly title: string;
  readonly scenarios: readonly JudgedScenario[];
  readonly replay: (index: number, clause: unknown) => void;
}

export class StudyView implements vscode.Disposable {
  /** By the key of what they show. */
  private readonly studies = new Map<string, Panel<ToStudy>>();
  /** Sends the results to the page again, to show another part; by the same key. */
  private readonly begins = new Map<string, (part: StudyPart) => void>();
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

  /** Show the executions of a study, or the results of a stored run of a model's project; the user chooses which run. */
  async choose(uri: string, part: StudyPart): Promise<void> {
    if (!(await this.server.ready())) {
      return;
    }
    if (uri.endsWith(STUDY)) {
      const shown = this.ofStudy(uri, await this.server.ask("robbdd/study", { uri }));
      if (shown !== undefined) {
        // What the study has executed since is shown in a new page.
        this.studies.get(shown.key)?.view.dispose();
        this.show(shown, beside(TYPE, `Study ${local(uri)}`), part);
      }
      return;
    }
    const run = await chooseRun(this.server, uri, "Study: which run?");
    const open = run === undefined ? undefined : this.studies.get(run.folder);
    if (open !== undefined) {
      this.begins.get(run?.folder ?? "")?.(part);
      open.view.reveal(undefined, true);
    } else if (run !== undefined) {
      const shown = await this.ofRun(run, uri);
      if (shown !== undefined) {
        this.show(shown, beside(TYPE, `Study run ${run.run}`), part);
      }
    }
  }

  dispose(): void {
    for (const part of [this.serializer, ...this.studies.values()]) {
      part.dispose();
    }
  }

  private async restore(view: vscode.WebviewPanel, state: unknown): Promise<void> {
    const studied = isRecord(state) ? state["studied"] : undefined;
    await this.server.begin();
    const shown = isRecord(studied) && typeof studied["uri"] === "string" ? await this.again(studied["uri"], studied["run"]) : undefined;
    if (shown !== undefined) {
      this.show(shown, view);
      return;
    }
    // The run has been removed, or the project is another one.
    view.dispose();
  }

  private async again(uri: string, number: unknown): Promise<Shown | undefined> {
    if (typeof number !== "number") {
      return this.ofStudy(uri, await this.server.request("robbdd/study", { uri }));
    }
    const answer = await this.server.request("robbdd/runs", { uri, run: number });
    const [run] = isRuns(answer) ? answer.runs : [];
    return run === undefined ? undefined : this.ofRun(run, uri);
  }

  private async ofRun(run: StoredRun, uri: string): Promise<Shown | undefined> {
    const file = vscode.Uri.joinPath(vscode.Uri.parse(run.folder), "results.json");
    const results = readResults(await textOf(file));
    if (results === undefined) {
      complain(`RobBDD: ${file.fsPath} contains no results of this version.`);
      return undefined;
    }
    const studied: StudiedRun = { uri, run: run.run };
    const title = `Run ${run.run} of ${run.path}: ${outcome(run)}`;
    const replay = (index: number, clause: unknown) => void this.replays.open({ ...studied, index, clause });
    return { key: run.folder, studied, title, scenarios: results.scenarios, replay };
  }

  private ofStudy(uri: string, results: unknown): Shown | undefined {
    if (!isStudyResults(results)) {
      return undefined;
    }
    const replay = (index: number, clause: unknown) => {
      const number = results.executions[index]?.number;
      if (number !== undefined) {
        void this.replayOfStudy({ uri, number, clause });
      }
    };
    return { key: uri, studied: { uri }, title: studyTitle(results), scenarios: studiedScenarios(results), replay };
  }

  /** Show the recording of an execution of a study. Without one, the command line executes it again first. */
  private async replayOfStudy(wanted: { readonly uri: string; readonly number: number; readonly clause: unknown }): Promise<void> {
    const { uri, number } = wanted;
    if (!isTrace(await this.server.request("robbdd/trace", { uri, number }))) {
      const code = await replayExecution(this.server, vscode.Uri.parse(uri), number);
      if (code === 1) {
        complain("RobBDD: this execution has other verdicts or margins than in the study: the terminal names them.");
      } else if (code !== 0) {
        return;
      }
    }
    await this.replays.open(wanted);
  }

  private show({ key, studied, title, scenarios, replay }: Shown, view: vscode.WebviewPanel, part?: StudyPart): void {
    const sent = packed(scenarios);
    let first = part;
    const begin = (show: StudyPart | undefined) => {
      first = undefined;
      study.post({ type: "results", studied, title, results: sent, ...(show === undefined ? {} : { show }) });
    };
    const study: Panel<ToStudy> = new Panel<ToStudy>(
      view,
      this.extension,
      "study",
      () => {
        // A page that is loaded again shows what it showed last.
        begin(first);
      },
      ({ index, clause }) => {
        if (typeof index === "number") {
          replay(index, clause);
        }
      },
    );
    this.studies.set(key, study);
    this.begins.set(key, (show) => {
      // A hidden page is loaded when it is shown, and asks then.
      if (study.view.visible) {
        begin(show);
      } else {
        first = show;
      }
    });
    study.view.onDidDispose(() => {
      this.studies.delete(key);
      this.begins.delete(key);
    });
  }
}

function local(uri: string): string {
  return decodeURIComponent(uri.split("/").at(-1) ?? "").slice(0, -STUDY.length);
}

/** The text of a file; empty if it does not exist. */
async function textOf(file: vscode.Uri): Promise<string> {
  try {
    return new TextDecoder().decode(await vscode.workspace.fs.readFile(file));
  } catch {
    return "";
  }
}
