// The margin of a clause over time, above zero where it holds.
import type { Clause, Part } from "../../src/panels/replay/answer";
import { signed } from "../../src/quantity";
import { drawn } from "../shared/elements";
import { extent, points } from "./margins";
import { type Scale, scale, ticks } from "./scale";

export interface PlotPlace {
  readonly top: number;
  readonly height: number;
  readonly width: number;
}

/** The fluent that decides a clause; all fluents if none does. */
function deciding({ parts, operand }: Clause): readonly Part[] {
  const part = parts[operand ?? -1];
  return part === undefined ? parts : [part];
}

/** Draw the margin of a clause's deciding fluent; without a margin, show the reason. */
export function marginPlot(clause: Clause | undefined, along: Scale, { top, height, width }: PlotPlace): SVGElement[] {
  const parts = clause === undefined ? [] : deciding(clause).filter(({ times }) => times.length > 0);
  if (clause === undefined || parts.length === 0) {
    const reason = clause?.role === "when" ? "A behaviour has no margin." : "No margin was recorded for this clause.";
    return [drawn("text", { class: "empty", x: along(0), y: top + height / 2 }, clause === undefined ? "" : reason)];
  }
  const [low, high] = extent(parts.flatMap((part) => points(part).map(([, value]) => value)));
  const up = scale(low, high, top + height, top);
  const zero = up(0);
  const values = ticks(low, high, 3);
  const unit = parts[0]?.unit ?? "";
  return [
    drawn("rect", { class: "below", x: 0, y: zero, width, height: top + height - zero }),
    ...parts.flatMap((part) => judged(part, along, top, height)),
    ...values.map((value) => drawn("line", { class: value === 0 ? "zero" : "grid", x1: 0, x2: width, y1: up(value), y2: up(value) })),
    ...parts.map((part) => drawn("path", { class: "margin", d: curve(part, along, up) })),
    ...values.map((value) => drawn("text", { class: "value", x: 2, y: up(value) - 2 }, value === 0 ? "0" : signed(value, unit))),
  ];
}

/** The window of a fluent, on which its verdict depends. */
function judged({ start, end }: Part, along: Scale, top: number, height: number): SVGElement[] {
  if (start === null || end === null) {
    return [];
  }
  const [from, to] = [along(start), along(end)];
  return [drawn("rect", { class: "judged", x: from - 1, y: top, width: Math.max(2, to - from), height })];
}

/** A curve through the points; a single point is drawn as a dash, so that it is visible. */
function curve(part: Part, along: Scale, up: Scale): string {
  const places = points(part).map(([time, value]) => [along(time), up(value)] as const);
  const [first] = places;
  if (places.length === 1 && first !== undefined) {
    return `M${first[0] - 5} ${first[1]}h10`;
  }
  return places.map(([x, y], index) => `${index === 0 ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
}
