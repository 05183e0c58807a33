// Results that no run of this window has found: those that the server kept, and those of a file.
import * as vscode from "vscode";
import type { Server } from "../client";
import { normal, sinkOf } from "./display";
import { type FoundScenario, isFoundResults, showResults } from "./results";
import type { OpenRun } from "./runner";
import type { TestTree } from "./tree";

export class ResultsElsewhere {
  private restored: Promise<void> | undefined;

  constructor(
    private readonly server: Server,
    private readonly tree: TestTree<vscode.TestItem>,
    private readonly openRun: OpenRun,
    private readonly outdated: (items: readonly vscode.TestItem[]) => void,
  ) {}

  /** Show once what the server kept of runs, those of earlier sessions too. */
  restore(): Promise<void> {
    this.restored ??= (async () => {
      const answer = await this.server.request("robbdd/testResults", {});
      if (isFoundResults(answer) && answer.scenarios.length > 0) {
        await this.show(answer.scenarios, "Kept results", false);
      }
    })();
    return this.restored;
  }

  /** There is another server, which may have kept other results. */
  reset(): void {
    this.restored = undefined;
  }

  /** Show the results that a file holds, which `robbdd run` wrote here or in CI; the user is asked for the file. */
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
      void vscode.window.showErrorMessage(`RobBDD: ${problem}`);
    } else if (scenarios.length === 0) {
      void vscode.window.showWarningMessage(`RobBDD: ${name} has no results of a scenario in this workspace.`);
    } else {
      await this.show(scenarios, name, true);
      const rest = left > 0 ? `; ${left} of scenarios that the workspace does not have are left out` : "";
      void vscode.window.showInformationMessage(`RobBDD: ${scenarios.length} results of ${name} are shown${rest}.`);
      await vscode.commands.executeCommand("workbench.view.testing.focus");
    }
  }

  private async show(scenarios: readonly FoundScenario[], name: string, persist: boolean): Promise<void> {
    const found = scenarios.map((scenario) => ({ ...scenario, uri: normal(scenario.uri) }));
    const run = this.openRun(name, persist);
    const outdated = await showResults(this.tree, found, sinkOf(run));
    run.end();
    if (outdated.length > 0) {
      this.outdated(outdated);
    }
  }
}

async function chooseFile(): Promise<vscode.Uri | undefined> {
  const filters = { "Results of robbdd run": ["json", "xml"] };
  const [file] = (await vscode.window.showOpenDialog({ filters, openLabel: "Show Results" })) ?? [];
  return file;
}
