// The commands of the server that run scenarios, and their arguments.
import { isRecord } from "./values";

/** Commands of the server that run scenarios. */
export const RUNNING = new Set(["robbdd.run", "robbdd.rerunFailed", "robbdd.record"]);

export interface Named {
  /** The name of a run in its messages. */
  readonly token: string;
}

export function isNamed(value: unknown): value is Named {
  return isRecord(value) && typeof value["token"] === "string";
}

export function hasUri(value: unknown): value is { readonly uri: string } {
  return typeof value === "object" && value !== null && "uri" in value && typeof value.uri === "string";
}
