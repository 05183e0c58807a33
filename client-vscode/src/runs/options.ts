// User-defined options of `robbdd.run`: selection and execution of scenarios.
import { isRunEstimate } from "../answers/validators.mjs";
import { isRecord } from "../values";

export const AMOUNTS = ["first", "sample", "pairwise"] as const;

/**
 * A part of the scenarios: the first, a random sample, or a small set that covers all combinations of 2 or 3 variables.
 */
export interface Amount {
  readonly kind: (typeof AMOUNTS)[number];
  readonly number: number;
}

/** Missing options take the model's values; `jobs` then defaults to the number of cores. */
export interface RunOptions {
  readonly where?: string;
  readonly amount?: Amount;
  readonly repeat?: number;
  readonly seed?: number;
  readonly jobs?: number;
  /** Substitutions of behaviour implementations by catalog behaviours: `my-server=pick-place, …`. */
  readonly bhv?: string;
  /** The path of a `.scenex` for scenarios without an execution, absolute or from the model's folder. */
  readonly scenex?: string;
  /** Whether violations are rendered as pictures. */
  readonly record?: true;
}

export type OptionName = keyof RunOptions;

/** The fields of the server's command. */
export function argumentsOf({ amount, bhv, ...others }: RunOptions): Readonly<Record<string, unknown>> {
  return {
    ...others,
    ...(amount === undefined ? {} : { [amount.kind]: amount.number }),
    ...(bhv === undefined ? {} : { bhv: Object.fromEntries(substitutionsIn(bhv)) }),
  };
}

/** The problem of typed substitutions; undefined for valid or empty ones. */
export function substitutionProblem(text: string): string | undefined {
  const isUsable = substitutionsIn(text).every(([name, behaviour]) => name !== "" && behaviour !== "");
  return isUsable ? undefined : "NAME=BEHAVIOUR, such as my-server=pick-place, separated by commas.";
}

function substitutionsIn(text: string): [name: string, behaviour: string][] {
  const entries = text.split(",").map((entry) => entry.trim()).filter((entry) => entry !== "");
  return entries.map((entry) => {
    const at = entry.lastIndexOf("=");
    return at < 0 ? [entry, ""] : [entry.slice(0, at).trim(), entry.slice(at + 1).trim()];
  });
}

/** The valid part of remembered options, which may be from an older version. */
export function optionsIn(remembered: unknown): RunOptions {
  if (!isRecord(remembered)) {
    return {};
  }
  const { where, amount, repeat, seed, jobs, bhv, scenex, record } = remembered;
  return {
    ...(typeof where === "string" && where !== "" ? { where } : {}),
    ...(isAmount(amount) ? { amount } : {}),
    ...(isCount(repeat) ? { repeat } : {}),
    ...(Number.isSafeInteger(seed) ? { seed: seed as number } : {}),
    ...(isCount(jobs) ? { jobs } : {}),
    ...(typeof bhv === "string" && bhv !== "" && substitutionProblem(bhv) === undefined ? { bhv } : {}),
    ...(typeof scenex === "string" && scenex !== "" ? { scenex } : {}),
    ...(record === true ? { record } : {}),
  };
}

/** Options with one of them replaced, or reset to the model's value. */
export function withOption<Name extends OptionName>(
  options: RunOptions,
  name: Name,
  value: RunOptions[Name] | undefined,
): RunOptions {
  return optionsIn({ ...options, [name]: value });
}

/** An option as text, set or not. */
export function wordsOf(options: RunOptions, name: OptionName): string {
  const { where, amount, repeat, seed, jobs, bhv, scenex, record } = options;
  switch (name) {
    case "where":
      return where ?? "any values";
    case "amount":
      return amount === undefined ? "all scenarios" : amountWords(amount);
    case "repeat":
      return repeat === undefined ? "as in the model, else once" : `${repeat} ${repeat === 1 ? "execution" : "executions"} each`;
    case "seed":
      return seed === undefined ? "as in the model, else 1" : String(seed);
    case "jobs":
      return jobs === undefined ? "the number of cores" : String(jobs);
    case "bhv":
      return bhv ?? "as in the model";
    case "scenex":
      return scenex ?? "as in the model";
    case "record":
      return record === true ? "of each violation" : "none";
  }
}

/** All set options in one line. */
export function summaryOf(options: RunOptions): string {
  const { where, amount, repeat, seed, jobs, bhv, scenex, record } = options;
  const parts = [
    ...(where === undefined ? [] : [`where ${where}`]),
    ...(amount === undefined ? [] : [amountWords(amount)]),
    ...(repeat === undefined ? [] : [wordsOf(options, "repeat")]),
    ...(seed === undefined ? [] : [`seed ${seed}`]),
    ...(jobs === undefined ? [] : [`${jobs} at a time`]),
    ...(bhv === undefined ? [] : [`with ${bhv}`]),
    ...(scenex === undefined ? [] : [`in ${scenex}`]),
    ...(record === undefined ? [] : ["with pictures"]),
  ];
  return parts.length === 0 ? "all as in the model" : parts.join(", ");
}

/** The extent of a run in the server's answer, or the reason why there would be no run. */
export function extentIn(answer: unknown): string | undefined {
  if (!isRunEstimate(answer)) {
    return undefined;
  }
  return "words" in answer ? answer.words : answer.problem;
}

/** The problem of a typed number; undefined for a valid one and for an empty text, which means the model's value. */
export function numberProblem(text: string, least = 1): string | undefined {
  const number = Number(text);
  const isUsable = text.trim() === "" || (Number.isSafeInteger(number) && number >= least);
  return isUsable ? undefined : `A whole number${least === 1 ? " above 0" : ""}, or nothing.`;
}

/** Parse a number that `numberProblem` accepts. */
export function typedNumber(text: string): number | undefined {
  return text.trim() === "" ? undefined : Number(text);
}

function amountWords({ kind, number }: Amount): string {
  switch (kind) {
    case "first":
      return `the first ${number}`;
    case "sample":
      return `a random sample of ${number}`;
    case "pairwise":
      return `all combinations of ${number} variables`;
  }
}

function isCount(value: unknown): value is number {
  return Number.isSafeInteger(value) && (value as number) > 0;
}

function isAmount(value: unknown): value is Amount {
  if (!isRecord(value) || !AMOUNTS.some((kind) => kind === value["kind"]) || !isCount(value["number"])) {
    return false;
  }
  return value["kind"] !== "pairwise" || value["number"] === 2 || value["number"] === 3;
}
