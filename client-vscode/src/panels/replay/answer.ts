// The server's answer to `robbdd/trace`: a recorded execution. Metres, seconds, world frame; docs/schemas/trace.schema.json.
import type * as answers from "../../answers/trace";
import type { Immutable } from "../../immutable";

export { isTrace } from "../../answers/validators.mjs";

export type Trace = Immutable<answers.Trace>;
export type Scenario = Trace["scenario"];
export type Shape = Trace["shapes"][number];
export type Triple = Shape["position"];
/** A unit quaternion: w, x, y, z. */
export type Turn = Shape["orientation"];
export type Body = Trace["bodies"][number];
export type Workspace = Trace["workspaces"][number];
/** Contact force between two elements; the trace has neither its point nor its direction. */
export type ContactForce = NonNullable<Trace["forces"]>[number];
export type RunEvent = Trace["events"][number];
export type Clause = Trace["clauses"][number];
export type Verdict = Clause["verdict"];
export type Part = Clause["parts"][number];
/** Numbers in base64, little-endian, the last index fastest. */
export type PackedArray = Trace["frames"]["times"];

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
