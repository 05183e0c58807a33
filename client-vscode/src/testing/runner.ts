// Runs of the server in the Testing view: those started in it, and those started elsewhere.
import * as vscode from "vscode";
import type { Server } from "../client";
import { withoutControls } from "../literal";
import type { RunNotification } from "../runs/messages";
import type { Refusal, RunMonitor } from "../runs/monitor";
import { makesPictures, recordingWords } from "../runs/recording";
import { problemOf } from "./answers";
import { normal, normalised, sinkOf, titleOf } from "./display";
import { RunFollower } from "./follower";
import { type FileRun, fileRuns } from "./selection";
import type { TestTree } from "./tree";

/** Time that a cancelled run has to end by itself, ms. */
const CANCEL_LIMIT = 400;
/** Prefix of the names of runs started here. */
const OWN = "testing-";

/**
 * Opens an entry in the editor's results that was not requested in the view; `persist` keeps it for the next session.
 */
export type OpenRun = (title: string, persist?: boolean) => vscode.TestRun;

export class TestRunner implements vscode.Disposable {
  private readonly followers = new Map<string, RunFollower<vscode.TestItem>>();
  private readonly listeners: readonly vscode.Disposable[];
  private runs = 0;
  /** Resolves when the server has finished all runs started here. */
  private turn: Promise<void> = Promise.resolve();

  /** `discover` finds all tests, for a run of everything. */
  constructor(
    private readonly server: Server,
    monitor: RunMonitor,
    private readonly controller: vscode.TestController,
    private readonly tree: TestTree<vscode.TestItem>,
    private readonly openRun: OpenRun,
    private readonly discover: () => Promise<void>,
  ) {
    this.listeners = [
      monitor.onMessage((message) => {
        this.hear(message);
      }),
      monitor.onOver((name) => void this.abandonOthers(name)),
      monitor.onRefused((refusal) => void this.refuse(refusal)),
    ];
  }

  /** The files and items of a request. */
  choose(request: vscode.TestRunRequest): FileRun[] {
    const about = (item: vscode.TestItem) => this.tree.about(item);
    return fileRuns(this.controller.items, about, request.include, request.exclude ?? []);
  }

  /** Run a request, restricted to the files `among` if given, by a command of the server with `options`. */
  async execute(
    request: vscode.TestRunRequest,
    token: vscode.CancellationToken,
    command: string,
    { among, options = {} }: { readonly among?: ReadonlySet<string>; readonly options?: Readonly<Record<string, unknown>> } = {},
  ): Promise<void> {
    if (!(await this.server.ready())) {
      return;
    }
    if (request.include === undefined) {
      await this.discover();
    }
    const chosen = this.choose(request).filter(({ uri }) => among?.has(uri) ?? true);
    const run = this.controller.createTestRun(request);
    try {
      for (const file of chosen) {
        await this.tree.expandSmall(file.uri);
        this.enqueue(run, file);
      }
      for (const file of chosen) {
        if (!token.isCancellationRequested) {
          await this.executeFile(run, file, token, command, options);
        }
      }
    } finally {
      run.end();
    }
  }

  dispose(): void {
    for (const listener of this.listeners) {
      listener.dispose();
    }
  }

  private enqueue(run: vscode.TestRun, { uri, only }: FileRun): void {
    for (const wanted of only) {
      for (const scenario of this.tree.scenariosOf(uri, wanted)) {
        for (const clause of this.tree.clauses(scenario)) {
          run.enqueued(clause);
        }
      }
    }
  }

  private async executeFile(
    run: vscode.TestRun,
    { uri, only }: FileRun,
    token: vscode.CancellationToken,
    command: string,
    options: Readonly<Record<string, unknown>>,
  ): Promise<void> {
    const cancelled = new Promise<void>((resolve) => {
      token.onCancellationRequested(() => {
        setTimeout(resolve, CANCEL_LIMIT);
      });
    });
    const before = this.turn;
    const { promise: turn, resolve: pass } = whenResolved();
    this.turn = turn;
    // The server executes one run at a time, and a cancelled one may still be ending.
    await Promise.race([before, cancelled]);
    if (token.isCancellationRequested) {
      void before.then(pass);
      return;
    }
    this.runs += 1;
    const name = `${OWN}${this.runs}`;
    const follower = new RunFollower(this.tree, sinkOf(run), titleOf(uri), now);
    this.followers.set(name, follower);
    const cancelling = token.onCancellationRequested(() => void this.server.execute("robbdd.cancel", {}));
    const executed = this.server.execute(command, { uri, only, token: name, ...options }).then(async (answer) => {
      cancelling.dispose();
      pass();
      await follower.settled();
      const problem = problemOf(answer);
      if (problem !== undefined) {
        follower.refuse(only.flatMap((wanted) => this.tree.wanted(uri, wanted)), problem);
      }
      for (const line of makesPictures(command, options) ? recordingWords(answer) : []) {
        run.appendOutput(`${withoutControls(line)}\r\n`);
      }
    });
    await Promise.race([executed, cancelled]);
    this.followers.delete(name);
    await follower.interrupt("The run did not finish.");
  }

  /** Show the messages of a run; one started elsewhere gets its own entry. */
  private hear(message: RunNotification): void {
    const name = message.run;
    let follower = this.followers.get(name);
    if (follower === undefined && !name.startsWith(OWN) && message.message.type === "RunStarted") {
      const title = titleOf(message.uri);
      const run = this.openRun(title);
      run.token.onCancellationRequested(() => void this.server.execute("robbdd.cancel", {}));
      const sink = sinkOf(run, () => {
        run.end();
      });
      follower = new RunFollower(this.tree, sink, title, now);
      this.followers.set(name, follower);
    }
    follower?.take(normalised(message));
    if (message.message.type === "RunFinished") {
      void this.tree.refresh(normal(message.uri));
    }
    if (message.message.type === "RunFinished" && !name.startsWith(OWN)) {
      this.followers.delete(name);
      void follower?.interrupt("");
    }
  }

  /** Show at its variants why a request from elsewhere was not run. */
  private async refuse({ uri, scenario, token, problem }: Refusal): Promise<void> {
    if (token?.startsWith(OWN) === true) {
      return;
    }
    const model = normal(uri);
    if (!this.tree.knows(model)) {
      await this.tree.load(model);
    }
    const variants = this.tree.variantsOf(model).filter((item) => {
      return scenario === undefined || this.tree.about(item)?.variant === scenario;
    });
    if (variants.length > 0) {
      const run = this.openRun(titleOf(uri));
      new RunFollower(this.tree, sinkOf(run), titleOf(uri), now).refuse(variants, problem);
      run.end();
    }
  }

  /** End the entry of an aborted run that was started elsewhere, or of all such runs without a name. */
  private async abandonOthers(over: string | undefined): Promise<void> {
    for (const [name, follower] of this.followers) {
      if (!name.startsWith(OWN) && (over === undefined || over === name)) {
        this.followers.delete(name);
        await follower.interrupt("The run ended before it was complete.");
      }
    }
  }
}

function whenResolved(): { readonly promise: Promise<void>; readonly resolve: () => void } {
  let resolve = (): void => undefined;
  const promise = new Promise<void>((done) => {
    resolve = done;
  });
  return { promise, resolve };
}

function now(): number {
  return Date.now();
}
