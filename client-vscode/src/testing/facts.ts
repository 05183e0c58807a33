// Data of a listed test, and its item's label, description and order.
import { withoutIcons } from "../literal";
import type { Facts, Source } from "./items";
import type { ListedTest, Place } from "./listing";

/** Variants up to this number of scenarios are listed at once, so that rows and clauses have icons. */
export const EAGER = 100;

/** Number of scenarios listed at first in larger variants, and in each further step. */
export const PAGE = 200;

export function described(note: string, detail: string): string {
  return [note, detail].filter((part) => part !== "").join(" · ");
}

export function factsOf(uri: string, owner: Facts | undefined, listed: ListedTest): Facts {
  const common = { kind: listed.kind, uri, place: listed.place, detail: listed.detail };
  switch (listed.kind) {
    case "file":
      return common;
    case "story":
      return { ...common, detail: described(decodeURIComponent(uri.split("/").at(-1) ?? ""), listed.detail) };
    case "variant":
    case "execution": {
      const count = listed.count ?? undefined;
      const small = count !== undefined && count <= EAGER;
      const variation: Place | null = listed.variation ?? null;
      return { ...common, ...sourceOf(listed), count, small, variation, digest: listed.digest };
    }
    case "scenario":
      return { ...common, ...ownedBy(owner), number: listed.number ?? Number(listed.id) };
    case "clause":
      return { ...common, ...ownedBy(owner), number: owner?.number ?? 0, clause: listed.id };
  }
}

function sourceOf(listed: ListedTest): Source {
  return listed.kind === "execution" ? { variant: listed.variant ?? "", execution: listed.id } : { variant: listed.id };
}

function ownedBy(owner: Facts | undefined): Source {
  return { variant: owner?.variant ?? "", execution: owner?.execution };
}

/** Whether the facts are about a variant, or an execution of one. */
export function makesScenarios({ kind }: Facts): boolean {
  return kind === "variant" || kind === "execution";
}

export function sameSource(one: Partial<Source>, other: Source): boolean {
  return one.variant === other.variant && one.execution === other.execution;
}

/** Whether an item's results are outdated: its text, or that of the declarations it stands for, has changed. */
export function hasChanged(before: Facts, now: Facts): boolean {
  return makesScenarios(now) ? before.digest !== now.digest : before.clause !== now.clause;
}

export function itemId(uri: string, listed: ListedTest, position?: number): string {
  if (listed.kind === "clause") {
    return String(position);
  }
  return listed.kind === "story" ? `${uri} ${listed.id}` : listed.id;
}

export function labelOf(listed: ListedTest): string {
  const role = listed.role ?? "";
  return withoutIcons(role === "" ? listed.name : `${role.charAt(0).toUpperCase()}${role.slice(1)} ${listed.name}`);
}

/** Sort key in text order: declarations by place, others by number; files last. */
export function sortOf(listed: ListedTest, position?: number): string {
  if (listed.kind === "file") {
    // The editor compares like a dictionary: letters sort after numbers, signs before them.
    return `z${listed.name}`;
  }
  const number = position ?? listed.number ?? listed.place?.range.start.line ?? 0;
  return String(number).padStart(9, "0");
}

/** The text of the item after the first scenarios, whose expansion lists more. */
export function moreWords(listed: number, count: number | undefined): { readonly label: string; readonly description: string } {
  const last = Math.min(2 * listed, count ?? Infinity);
  return {
    label: `More: ${(listed + 1).toLocaleString("en")} to ${last.toLocaleString("en")}`,
    description: count === undefined ? "expand to list them" : `of ${count.toLocaleString("en")} scenarios: expand to list them`,
  };
}
