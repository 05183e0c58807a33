// The part of the study page with the matrix: its filters, and how many executions they leave.
import type { JudgedClause, JudgedScenario } from "../../src/panels/study/results";
import { element } from "../shared/elements";
import { Grid, type Open } from "./grid";
import { type Verdict, type Wish, ROWS, rowsOf } from "./matrix";
import { local } from "./tables";

/** Milliseconds after the last letter until a filter is applied. */
const PAUSE = 120;
const VERDICTS = { "": "all verdicts", violated: "violated", unknown: "unknown", holds: "holds" } as const;

export class MatrixPart {
  private readonly text = element("input", { type: "search", placeholder: "Filter by values", "aria-label": "Filter by values" });
  private readonly verdict = element("select", { "aria-label": "Executions with verdict" });
  private readonly failing = element("input", { type: "checkbox" });
  private readonly count = element("span", { class: "count" });
  private readonly title = element("h1");
  private readonly place = element("div", { class: "place" });
  readonly choices = element("span", { class: "choices" }, this.text, this.verdict, element("label", {}, this.failing, " only clauses that fail"));
  readonly root = element("main", { class: "whole" }, element("div", { class: "top" }, this.title, this.count), this.place);
  private grid: Grid | undefined;
  private wish: Wish = { text: "", verdict: "", failing: false, by: ROWS, descending: false };
  private timer: ReturnType<typeof setTimeout> | undefined;
  private total = 0;

  constructor(
    private readonly replay: Open,
    private readonly say: (words: string) => void,
  ) {
    this.verdict.append(...Object.entries(VERDICTS).map(([value, words]) => element("option", { value }, words)));
    this.text.addEventListener("input", () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => {
        this.arrange({ ...this.wish, text: this.text.value });
      }, PAUSE);
    });
    this.verdict.addEventListener("change", () => {
      this.arrange({ ...this.wish, verdict: this.verdict.value as Verdict | "" });
    });
    this.failing.addEventListener("change", () => {
      this.arrange({ ...this.wish, failing: this.failing.checked });
    });
  }

  set hidden(hidden: boolean) {
    this.root.hidden = this.choices.hidden = hidden;
  }

  begin(title: string, scenarios: readonly JudgedScenario[], clauses: readonly JudgedClause[]): void {
    this.title.textContent = title;
    this.total = scenarios.length;
    this.grid = new Grid(rowsOf(scenarios, clauses, local), clauses, this.wish, this.replay, (wish) => {
      this.arrange(wish);
    });
    this.place.replaceChildren(this.grid.root);
    this.arrange(this.wish);
  }

  private arrange(wish: Wish): void {
    this.wish = wish;
    this.grid?.arrange(wish);
    const count = this.grid?.count ?? 0;
    this.count.textContent = count === this.total ? "" : `${count} of ${this.total} shown`;
    this.say(this.count.textContent);
  }
}
