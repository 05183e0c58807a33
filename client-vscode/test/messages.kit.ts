// Whole messages of a run, of which a test names only what matters.
import type { RunMessage } from "../src/runs/messages";

type Type = RunMessage["type"];
type Message<T extends Type> = Extract<RunMessage, { readonly type: T }>;

const CLAUSE = { index: 0, line: 7, clause: "t:held", position: 0, name: "held", role: "then", sentence: "cube is held", source: null } as const;
const FAULT = { exception: "KeyError", message: "'goal'", code: "carrying:Carry", origin: "", frames: [] };

const USUAL: { readonly [T in Type]: Message<T> } = {
  RunStarted: { type: "RunStarted", total: 1, simulator: "mujoco 4.0.0" },
  ScenarioStarted: {
    type: "ScenarioStarted", index: 0, name: "t:fetch -- 1", values: "part = cube", variant: "t:fetch", variation: 1, source: null, row: null,
  },
  ClauseStarted: { type: "ClauseStarted", ...CLAUSE },
  ClauseJudged: {
    type: "ClauseJudged", ...CLAUSE, verdict: "holds", robustness: null, unit: "", at: null, reason: "", failure: "", because: null,
    cancelled: false,
  },
  MarginRanges: { type: "MarginRanges", index: 0, line: 7, ranges: [] },
  ScenarioFinished: { type: "ScenarioFinished", index: 0, verdict: "holds", simulated: 9, wall: 0.51, stepping: 0.3 },
  UserCodeFailed: { type: "UserCodeFailed", index: 0, id: "e1", lines: [], fault: FAULT },
  Output: { type: "Output", index: null, text: "" },
  DebuggerAwaited: { type: "DebuggerAwaited", port: 5678 },
  LogLine: { type: "LogLine", level: "info", text: "" },
  RunFinished: { type: "RunFinished", ok: true },
};

/** A message of a type with these fields; the others are usual. */
export function message<T extends Type>(type: T, fields: Partial<Message<T>> = {}): Message<T> {
  return { ...USUAL[type], ...fields };
}
