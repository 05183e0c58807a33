// The results of a stored run over its variations, in a panel with links to the replay of each execution.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { complain } from "../../notices";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { chooseRun } from "../replay/choice";
import type { ReplayView } from "../replay/view";
import { type StoredRun, isRuns, outcome } from "../runs";
import type { StudiedRun, ToStudy } from "./messages";
import { readResults } from "./results";

const TYPE = "robbdd.study";

export class StudyView implements vscode.Disposable {
  /** By the folder of the run. */
  private readonly studies = new Map<string, Panel<ToStudy>>();
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

  /** Show the results of a stored run of a model's project; the user chooses which. */
  async choose(uri: string): Promise<void> {
    if (!(await this.server.ready())) {
      return;
    }
    const run = await chooseRun(this.server, uri, "Study: which run?");
    const open = run === undefined ? undefined : this.studies.get(run.folder);
    if (open !== undefined) {
      open.view.reveal(undefined, true);
    } else if (run !== undefined) {
      await this.show(run, uri, () => beside(TYPE, `Study run ${run.run}`));
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

  private async show(run: StoredRun, uri: string, panel: () => vscode.WebviewPanel): Promise<boolean> {
    const file = vscode.Uri.joinPath(vscode.Uri.parse(run.folder), "results.json");
    const results = readResults(await textOf(file));
    if (results === undefined) {
      complain(`RobBDD: ${file.fsPath} contains no results of this version.`);
      return false;
    }
    const studied: StudiedRun = { uri, run: run.run };
    const title = `Run ${run.run} of ${run.path}: ${outcome(run)}`;
    const study: Panel<ToStudy> = new Panel<ToStudy>(
      panel(),
      this.extension,
      "study",
      () => {
        study.post({ type: "results", studied, title, results });
      },
      ({ index, clause }) => void this.replays.open({ ...studied, index, clause }),
    );
    this.studies.set(run.folder, study);
    study.view.onDidDispose(() => {
      this.studies.delete(run.folder);
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
