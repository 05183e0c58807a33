// The server's messages about a run, as sent in the notification `robbdd/runMessage`.
import type { Place } from "../testing/listing";
import { isRecord } from "../values";

export interface RunStarted {
  readonly type: "RunStarted";
  readonly total: number;
  readonly simulator: string;
}

export interface ScenarioStarted {
  readonly type: "ScenarioStarted";
  /** Number of the scenario, from 0. */
  readonly index: number;
  /** The scenario's name in its feature. */
  readonly name: string;
  /** The values of its variables, as text. */
  readonly values: string;
  /** IRI of the scenario's variant. */
  readonly variant?: string;
  /** Number of the scenario in its variant, from 1. */
  readonly variation?: number;
  /** IRI of the execution that runs it, if any. */
  readonly execution?: string | null;
  /** The name of the variant in the text. */
  readonly source?: Place | null;
}

/** Data on a clause in addition to its scenario and its line. */
export interface ClauseWords {
  /** IRI of the clause. */
  readonly clause?: string;
  /** Number of the clause in its scenario, from 0. */
  readonly position?: number;
  readonly name?: string;
  readonly role?: string;
  readonly source?: Place | null;
}

export interface ClauseStarted extends ClauseWords {
  readonly type: "ClauseStarted";
  readonly index: number;
  /** Line of the clause in the feature file. */
  readonly line: number;
  /** The sentence of the clause, with its values. */
  readonly sentence?: string;
}

/** The cause of an unknown clause: another clause. */
export interface Because {
  /** Its IRI, if known. */
  readonly clause: string | null;
  /** Its number in its scenario, from 0, if known. */
  readonly position: number | null;
  /** Text that takes the place of the reason. */
  readonly words: string;
}

export interface ClauseJudged extends ClauseWords {
  readonly type: "ClauseJudged";
  readonly index: number;
  readonly line: number;
  /** The sentence of the clause, with its values. */
  readonly sentence: string;
  readonly verdict: "holds" | "violated" | "unknown";
  /** Signed margin in `unit`, positive when the clause holds. */
  readonly robustness: number | null;
  readonly unit: string;
  /** Simulated time of the deciding instant, s. */
  readonly at: number | null;
  readonly reason: string;
  /** Why the clause is violated or unknown, the reason first; empty if it holds. */
  readonly failure: string;
  /** The clause of the same scenario that is the cause of this unknown one, if it has no reason of its own. */
  readonly because?: Because | null;
  /** Why the clause could not have been violated; empty if it could. */
  readonly vacuous?: string;
  /** The id of the error in users' code that makes it unknown; empty if there is none. */
  readonly fault?: string;
  /** The run was cancelled before the clause was judged; this is not a result. */
  readonly cancelled?: boolean;
}

export interface MarginRanges {
  readonly type: "MarginRanges";
  readonly index: number;
  readonly line: number;
}

export interface ScenarioFinished {
  readonly type: "ScenarioFinished";
  readonly index: number;
  /** Seconds of simulated time. */
  readonly simulated: number;
  /** Seconds of wall time. */
  readonly wall: number;
  /** Seconds of wall time spent in the physics engine. */
  readonly stepping: number;
}

/** Users' code failed, and the scenario (null: every scenario) has no result because of it. */
export interface UserCodeFailed {
  readonly type: "UserCodeFailed";
  readonly index: number | null;
  /** Equal for the same error in several scenarios. */
  readonly id: string;
  /** The failure and the traceback. */
  readonly lines: readonly string[];
}

/** Lines printed by users' code. */
export interface Output {
  readonly type: "Output";
  readonly index: number | null;
  readonly text: string;
}

/** The process of the run waits for a debugger at a port of this machine. */
export interface DebuggerAwaited {
  readonly type: "DebuggerAwaited";
  readonly port: number;
}

export interface LogLine {
  readonly type: "LogLine";
  readonly level: string;
  readonly text: string;
}

export interface RunFinished {
  readonly type: "RunFinished";
  readonly ok: boolean;
}

export type RunMessage =
  | RunStarted
  | ScenarioStarted
  | ClauseStarted
  | ClauseJudged
  | MarginRanges
  | ScenarioFinished
  | UserCodeFailed
  | Output
  | DebuggerAwaited
  | LogLine
  | RunFinished;

export interface RunNotification {
  /** Identifies the run. */
  readonly run?: string;
  readonly uri: string;
  readonly message: RunMessage;
}

type Check = (value: unknown) => boolean;

const isNumber: Check = (value) => typeof value === "number";
const isText: Check = (value) => typeof value === "string";
const isNumberOrNull: Check = (value) => value === null || typeof value === "number";
const isVerdict: Check = (value) => value === "holds" || value === "violated" || value === "unknown";

const FIELDS: Record<RunMessage["type"], Record<string, Check>> = {
  RunStarted: { total: isNumber, simulator: isText },
  ScenarioStarted: { index: isNumber, name: isText, values: isText },
  ClauseStarted: { index: isNumber, line: isNumber },
  ClauseJudged: {
    index: isNumber,
    line: isNumber,
    sentence: isText,
    verdict: isVerdict,
    robustness: isNumberOrNull,
    unit: isText,
    at: isNumberOrNull,
    reason: isText,
  },
  MarginRanges: { index: isNumber, line: isNumber },
  ScenarioFinished: { index: isNumber, simulated: isNumber, wall: isNumber, stepping: isNumber },
  UserCodeFailed: { index: isNumberOrNull, id: isText, lines: (value) => Array.isArray(value) && value.every(isText) },
  Output: { index: isNumberOrNull, text: isText },
  DebuggerAwaited: { port: isNumber },
  LogLine: { level: isText, text: isText },
  RunFinished: { ok: (value) => typeof value === "boolean" },
};

/** Whether a notification is understood by this version of the extension. */
export function isRunNotification(value: unknown): value is RunNotification {
  return isRecord(value) && isText(value["uri"]) && isRunMessage(value["message"]);
}

function isRunMessage(value: unknown): value is RunMessage {
  if (!isRecord(value) || typeof value["type"] !== "string" || !Object.hasOwn(FIELDS, value["type"])) {
    return false;
  }
  const fields = FIELDS[value["type"] as RunMessage["type"]];
  return Object.entries(fields).every(([name, check]) => check(value[name]));
}
