// The server's answer to `robbdd/trace`: a recorded execution. Metres, seconds, world frame; docs/schemas/trace.schema.json.
import type { Location } from "../../places";
import { isRecord } from "../../values";

export type Verdict = "holds" | "violated" | "unknown";
export type Triple = readonly [number, number, number];
/** A unit quaternion: w, x, y, z. */
export type Turn = readonly [number, number, number, number];

/** Numbers in base64, little-endian, the last index fastest. */
export interface PackedArray {
  readonly type: "float32" | "uint32";
  readonly shape: readonly number[];
  readonly data: string;
}

export interface Shape {
  readonly body: number;
  readonly kind: "box" | "sphere" | "cylinder" | "capsule" | "ellipsoid" | "plane" | "mesh";
  readonly size: Triple;
  readonly position: Triple;
  readonly orientation: Turn;
  readonly color: readonly [number, number, number, number];
  readonly mesh?: number;
}

export interface Body {
  readonly name: string;
  readonly position: Triple;
  readonly orientation: Turn;
}

export interface Workspace {
  readonly name: string;
  readonly body: number | null;
  readonly center: Triple;
  readonly half: Triple;
}

/** Contact force between two elements; the trace has neither its point nor its direction. */
export interface ContactForce {
  /** CURIEs, an agent first. */
  readonly between: readonly string[];
  /** Their bodies; null without one. */
  readonly bodies: readonly [number | null, number | null];
  /** The largest force since the previous frame, N. */
  readonly peaks: PackedArray;
}

export interface Part {
  readonly start: number | null;
  readonly end: number | null;
  readonly reason: string;
  readonly unit: string;
  readonly negated: boolean;
  readonly times: readonly number[];
  readonly margins: readonly number[];
}

export interface Clause {
  readonly iri: string;
  readonly name: string;
  readonly role: "given" | "when" | "then";
  readonly sentence: string;
  readonly verdict: Verdict;
  readonly robustness: number | null;
  readonly unit: string;
  readonly at: number | null;
  readonly reason: string;
  readonly vacuous: string;
  readonly source: Location | null;
  /** Whether the model has changed here since; null (or undefined, from older servers) if unknown. */
  readonly stale?: boolean | null;
  readonly parts: readonly Part[];
  /** Index of the part that decides the clause. */
  readonly operand?: number | null;
}

export interface Scenario {
  readonly index: number;
  readonly name: string;
  readonly values: string;
  readonly variant: string;
  readonly variation: number;
  readonly repetition: number;
  readonly seed?: number;
  readonly verdict: Verdict;
}

export interface RunEvent {
  readonly name: string;
  readonly time: number;
}

export interface Trace {
  readonly run: number;
  readonly folder: string;
  readonly scenario: Scenario;
  readonly duration: number;
  readonly remark: string;
  readonly shapes: readonly Shape[];
  readonly meshes: readonly { readonly vertices: PackedArray; readonly faces: PackedArray }[];
  readonly bodies: readonly Body[];
  readonly frames: { readonly times: PackedArray; readonly bodies: readonly number[]; readonly poses: PackedArray };
  readonly workspaces: readonly Workspace[];
  /** The bodies with the frames of the agents' tools; undefined from older servers. */
  readonly tools?: readonly { readonly agent: string; readonly body: number }[];
  /** null: none are recorded. */
  readonly forces?: readonly ContactForce[] | null;
  readonly events: readonly RunEvent[];
  readonly clauses: readonly Clause[];
}

const LISTS = ["shapes", "meshes", "bodies", "workspaces", "events", "clauses"];

/** Whether an answer has the form of this version: its parts, but not every number. */
export function isTrace(value: unknown): value is Trace {
  return (
    isRecord(value) &&
    typeof value["run"] === "number" &&
    typeof value["duration"] === "number" &&
    isRecord(value["scenario"]) &&
    isRecord(value["frames"]) &&
    isArray(value["frames"]["times"]) &&
    isArray(value["frames"]["poses"]) &&
    LISTS.every((name) => Array.isArray(value[name])) &&
    (value["clauses"] as unknown[]).every((clause) => isRecord(clause) && Array.isArray(clause["parts"]))
  );
}

/** The local part of a name, after its prefix. */
export function local(name: string): string {
  return name.replace(/^[^:]*:/, "");
}

/** The name of a scenario without prefix: "crit:bin-heights -- 12" is "bin-heights 12". */
export function titleOf({ name }: Pick<Scenario, "name">): string {
  return local(name).replace(/ -- (?=\d+$)/, " ");
}

/** Remark on changes of the model's text since a trace was recorded; empty if there are none. */
export function ageOf(clauses: readonly Clause[]): string {
  const changed = clauses.filter(({ stale }) => stale === true).map(({ name }) => name);
  if (changed.length > 0) {
    return `The model has been edited since: ${[...new Set(changed)].join(", ")} ${changed.length === 1 ? "has" : "have"} changed. Run again to judge the current text.`;
  }
  return clauses.some(({ stale }) => stale === null) ? "The model has errors now: its clauses may have changed." : "";
}

/** The clause to show first: the requested one, else the first violated one, else the last. */
export function firstClause(clauses: readonly Clause[], wanted?: string): number {
  const asked = clauses.findIndex(({ iri, name }) => wanted !== undefined && (iri === wanted || name === wanted));
  const violated = clauses.findIndex(({ verdict, at }) => verdict === "violated" && at !== null);
  return [asked, violated].find((index) => index >= 0) ?? clauses.length - 1;
}

function isArray(value: unknown): boolean {
  return isRecord(value) && Array.isArray(value["shape"]) && typeof value["data"] === "string";
}
