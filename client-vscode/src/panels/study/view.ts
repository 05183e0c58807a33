// The results of a stored run over its variations, in a panel with links to the replay of each execution.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { complain } from "../../notices";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { chooseRun } from "../replay/choice";
import type { ReplayView } from "../replay/view";
import { type StoredRun, isRuns, outcome } from "../runs";
import type { StudiedRun, StudyPart, ToStudy } from "./messages";
import { packed } from "./packed";
import { readResults } from "./results";

const TYPE = "robbdd.study";

export class StudyView implements vscode.Disposable {
  /** By the folder of the run. */
  private readonly studies = new Map<string, Panel<ToStudy>>();
  /** Sends the results to the page again, to show another part; by the folder of the run. */
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

  /** Show the results of a stored run of a model's project; the user chooses which run. */
  async choose(uri: string, part: StudyPart): Promise<void> {
    if (!(await this.server.ready())) {
      return;
    }
    const run = await chooseRun(this.server, uri, "Study: which run?");
    const open = run === undefined ? undefined : this.studies.get(run.folder);
    if (open !== undefined) {
      this.begins.get(run?.folder ?? "")?.(part);
      open.view.reveal(undefined, true);
    } else if (run !== undefined) {
      await this.show(run, uri, () => beside(TYPE, `Study run ${run.run}`), part);
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
    if (isRecord(studied) && typeof studied["uri"] === "string" && typeof studied["run"] === "number") {
      const { uri, run: number } = studied;
      const answer = await this.server.request("robbdd/runs", { uri, run: number });
      const [run] = isRuns(answer) ? answer.runs : [];
      if (run !== undefined && (await this.show(run, uri, () => view))) {
        return;
      }
    }
    // The run has been removed, or the project is another one.
    view.dispose();
  }

  private async show(run: StoredRun, uri: string, panel: () => vscode.WebviewPanel, part?: StudyPart): Promise<boolean> {
    const file = vscode.Uri.joinPath(vscode.Uri.parse(run.folder), "results.json");
    const results = readResults(await textOf(file));
    if (results === undefined) {
      complain(`RobBDD: ${file.fsPath} contains no results of this version.`);
      return false;
    }
    const studied: StudiedRun = { uri, run: run.run };
    const title = `Run ${run.run} of ${run.path}: ${outcome(run)}`;
    const sent = packed(results.scenarios);
    let first = part;
    const begin = (show: StudyPart | undefined) => {
      first = undefined;
      study.post({ type: "results", studied, title, results: sent, ...(show === undefined ? {} : { show }) });
    };
    const study: Panel<ToStudy> = new Panel<ToStudy>(
      panel(),
      this.extension,
      "study",
      () => {
        // A page that is loaded again shows what it showed last.
        begin(first);
      },
      ({ index, clause }) => void this.replays.open({ ...studied, index, clause }),
    );
    this.studies.set(run.folder, study);
    this.begins.set(run.folder, (show) => {
      // A hidden page is loaded when it is shown, and asks then.
      if (study.view.visible) {
        begin(show);
      } else {
        first = show;
      }
    });
    study.view.onDidDispose(() => {
      this.studies.delete(run.folder);
      this.begins.delete(run.folder);
    });
    return true;
  }
}

/** The text of a file; empty if it does not exist. */
async function textOf(file: vscode.Uri): Promise<string> {
  try {
    return new TextDecoder().decode(await vscode.workspace.fs.readFile(file));
  } catch {
    return "";
  }
}
