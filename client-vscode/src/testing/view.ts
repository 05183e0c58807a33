// The Testing view: the tree of tests, its profiles, and the runs of the server, whoever began them.
import * as vscode from "vscode";
import type { Server } from "../client";
import type { Recording } from "../panels/replay/messages";
import type { RunMessage, RunNotification } from "../runs/messages";
import type { RunMonitor } from "../runs/monitor";
import { RunFollower, type Sink } from "./follower";
import type { Factory } from "./items";
import { type Place, type Question, isListing } from "./listing";
import { type FoundScenario, isFoundResults, showResults } from "./results";
import { type FileRun, fileRuns } from "./selection";
import { TestTree } from "./tree";
import { isRecord } from "../values";

const LANGUAGE = "robbdd";
const FILES = "**/*.{bdd,scene}";
/** Milliseconds without a keystroke after which the tree follows the text. */
const PAUSE = 400;
/** Milliseconds that a cancelled run is given to end by itself. */
const CANCEL_LIMIT = 400;
/** What names of runs begin with that were begun here. */
const OWN = "testing-";

interface Continuous {
  readonly request: vscode.TestRunRequest;
  running: Promise<void>;
  current: vscode.CancellationTokenSource | undefined;
}

export class TestingView implements vscode.Disposable {
  private readonly controller = vscode.tests.createTestController("robbdd", "RobBDD");
  private readonly tree: TestTree<vscode.TestItem>;
  private readonly run: vscode.TestRunProfile;
  private readonly disposables: { dispose(): unknown }[] = [];
  private readonly followers = new Map<string, RunFollower<vscode.TestItem>>();
  private readonly continuous = new Set<Continuous>();
  private readonly timers = new Map<string, NodeJS.Timeout>();
  private watcher: vscode.FileSystemWatcher | undefined;
  private runs = 0;
  /** Resolves when the server is done with what was begun here. */
  private turn: Promise<void> = Promise.resolve();
  private restored: Promise<void> | undefined;

  constructor(
    private readonly server: Server,
    monitor: RunMonitor,
  ) {
    const { controller } = this;
    this.tree = new TestTree(controller.items, factory(controller), (question) => this.ask(question), (items) => {
      controller.invalidateTestResults(items);
    });
    controller.resolveHandler = (item) => this.resolve(item);
    controller.refreshHandler = () => this.refreshAll();
    const { Run } = vscode.TestRunProfileKind;
    this.run = controller.createRunProfile("Run", Run, (request, token) => this.start(request, token), true, undefined, true);
    const record = controller.createRunProfile("Run with Recording", Run, (request, token) =>
      this.execute(request, token, "robbdd.record"),
    );
    this.disposables.push(
      controller,
      this.run,
      record,
      monitor.onMessage((message) => {
        this.hear(message);
      }),
      monitor.onOver(() => void this.abandonOthers()),
      vscode.window.onDidChangeVisibleTextEditors(() => void this.showVisible()),
      vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
        if (contentChanges.length > 0) {
          this.followSoon(document.uri.toString());
        }
      }),
      vscode.workspace.onDidSaveTextDocument((document) => {
        this.saved(document.uri.toString());
      }),
    );
  }

  /** The server can be asked now. */
  async serverReady(): Promise<void> {
    this.restored = undefined;
    if (this.watcher !== undefined) {
      await this.tree.discover();
      await this.restore();
    }
    await this.showVisible();
  }

  /** What is recorded of a test, for a replay: of a scenario, of the one around a clause, or of a variant's. */
  recording(item: vscode.TestItem): (Recording & { readonly clause?: string }) | undefined {
    const facts = this.tree.about(item);
    if (facts?.variant === undefined) {
      return undefined;
    }
    const { uri, variant, number, clause } = facts;
    return {
      uri,
      variant,
      ...(number === undefined ? {} : { variation: number }),
      ...(clause === undefined ? {} : { clause }),
    };
  }

  /** Show the results that a file holds, which `robbdd run` wrote here or in CI. */
  async importResults(file?: vscode.Uri): Promise<void> {
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
      await this.showFound(scenarios, name, true);
      const rest = left > 0 ? `; ${left} of scenarios that the workspace does not have are left out` : "";
      void vscode.window.showInformationMessage(`RobBDD: ${scenarios.length} results of ${name} are shown${rest}.`);
      await vscode.commands.executeCommand("workbench.view.testing.focus");
    }
  }

  dispose(): void {
    for (const timer of this.timers.values()) {
      clearTimeout(timer);
    }
    this.watcher?.dispose();
    for (const disposable of this.disposables) {
      disposable.dispose();
    }
  }

  private async ask(question: Question) {
    const answer = await this.server.request("robbdd/tests", question);
    return isListing(answer) ? { ...answer, files: answer.files.map(normal) } : undefined;
  }

  /** Show once what the server kept of runs, those of earlier sessions too. */
  private restore(): Promise<void> {
    this.restored ??= (async () => {
      const answer = await this.server.request("robbdd/testResults", {});
      if (isFoundResults(answer) && answer.scenarios.length > 0) {
        await this.showFound(answer.scenarios, "Kept results", false);
      }
    })();
    return this.restored;
  }

  private async showFound(scenarios: readonly FoundScenario[], name: string, persist: boolean): Promise<void> {
    const found = scenarios.map((scenario) => ({ ...scenario, uri: normal(scenario.uri) }));
    const run = this.controller.createTestRun(new vscode.TestRunRequest(undefined, undefined, this.run), name, persist);
    const outdated = await showResults(this.tree, found, sinkOf(run));
    run.end();
    if (outdated.length > 0) {
      this.controller.invalidateTestResults(outdated);
    }
  }

  private async resolve(item: vscode.TestItem | undefined): Promise<void> {
    if (item === undefined) {
      await this.server.begin();
      this.watch();
    }
    await this.tree.expand(item);
    await this.restore();
  }

  /** From the first opening of the view on the tree knows all files of the workspace, so that it has to follow them. */
  private watch(): void {
    if (this.watcher !== undefined) {
      return;
    }
    this.watcher = vscode.workspace.createFileSystemWatcher(FILES);
    const follow = (file: vscode.Uri) => {
      this.followSoon(file.toString());
    };
    this.watcher.onDidCreate(follow);
    this.watcher.onDidChange(follow);
    this.watcher.onDidDelete((file) => {
      this.tree.forget(file.toString());
      follow(file);
    });
  }

  private async refreshAll(): Promise<void> {
    this.watch();
    await this.tree.discover();
    await this.showVisible(true);
  }

  /** Give the files that are shown their icons. */
  private async showVisible(again = false): Promise<void> {
    for (const uri of shownFiles()) {
      if (again || !this.tree.knows(uri)) {
        await this.tree.load(uri);
        await this.tree.expandSmall(uri);
        await this.restore();
      }
    }
  }

  private followSoon(uri: string): void {
    clearTimeout(this.timers.get(uri));
    this.timers.set(
      uri,
      setTimeout(() => {
        this.timers.delete(uri);
        void this.follow(uri);
      }, PAUSE),
    );
  }

  private async follow(uri: string): Promise<void> {
    const shown = shownFiles();
    const affected = new Set(this.tree.dependents(uri));
    if (uri.endsWith(".bdd") && (this.watcher !== undefined || shown.includes(uri)) && (await exists(uri))) {
      affected.add(uri);
    }
    for (const file of affected) {
      await this.tree.load(file);
      if (shown.includes(file)) {
        await this.tree.expandSmall(file);
      }
    }
  }

  private async start(request: vscode.TestRunRequest, token: vscode.CancellationToken): Promise<void> {
    if (request.continuous !== true) {
      await this.execute(request, token, "robbdd.run");
      return;
    }
    const entry: Continuous = { request, running: Promise.resolve(), current: undefined };
    this.continuous.add(entry);
    token.onCancellationRequested(() => {
      this.continuous.delete(entry);
      entry.current?.cancel();
    });
  }

  /** Run again what depends on a saved file; a run that is under way would tell of the text before. */
  private saved(uri: string): void {
    for (const entry of this.continuous) {
      const affected = new Set([uri, ...this.tree.dependents(uri)]);
      if (this.choose(entry.request).some((run) => affected.has(run.uri))) {
        entry.current?.cancel();
        const source = new vscode.CancellationTokenSource();
        entry.current = source;
        entry.running = entry.running
          .then(async () => {
            if (!source.token.isCancellationRequested) {
              await this.follow(uri);
              await this.execute(entry.request, source.token, "robbdd.run", affected);
            }
          })
          .finally(() => {
            source.dispose();
          });
      }
    }
  }

  private choose(request: vscode.TestRunRequest): FileRun[] {
    const about = (item: vscode.TestItem) => this.tree.about(item);
    return fileRuns(this.controller.items, about, request.include, request.exclude ?? []);
  }

  private async execute(
    request: vscode.TestRunRequest,
    token: vscode.CancellationToken,
    command: string,
    among?: ReadonlySet<string>,
  ): Promise<void> {
    if (!(await this.server.ready())) {
      return;
    }
    if (request.include === undefined) {
      this.watch();
      await this.tree.discover();
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
          await this.executeFile(run, file, token, command);
        }
      }
    } finally {
      run.end();
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
    const follower = new RunFollower(this.tree, sinkOf(run), vscode.workspace.asRelativePath(vscode.Uri.parse(uri)), now);
    this.followers.set(name, follower);
    const cancelling = token.onCancellationRequested(() => void this.server.execute("robbdd.cancel", {}));
    const executed = this.server.execute(command, { uri, only, token: name }).then(async (answer) => {
      cancelling.dispose();
      pass();
      await follower.settled();
      const problem = problemOf(answer);
      if (problem !== undefined) {
        follower.refuse(only.flatMap((wanted) => this.tree.wanted(uri, wanted)), problem);
      }
      for (const picture of picturesOf(answer)) {
        run.appendOutput(`    picture: ${vscode.Uri.parse(picture).fsPath}\r\n`);
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
      const title = vscode.workspace.asRelativePath(vscode.Uri.parse(message.uri));
      const request = new vscode.TestRunRequest(undefined, undefined, this.run);
      const run = this.controller.createTestRun(request, title);
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

  /** End the entries of runs that were begun elsewhere and broke off. */
  private async abandonOthers(): Promise<void> {
    for (const [name, follower] of this.followers) {
      if (!name.startsWith(OWN)) {
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

function factory(controller: vscode.TestController): Factory<vscode.TestItem> {
  return {
    create: (id, label, uri) => controller.createTestItem(id, label, vscode.Uri.parse(uri)),
    setPlace: (item, place) => {
      const here = place !== null && item.uri?.toString() === vscode.Uri.parse(place.uri).toString();
      item.range = here ? rangeOf(place) : undefined;
    },
    setProblem: (item, problem) => {
      item.error = problem;
    },
  };
}

/** What one run of the server shows; the editor's run may hold several of these. */
function sinkOf(run: vscode.TestRun, onEnd: () => void = () => undefined): Sink<vscode.TestItem> {
  let ended = false;
  const open = (show: () => void) => {
    if (!ended) {
      show();
    }
  };
  return {
    started: (item) => {
      open(() => {
        run.started(item);
      });
    },
    passed: (item, duration) => {
      open(() => {
        run.passed(item, duration);
      });
    },
    failed: (item, { text, expected, actual }, place, duration) => {
      open(() => {
        const compared = expected !== undefined && actual !== undefined;
        const message = compared ? vscode.TestMessage.diff(text, expected, actual) : new vscode.TestMessage(text);
        run.failed(item, located(message, place), duration);
      });
    },
    errored: (item, { text }, place, duration) => {
      open(() => {
        run.errored(item, located(new vscode.TestMessage(text), place), duration);
      });
    },
    output: (line, item) => {
      open(() => {
        run.appendOutput(`${line}\r\n`, undefined, item);
      });
    },
    end: () => {
      open(onEnd);
      ended = true;
    },
  };
}

/** An address as the editor writes it: the server may escape other characters. */
function normal(uri: string): string {
  return vscode.Uri.parse(uri).toString();
}

function normalised(notification: RunNotification): RunNotification {
  const { message } = notification;
  const source = "source" in message ? message.source : undefined;
  return source
    ? { ...notification, message: { ...message, source: { ...source, uri: normal(source.uri) } } as RunMessage }
    : notification;
}

function located(message: vscode.TestMessage, place: Place | null): vscode.TestMessage {
  if (place !== null) {
    message.location = new vscode.Location(vscode.Uri.parse(place.uri), rangeOf(place));
  }
  return message;
}

function rangeOf({ range: { start, end } }: Place): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}

async function chooseFile(): Promise<vscode.Uri | undefined> {
  const filters = { "Results of robbdd run": ["json", "xml"] };
  const [file] = (await vscode.window.showOpenDialog({ filters, openLabel: "Show Results" })) ?? [];
  return file;
}

function problemOf(answer: unknown): string | undefined {
  const problem = isRecord(answer) ? answer["problem"] : undefined;
  return typeof problem === "string" ? problem : undefined;
}

function picturesOf(answer: unknown): string[] {
  const found: unknown = isRecord(answer) ? answer["pictures"] : undefined;
  return Array.isArray(found) ? found.filter((entry) => typeof entry === "string") : [];
}

function shownFiles(): string[] {
  const documents = vscode.window.visibleTextEditors.map(({ document }) => document);
  return documents.filter((document) => document.languageId === LANGUAGE).map(({ uri }) => uri.toString());
}

async function exists(uri: string): Promise<boolean> {
  return vscode.workspace.fs.stat(vscode.Uri.parse(uri)).then(
    () => true,
    () => false,
  );
}

function now(): number {
  return Date.now();
}
