// Results from outside this window's runs: those kept by the server, and those of a file.
import * as vscode from "vscode";
import type { Server } from "../client";
import { complain, inform, warn } from "../notices";
import { normal, sinkOf } from "./display";
import { type FoundScenario, isFoundResults, showResults } from "./results";
import type { OpenRun } from "./runner";
import type { TestTree } from "./tree";

export class ResultsElsewhere {
  private restored: Promise<void> | undefined;
  /** Kept results not yet shown: of scenarios that are not listed. */
  private left: readonly FoundScenario[] = [];

  constructor(
    private readonly server: Server,
    private readonly tree: TestTree<vscode.TestItem>,
    private readonly openRun: OpenRun,
    private readonly outdated: (items: readonly vscode.TestItem[]) => void,
  ) {}

  /** Show once the results kept by the server, also of earlier sessions; the rest when more scenarios are listed. */
  async restore(): Promise<void> {
    this.restored ??= (async () => {
      const answer = await this.server.request("robbdd/testResults", {});
      this.left = isFoundResults(answer) ? answer.scenarios.map(normalised) : [];
    })();
    await this.restored;
    const due = this.left.filter((found) => this.isDue(found));
    if (due.length > 0) {
      this.left = this.left.filter((found) => !this.isDue(found));
      const left = await this.show(due, "Kept results", false);
      this.left = [...this.left, ...left];
    }
  }

  /** The server has changed, and its kept results may differ. */
  reset(): void {
    this.restored = undefined;
  }

  /** Show the results in a file written by `robbdd run` here or in CI; the user chooses the file. */
  async importFile(file?: vscode.Uri): Promise<void> {
    const chosen = file ?? (await chooseFile());
    if (chosen === undefined || !(await this.server.ready())) {
      return;
    }
    const answer = await this.server.request("robbdd/importResults", { uri: chosen.toString() });
    if (!isFoundResults(answer)) {
      return;
    }
    const { problem, scenarios, left } = answer;
    const name = vscode.workspace.asRelativePath(chosen);
    if (problem !== null) {
      complain(`RobBDD: ${problem}`);
    } else if (scenarios.length === 0) {
      warn(`RobBDD: ${name} has no results of a scenario in this workspace.`);
    } else {
      await this.show(scenarios.map(normalised), name, true);
      const rest = left > 0 ? `; ${left} of scenarios outside the workspace are left out` : "";
      inform(`RobBDD: ${scenarios.length} results of ${name} are shown${rest}.`);
      await vscode.commands.executeCommand("workbench.view.testing.focus");
    }
  }

  /** Whether a result can be shown now, or whether this can be found out. */
  private isDue({ uri, variant, execution, variation }: FoundScenario): boolean {
    const item = this.tree.source(uri, { variant, execution: execution ?? undefined });
    return item === undefined || item.children.size === 0 || this.tree.lists(item, variation);
  }

  private async show(found: readonly FoundScenario[], name: string, persist: boolean): Promise<readonly FoundScenario[]> {
    const run = this.openRun(name, persist);
    const { outdated, left } = await showResults(this.tree, found, sinkOf(run));
    run.end();
    if (outdated.length > 0) {
      this.outdated(outdated);
    }
    return left;
  }
}

function normalised(found: FoundScenario): FoundScenario {
  return { ...found, uri: normal(found.uri) };
}

async function chooseFile(): Promise<vscode.Uri | undefined> {
  const filters = { "Results of robbdd run": ["json", "xml"] };
  const [file] = (await vscode.window.showOpenDialog({ filters, openLabel: "Show Results" })) ?? [];
  return file;
}
