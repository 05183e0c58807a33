// The Testing view: the test tree, its profiles, and the parts that fill and update it.
import * as vscode from "vscode";
import type { Server } from "../client";
import type { Recording } from "../panels/replay/messages";
import type { RunOptionsChooser } from "../runs/chooser";
import type { RunMonitor } from "../runs/monitor";
import { argumentsOf } from "../runs/options";
import { askUntilFailure } from "../runs/untilFailure";
import { ContinuousRuns } from "./continuous";
import { factory, normal } from "./display";
import { ResultsElsewhere } from "./found";
import { type Listing, type Question, isListing } from "./listing";
import { TestRunner } from "./runner";
import { TestTree } from "./tree";
import { Upkeep } from "./upkeep";

export class TestingView implements vscode.Disposable {
  private readonly controller = vscode.tests.createTestController("robbdd", "RobBDD");
  private readonly tree: TestTree<vscode.TestItem>;
  private readonly upkeep: Upkeep;
  private readonly results: ResultsElsewhere;
  private readonly runner: TestRunner;
  private readonly continuous: ContinuousRuns;
  private readonly run: vscode.TestRunProfile;
  private readonly withOptions: vscode.TestRunProfile;
  private readonly untilFailure: vscode.TestRunProfile;
  private readonly debug: vscode.TestRunProfile;
  private readonly record: vscode.TestRunProfile;

  constructor(
    private readonly server: Server,
    monitor: RunMonitor,
    private readonly chooser: RunOptionsChooser,
  ) {
    const { controller } = this;
    const outdated = (items: readonly vscode.TestItem[]) => {
      controller.invalidateTestResults(items);
    };
    const openRun = (title: string, persist = true) =>
      controller.createTestRun(new vscode.TestRunRequest(undefined, undefined, this.run), title, persist);
    this.tree = new TestTree(controller.items, factory(controller), (question) => this.ask(question), outdated);
    this.results = new ResultsElsewhere(server, this.tree, openRun, outdated);
    this.upkeep = new Upkeep(this.tree, () => this.results.restore());
    this.runner = new TestRunner(server, monitor, controller, this.tree, openRun, () => this.upkeep.discover());
    this.continuous = new ContinuousRuns(this.tree, this.upkeep, this.runner);
    controller.resolveHandler = (item) => this.resolve(item);
    controller.refreshHandler = async () => {
      await this.upkeep.discover();
      await this.upkeep.showVisible(true);
    };
    const { Debug, Run } = vscode.TestRunProfileKind;
    this.run = controller.createRunProfile("Run", Run, (request, token) => this.start(request, token), true, undefined, true);
    this.withOptions = controller.createRunProfile("Run with Options…", Run, (request, token) =>
      this.startWithOptions(request, token),
    );
    this.untilFailure = controller.createRunProfile("Run until It Fails…", Run, (request, token) =>
      this.startUntilFailure(request, token),
    );
    this.debug = controller.createRunProfile("Debug", Debug, (request, token) =>
      this.runner.execute(request, token, "robbdd.run", { options: { debug: true } }),
    );
    this.record = controller.createRunProfile("Run with Recording", Run, (request, token) =>
      this.runner.execute(request, token, "robbdd.record"),
    );
  }

  /** The server accepts requests now. */
  async serverReady(): Promise<void> {
    this.results.reset();
    if (this.upkeep.watches) {
      await this.tree.discover();
      await this.results.restore();
    }
    await this.upkeep.showVisible();
  }

  /** The recording of a test for a replay: of a scenario, of a clause's scenario, or of a variant. */
  recording(item: vscode.TestItem): (Recording & { readonly clause?: string }) | undefined {
    const facts = this.tree.about(item);
    if (facts?.variant === undefined) {
      return undefined;
    }
    const { uri, variant, execution, number, clause } = facts;
    return {
      uri,
      variant,
      ...(execution === undefined ? {} : { execution }),
      ...(number === undefined ? {} : { variation: number }),
      ...(clause === undefined ? {} : { clause }),
    };
  }

  /** Show the results in a file; without one, the user chooses it. */
  importResults(file?: vscode.Uri): Promise<void> {
    return this.results.importFile(file);
  }

  dispose(): void {
    for (const part of [this.upkeep, this.runner, this.continuous, this.run, this.withOptions, this.untilFailure, this.debug, this.record, this.controller]) {
      part.dispose();
    }
  }

  private async ask(question: Question): Promise<Listing | undefined> {
    const answer = await this.server.request("robbdd/tests", question);
    return isListing(answer) ? { ...answer, files: answer.files.map(normal) } : undefined;
  }

  private async resolve(item: vscode.TestItem | undefined): Promise<void> {
    if (item === undefined) {
      await this.server.begin();
      this.upkeep.watch();
    }
    await this.tree.expand(item);
    await this.results.restore();
  }

  private async startWithOptions(request: vscode.TestRunRequest, token: vscode.CancellationToken): Promise<void> {
    if (!(await this.server.ready())) {
      return;
    }
    if (request.include === undefined) {
      await this.upkeep.discover();
    }
    const files = this.runner.choose(request);
    const [file] = files;
    const options = file && (await this.chooser.choose(vscode.Uri.parse(file.uri), files.map(({ only }) => ({ only }))));
    if (options !== undefined) {
      await this.runner.execute(request, token, "robbdd.run", { options: argumentsOf(options) });
    }
  }

  private async startUntilFailure(request: vscode.TestRunRequest, token: vscode.CancellationToken): Promise<void> {
    const options = await askUntilFailure();
    if (options !== undefined) {
      await this.runner.execute(request, token, "robbdd.run", { options });
    }
  }

  private async start(request: vscode.TestRunRequest, token: vscode.CancellationToken): Promise<void> {
    if (request.continuous === true) {
      this.continuous.add(request, token);
    } else {
      await this.runner.execute(request, token, "robbdd.run");
    }
  }
}
