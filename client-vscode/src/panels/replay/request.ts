// Parse references to a recording from links, lenses and the page's state; they are untrusted.
import { isRecord } from "../../values";
import type { Recording } from "./messages";

const NUMBERS = ["index", "variation", "repetition", "number"] as const;

/** The recording named by a value; undefined if it names none. */
export function recordingOf(value: unknown): Recording | undefined {
  if (!isRecord(value) || typeof value["uri"] !== "string") {
    return undefined;
  }
  const { uri, run, variant, execution } = value;
  const numbers = NUMBERS.filter((name) => typeof value[name] === "number").map((name) => [name, value[name]]);
  return {
    uri,
    ...(typeof run === "number" || typeof run === "string" ? { run } : {}),
    ...(typeof variant === "string" ? { variant } : {}),
    ...(typeof execution === "string" ? { execution } : {}),
    ...(Object.fromEntries(numbers) as Partial<Record<(typeof NUMBERS)[number], number>>),
  };
}

/** The clause that a value selects, by its IRI or its name. */
export function clauseOf(value: unknown): string | undefined {
  return isRecord(value) && typeof value["clause"] === "string" ? value["clause"] : undefined;
}
