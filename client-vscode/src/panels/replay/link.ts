// Links to a moment of a recorded execution. They are pasted by others, so nothing in them is trusted: a link can only show
// an execution that is stored in an open folder, and names it by what it is, not by its number alone.
import type { Scenario, Trace } from "./answer";

const PATH = "/replay";
const LONGEST = 4000;

export interface Moment {
  /** Path of a model from the top of its workspace folder. */
  readonly model: string;
  readonly run: number;
  readonly index: number;
  /** s */
  readonly time: number;
  /** The selected clause by its name. */
  readonly clause: string;
  /** The execution: IRI of its variant, number of the variation, repetition, and seed. */
  readonly variant: string;
  readonly variation: number;
  readonly repetition: number;
  readonly seed: number;
}

const TEXTS = ["model", "clause", "variant"] as const;
const COUNTS = ["run", "index", "variation", "repetition", "seed"] as const;

/** The moment of a trace; undefined if its run is not stored. */
export function momentOf({ run, scenario, clauses, duration }: Trace, model: string, time: number, clause: number): Moment | undefined {
  const { index, variant, variation, repetition, seed } = scenario;
  if (run <= 0) {
    return undefined;
  }
  const moment = Math.round(Math.min(duration, Math.max(0, time)) * 1000) / 1000;
  return { model, run, index, time: moment, clause: clauses[clause]?.name ?? "", variant, variation, repetition, seed };
}

/** Write a link that the editor of this scheme opens with the extension. */
export function linkTo(moment: Moment, scheme: string, extension: string): string {
  const query = Object.entries(moment).map(([name, value]) => `${name}=${encodeURIComponent(guarded(String(value)))}`);
  return `${scheme}://${extension}${PATH}?${query.join("&")}`;
}

/** The moment that a link names, of whatever editor; undefined for any other text. */
export function momentIn(link: string): Moment | undefined {
  const [, path, query] = /^[\w+.-]+:\/\/[\w.-]+(\/\w*)\?(.*)$/.exec(link.trim().slice(0, LONGEST)) ?? [];
  if (path !== PATH || query === undefined) {
    return undefined;
  }
  const given = new URLSearchParams(query);
  const texts = TEXTS.map((name) => [name, bare(given.get(name))] as const);
  const counts = COUNTS.map((name) => [name, wholeNumber(given.get(name))] as const);
  const time = Number(given.get("time") ?? Number.NaN);
  if ([...texts, ...counts].some(([, value]) => value === null) || !(time >= 0 && time < 1e9)) {
    return undefined;
  }
  const moment = { ...Object.fromEntries([...texts, ...counts]), time } as unknown as Moment;
  return isInside(moment.model) ? moment : undefined;
}

/** Editors decode an address before the extension gets it, once or not at all: what separates its parts is escaped anew. */
function guarded(text: string): string {
  return text.replace(/[~&%#+=?;]/g, (sign) => `~${sign.charCodeAt(0).toString(16)}`);
}

function bare(text: string | null): string | null {
  return text?.replace(/~([0-9a-f]{2})/g, (_, code: string) => String.fromCharCode(Number.parseInt(code, 16))) ?? null;
}

/** Whether a scenario is the execution of a moment, whatever the number of its run. */
export function isExecution({ variant, variation, repetition, seed }: Scenario, moment: Moment): boolean {
  return variant === moment.variant && variation === moment.variation && repetition === moment.repetition && seed === moment.seed;
}

/** Whether a path leads to a model below the folder that it is looked for in. */
function isInside(path: string): boolean {
  const parts = path.split("/");
  return /\.bddx?$/.test(path) && !/[\\:\0]/.test(path) && parts.every((part) => part !== "" && part !== "." && part !== "..");
}

function wholeNumber(text: string | null): number | null {
  return text !== null && /^\d{1,15}$/.test(text) ? Number(text) : null;
}
