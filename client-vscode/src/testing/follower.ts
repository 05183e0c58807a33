// Show the messages of a run at the items of the test tree.
import type { ClauseJudged, ClauseStarted, RunNotification, ScenarioStarted } from "../runs/messages";
import { RunReport } from "../runs/report";
import type { Item } from "./items";
import type { ListedTest, Place } from "./listing";
import { type Failure, type Outcome, folded, inFailed, outcomeOf } from "./outcomes";
import type { TestTree } from "./tree";
import { Worst } from "./worst";

/** A run as shown by the editor; it ignores messages after its end. */
export interface Sink<I> {
  started(item: I): void;
  passed(item: I, duration?: number): void;
  failed(item: I, failure: Failure, place: Place | null, duration?: number): void;
  errored(item: I, failure: Failure, place: Place | null, duration?: number): void;
  skipped(item: I): void;
  output(line: string, item?: I, place?: Place | null): void;
  end(): void;
}

interface Begun<I> {
  readonly item: I;
  readonly values: string;
  /** Positions of the clauses that have failed or have an error. */
  readonly failing: Set<number>;
  /** Whether a clause is violated. */
  failed: boolean;
  /** Clauses that hold. */
  readonly held: Set<I>;
  /** Whether the scenario has ended, with a verdict on each clause. */
  finished: boolean;
  /** Displays of unknown clauses, which wait for the end of the scenario: the editor never takes back an error. */
  waiting: ((failed: boolean) => void)[];
  /** When the judgement of the current clause began, ms. */
  since: number;
}

/** Follows one run of the server. Messages are processed in order, even if one needs a file to be read. */
export class RunFollower<I extends Item<I>> {
  private readonly scenarios = new Map<number, Begun<I>>();
  private readonly worst = new Worst<I>();
  /** Clauses that hold in a scenario that has ended; repetitions of a scenario share their clauses. */
  private readonly proven = new Set<I>();
  private readonly report: RunReport;
  private pending: Promise<void> = Promise.resolve();

  constructor(
    private readonly tree: TestTree<I>,
    private readonly sink: Sink<I>,
    name: string,
    private readonly now: () => number,
  ) {
    this.report = new RunReport(name);
  }

  take({ uri, message }: RunNotification): void {
    const instant = this.now();
    this.pending = this.pending.then(async () => {
      if (message.type === "ScenarioStarted") {
        await this.begin(uri, message, instant);
      } else if (message.type === "ClauseStarted") {
        this.start(message, instant);
      } else if (message.type === "ClauseJudged") {
        this.judge(message, instant);
      } else if (message.type === "ScenarioFinished") {
        this.finish(this.scenarios.get(message.index));
      }
      const scenario = "index" in message && message.index !== null ? this.scenarios.get(message.index) : undefined;
      for (const line of this.report.add(message)) {
        this.sink.output(line, scenario?.item);
      }
    });
  }

  /** Show at the requested items why nothing was run. */
  refuse(items: readonly I[], problem: string): void {
    for (const item of items) {
      this.sink.errored(item, { text: problem }, null);
    }
    this.report.interrupt(problem);
    this.sink.output(`■ ${problem}`);
  }

  /** Resolves when everything received is shown. */
  settled(): Promise<void> {
    return this.pending;
  }

  /** No more messages of the server will follow. */
  async interrupt(reason: string): Promise<void> {
    await this.pending;
    for (const scenario of this.scenarios.values()) {
      this.showWaiting(scenario);
      this.takeBack(scenario);
    }
    for (const line of this.report.interrupt(reason)) {
      this.sink.output(line);
    }
    this.sink.end();
  }

  private async begin(model: string, message: ScenarioStarted, instant: number): Promise<void> {
    const { variant: iri, variation } = message;
    const execution = message.execution ?? undefined;
    // An execution is in the run model; a variant may be in one that it imports.
    const uri = execution === undefined ? (message.source?.uri ?? model) : model;
    const source = { variant: iri, execution };
    if (this.tree.source(uri, source) === undefined) {
      await this.tree.load(uri);
    }
    const variant = this.tree.source(uri, source);
    if (variant !== undefined) {
      const item = this.tree.scenario(variant, variation, message.values);
      this.scenarios.set(message.index, { item, values: message.values, failing: new Set(), failed: false, held: new Set(), finished: false, waiting: [], since: instant });
    }
  }

  private start(message: ClauseStarted, instant: number): void {
    const scenario = this.scenarios.get(message.index);
    const item = scenario && this.clause(scenario, message);
    if (scenario !== undefined && item !== undefined) {
      scenario.since = instant;
      // A repetition does not replace the verdict of the one before.
      if (!this.worst.has(item)) {
        this.sink.started(item);
      }
    }
  }

  private judge(message: ClauseJudged, instant: number): void {
    const scenario = this.scenarios.get(message.index);
    const item = scenario && this.clause(scenario, message);
    if (scenario === undefined || item === undefined || message.cancelled) {
      return;
    }
    if (message.verdict === "holds") {
      scenario.held.add(item);
    }
    const { because } = message;
    const judged = folded(outcomeOf(message, scenario.values), because, because !== null && scenario.failing.has(because.position));
    if (judged.failure !== undefined) {
      scenario.failing.add(message.position);
    }
    const outcome = this.worst.add(item, judged, message.robustness);
    this.tree.note(item, outcome.note);
    const duration = instant - scenario.since;
    const show = (failed: boolean) => {
      showOutcome(this.sink, item, failed ? inFailed(outcome) : outcome, message.source, duration);
    };
    scenario.failed ||= judged.state === "failed";
    if (outcome.state === "errored") {
      scenario.waiting.push(show);
    } else {
      show(false);
    }
    scenario.since = instant;
  }

  private showWaiting(scenario: Begun<I> | undefined): void {
    for (const show of scenario?.waiting.splice(0) ?? []) {
      show(scenario?.failed === true);
    }
  }

  private finish(scenario: Begun<I> | undefined): void {
    this.showWaiting(scenario);
    if (scenario !== undefined) {
      scenario.finished = true;
      scenario.held.forEach((item) => this.proven.add(item));
    }
  }

  /** A scenario that the run left open has not passed, but the editor would say so of one with only clauses that hold. */
  private takeBack({ finished, failing, held }: Begun<I>): void {
    if (!finished && failing.size === 0) {
      for (const item of held) {
        if (!this.proven.has(item)) {
          this.sink.skipped(item);
        }
      }
    }
  }

  private clause(scenario: Begun<I>, { position, clause, name, sentence, role, source }: ClauseStarted | ClauseJudged): I {
    const listed: ListedTest = { kind: "clause", id: clause, name, detail: sentence, role, place: source, tests: [] };
    return this.tree.clause(scenario.item, position, listed);
  }
}

export function showOutcome<I>(
  sink: Sink<I>,
  item: I,
  { state, failure }: Outcome,
  place: Place | null,
  duration: number | undefined,
): void {
  if (state === "skipped") {
    sink.skipped(item);
  } else if (failure === undefined) {
    sink.passed(item, duration);
  } else if (state === "failed") {
    sink.failed(item, failure, place, duration);
  } else {
    sink.errored(item, failure, place, duration);
  }
}
