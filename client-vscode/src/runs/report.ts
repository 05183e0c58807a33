// One run as text: messages in, lines for the output channel and a summary out.
import { signed } from "../quantity";
import type { ClauseJudged, RunMessage, UserCodeFailed } from "./messages";

export const SIGNS = { holds: "✔", violated: "✗", unknown: "?" } as const;

type Outcome = "passed" | "failed" | "errored";

/** Number of ended scenarios, by outcome. */
export interface Tally {
  readonly total: number;
  readonly passed: number;
  readonly failed: number;
  /** Scenarios with an unknown clause and no violated one. */
  readonly errored: number;
}

/** Follows one run from its first message to its last. */
export class RunReport {
  private total = 0;
  private ended = false;
  private readonly verdicts = new Map<number, ClauseJudged["verdict"][]>();
  /** Parallel scenarios are reported one after the other, each when it has ended. */
  private readonly reported = new Map<number, string[]>();
  /** The reported errors in users' code, with their numbers. */
  private readonly faults = new Map<string, number>();
  private readonly outcomes = new Map<number, Outcome>();
  /** Number of ended scenarios with each outcome; counting them again with each message would be quadratic. */
  private readonly counts: Record<Outcome, number> = { passed: 0, failed: 0, errored: 0 };

  constructor(private readonly name: string) {}

  /** Whether the run's last message has arrived. */
  get finished(): boolean {
    return this.ended;
  }

  get tally(): Tally {
    return { total: this.total, ...this.counts };
  }

  /** Process a message and return the lines that it adds to the report. */
  add(message: RunMessage): string[] {
    switch (message.type) {
      case "RunStarted":
        this.total = message.total;
        return [`▶ ${this.name}: ${scenarios(message.total)}, ${message.simulator}`];
      case "ScenarioStarted":
        this.verdicts.set(message.index, []);
        this.reported.set(message.index, [
          `  Scenario ${message.index + 1} of ${this.total}: ${message.name}  ${message.values}`.trimEnd(),
        ]);
        return [];
      case "ClauseStarted":
      case "MarginRanges":
        return [];
      case "ClauseJudged":
        this.verdicts.get(message.index)?.push(message.verdict);
        this.reported.get(message.index)?.push(`    ${this.describe(message)}`);
        return [];
      case "ScenarioFinished":
        return [...this.open(message.index), this.finishScenario(message.index, message.simulated, message.wall)];
      case "UserCodeFailed":
        return this.traceback(message);
      case "Output": {
        const lines = message.text.split("\n").map((line) => `    │ ${line}`);
        const waiting = message.index === null ? undefined : this.reported.get(message.index);
        waiting?.push(...lines);
        return waiting === undefined ? lines : [];
      }
      case "DebuggerAwaited":
        return [`    waiting for a debugger at port ${message.port}`];
      case "LogLine":
        return message.text.split(/\r?\n/).map((line) => `    ${message.level}: ${line}`);
      case "RunFinished":
        this.ended = true;
        return [...this.openAll(), message.ok ? `■ ${this.summary()}` : `■ The run ended early. ${this.summary()}`, ""];
    }
  }

  /** End a run whose server is gone; adds nothing to an ended run. */
  interrupt(reason: string): string[] {
    if (this.ended) {
      return [];
    }
    this.ended = true;
    return [...this.openAll(), `■ ${reason} ${this.summary()}`, ""];
  }

  /** One line for the status item. */
  summary(): string {
    const { total, passed, failed, errored } = this.tally;
    const open = total - passed - failed - errored;
    const parts = [`${passed} of ${scenarios(total)} passed`];
    if (failed > 0) {
      parts.push(`${failed} failed`);
    }
    if (errored > 0) {
      parts.push(`${errored} errored`);
    }
    if (open > 0) {
      parts.push(`${open} not finished`);
    }
    return `${this.name}: ${parts.join(", ")}.`;
  }

  /** An error is reported once, even if several scenarios have no result because of it. */
  private traceback({ id, lines: [failed = "", ...calls] }: UserCodeFailed): string[] {
    if (this.faults.has(id)) {
      return [];
    }
    const number = this.faults.size + 1;
    this.faults.set(id, number);
    return [`    error ${number}: ${failed}`, ...calls.map((line) => `    ${line}`)];
  }

  private describe(clause: ClauseJudged): string {
    const error = this.faults.get(clause.fault ?? "");
    return error === undefined && clause.because
      ? `${SIGNS[clause.verdict]} ${clause.sentence}: ${clause.because.words}`
      : describeClause(clause, error);
  }

  /** The lines of a scenario not yet reported. */
  private open(index: number): string[] {
    const lines = this.reported.get(index) ?? [];
    this.reported.delete(index);
    return lines;
  }

  private openAll(): string[] {
    return [...this.reported.keys()].flatMap((index) => this.open(index));
  }

  private finishScenario(index: number, simulated: number, wall: number): string {
    const outcome = decide(this.verdicts.get(index) ?? []);
    const before = this.outcomes.get(index);
    if (before !== undefined) {
      this.counts[before] -= 1;
    }
    this.counts[outcome] += 1;
    this.outcomes.set(index, outcome);
    return `    ${outcome} after ${seconds(simulated)} simulated, ${seconds(wall)} on the clock`;
  }
}

/** A scenario passes if every clause holds; without any clause there is no evidence. */
function decide(verdicts: readonly ClauseJudged["verdict"][]): Outcome {
  if (verdicts.includes("violated")) {
    return "failed";
  }
  return verdicts.length === 0 || verdicts.includes("unknown") ? "errored" : "passed";
}

function describeClause(clause: ClauseJudged, error?: number): string {
  const instant = clause.at === null ? "" : ` at ${seconds(clause.at)}`;
  const because = error === undefined ? clause.reason : `no evidence, because of error ${error}`;
  const reason = because === "" ? "" : `: ${because}`;
  return `${SIGNS[clause.verdict]} ${clause.sentence}: ${clause.verdict}${margin(clause)}${instant}${reason}`;
}

function margin(clause: ClauseJudged): string {
  const shown = marginOf(clause);
  return shown === "" ? "" : ` by ${shown}`;
}

/** The margin in a readable unit; empty without a unit, as it then only repeats the verdict. */
export function marginOf({ robustness, unit }: Pick<ClauseJudged, "robustness" | "unit">): string {
  return robustness === null || unit === "" ? "" : signed(robustness, unit);
}

export function seconds(value: number): string {
  return `${value.toFixed(2)} s`;
}

function scenarios(count: number): string {
  return count === 1 ? "1 scenario" : `${count} scenarios`;
}
