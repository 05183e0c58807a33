// The page with the history of a clause: its smallest margin and its verdicts in each stored run, the newest run first.
import "./history.css";
import { type ClauseHistory, type ClauseRun, marginOf, rateOf, remarkOf, summaryOf, verdictOf } from "../../src/panels/history/answer";
import { sign } from "../../src/panels/comparison/answer";
import type { FromHistory, HistoryState, ToHistory } from "../../src/panels/history/messages";
import { button, drawn, element } from "../shared/elements";
import { connect } from "../shared/host";
import { stacked } from "../shared/tables";
import { toolbar } from "../shared/toolbar";

const WIDTH = 600;
const HEIGHT = 120;
const EDGE = 14;
const RADIUS = 5;

const host = connect<FromHistory, HistoryState>((message) => {
  receive(message as ToHistory);
});
const title = element("h1");
const chart = element("div", { class: "chart" });
const table = element("div");
const compare = button("Compare the two selected runs", "Show which executions flipped between the two selected runs", () => {
  const [before, after] = selected();
  if (before !== undefined && after !== undefined) {
    host.post({ type: "compare", before, after });
  }
});

document.body.append(
  element("header", {}, toolbar("History", compare)),
  element("main", {}, title, chart, table),
);

function receive({ choice, history }: ToHistory): void {
  const before = new Set(selected());
  host.keep({ choice });
  title.textContent = `${history.name || "A clause that the text no longer has"}: ${summaryOf(history)}`;
  chart.replaceChildren(...plot(history));
  const newest = [...history.runs].reverse();
  table.replaceChildren(runs(newest, (run, place) => (before.size === 2 ? before.has(run) : place < 2)));
  enable();
}

/** The numbers of the selected runs, the older one first. */
function selected(): number[] {
  const boxes = [...table.querySelectorAll<HTMLInputElement>("input:checked")];
  return boxes.map(({ value }) => Number(value)).sort((one, other) => one - other);
}

function enable(): void {
  compare.disabled = selected().length !== 2;
}

function runs(newest: readonly ClauseRun[], isSelected: (run: number, place: number) => boolean): HTMLElement {
  const heads = ["", "Run", "Began", "Holds", "Smallest margin", "", ""];
  const rows = newest.map((run, place) => {
    const box = element("input", { type: "checkbox", value: run.run, "aria-label": `Select run ${run.run} to compare` });
    box.checked = isSelected(run.run, place);
    box.addEventListener("change", enable);
    const worst = button("Replay worst", `Replay the worst execution of run ${run.run}`, () => {
      replay(run);
    });
    const verdict = verdictOf(run);
    const rate = element("td", { class: `verdict ${verdict}` }, `${sign(verdict)} ${rateOf(run)}`);
    const cells = [`${run.run}`, began(run)].map((text) => element("td", {}, text));
    const margin = element("td", { class: "number" }, marginOf(run));
    return element("tr", { class: run.stale === true ? "stale" : "" }, element("td", {}, box), ...cells, rate, margin, element("td", {}, worst), element("td", { class: "remark" }, remarkOf(run)));
  });
  return stacked(heads, rows);
}

/** The smallest margin of each run, the oldest first; nothing if the clause has no margins. */
function plot({ name, runs: every }: ClauseHistory): Element[] {
  const measured = every.filter(({ margin, unit }) => margin !== null && unit !== "");
  if (measured.length < 2) {
    return [];
  }
  const margins = measured.map(({ margin }) => margin ?? 0);
  const [low, high] = [Math.min(0, ...margins), Math.max(0, ...margins)];
  const x = (place: number) => EDGE + (place / (measured.length - 1)) * (WIDTH - 2 * EDGE);
  const y = (value: number) => HEIGHT - EDGE - ((value - low) / (high - low || 1)) * (HEIGHT - 2 * EDGE);
  const picture = drawn("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "group", "aria-label": `Smallest margin of ${name} in each run` });
  const path = margins.map((margin, place) => `${x(place)},${y(margin)}`).join(" ");
  picture.append(drawn("line", { class: "zero", x1: 0, x2: WIDTH, y1: y(0), y2: y(0) }), drawn("polyline", { points: path }));
  for (const [place, run] of measured.entries()) {
    const words = `Run ${run.run}: ${marginOf(run)}, ${rateOf(run)} hold. Replay the worst.`;
    const point = drawn(
      "circle",
      { class: `${verdictOf(run)}${run.stale === true ? " stale" : ""}`, cx: x(place), cy: y(run.margin ?? 0), r: RADIUS, tabindex: 0, role: "button", "aria-label": words },
      drawn("title", {}, words),
    );
    point.addEventListener("click", () => {
      replay(run);
    });
    point.addEventListener("keydown", ({ key }) => {
      if (key === "Enter" || key === " ") {
        replay(run);
      }
    });
    picture.append(point);
  }
  const caption = element("p", { class: "caption" }, "Smallest margin per run; below the dashed line, the clause is violated.");
  return [picture, caption];
}

function began(run: ClauseRun): string {
  const date = new Date(run.began);
  return Number.isNaN(date.getTime()) ? "" : date.toLocaleString();
}

function replay({ run, worst }: ClauseRun): void {
  host.post({ type: "replay", run, index: worst });
}
