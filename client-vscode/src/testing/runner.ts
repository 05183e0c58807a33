// Runs of the server as the Testing view shows them: those begun in it, and those begun elsewhere.
import * as vscode from "vscode";
import type { Server } from "../client";
import type { RunNotification } from "../runs/messages";
import type { Refusal, RunMonitor } from "../runs/monitor";
import { picturesOf, problemOf, recordedIn } from "./answers";
import { normal, normalised, sinkOf, titleOf } from "./display";
import { RunFollower } from "./follower";
import { type FileRun, fileRuns } from "./selection";
import type { TestTree } from "./tree";

/** Milliseconds that a cancelled run is given to end by itself. */
const CANCEL_LIMIT = 400;
/** What names of runs begin with that were begun here. */
const OWN = "testing-";

/** Opens an entry among the editor's results that nobody asked for in the view; `persist` keeps it for the next session. */
export type OpenRun = (title: string, persist?: boolean) => vscode.TestRun;

export class TestRunner implements vscode.Disposable {
  private readonly followers = new Map<string, RunFollower<vscode.TestItem>>();
  private readonly listeners: readonly vscode.Disposable[];
  private runs = 0;
  /** Resolves when the server is done with what was begun here. */
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

  /** What of which files a request is about. */
  choose(request: vscode.TestRunRequest): FileRun[] {
    const about = (item: vscode.TestItem) => this.tree.about(item);
    return fileRuns(this.controller.items, about, request.include, request.exclude ?? []);
  }

  /** Run what is asked for, of the files `among` where they are named, by a command of the server with `options`. */
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
    // The server does one run at a time, and a cancelled one may still be on its way out.
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
      for (const line of command === "robbdd.record" ? recordingWords(answer) : []) {
        run.appendOutput(`${line}\r\n`);
      }
    });
    await Promise.race([executed, cancelled]);
    this.followers.delete(name);
    await follower.interrupt("The run did not come to its end.");
  }

  /** Show what a run says; one that was begun elsewhere gets an entry of its own. */
  private hear(message: RunNotification): void {
    const name = message.run ?? message.uri;
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
    if (message.message.type === "RunFinished" && !name.startsWith(OWN)) {
      this.followers.delete(name);
      void follower?.interrupt("");
    }
  }

  /** Show at its variants why what was asked for elsewhere was not run. */
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

  /** End the entry of a run that was begun elsewhere and broke off, or those of all without a name. */
  private async abandonOthers(over: string | undefined): Promise<void> {
    for (const [name, follower] of this.followers) {
      if (!name.startsWith(OWN) && (over === undefined || over === name)) {
        this.followers.delete(name);
        await follower.interrupt("The run ended before it was complete.");
      }
    }
  }
}

/** What a run with recording says at its end: paths, which the terminal makes links of. */
function recordingWords(answer: unknown): string[] {
  const path = (uri: string) => vscode.Uri.parse(uri).fsPath;
  const folder = recordedIn(answer);
  const pictures = picturesOf(answer).map((picture) => `    picture of a violation: ${path(picture)}`);
  const recorded = `● Recorded, for a replay too: ${path(folder ?? "")}${pictures.length > 0 ? "" : ". Nothing was violated that could be pictured."}`;
  return folder === undefined ? pictures : [recorded, ...pictures];
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
