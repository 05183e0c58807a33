// The matrix on the page: only the rows and columns in sight exist. One stop of the Tab key; arrow keys move within.
import type { JudgedClause } from "../../src/panels/study/results";
import { signed } from "../../src/quantity";
import { element } from "../shared/elements";
import { type Row, type Verdict, type Wish, ROWS, WHOLE, arranged, columnsOf, inSight } from "./matrix";

/** px, as in study.css. */
const ROW = 24;
const COLUMN = 30;
const HEAD = 130;
const NAME = 260;
const SIGNS = { holds: "✔", violated: "✗", unknown: "?" } as const;

/** Replays an execution, at a clause by its IRI. */
export type Open = (index: number, clause: string) => void;

export class Grid {
  private readonly canvas = element("div", { class: "canvas", role: "presentation" });
  private readonly status = element("div", { class: "cellwords", "aria-hidden": "true" });
  private readonly scroller: HTMLElement;
  readonly root: HTMLElement;
  private rows: readonly Row[] = [];
  private columns: readonly number[] = [];
  /** The active cell: row -1 is the heads; column 0 the execution, 1 its verdict, then the clauses. */
  private active = { row: 0, column: 0 };
  private drawn = false;

  constructor(
    private readonly every: readonly Row[],
    private readonly clauses: readonly JudgedClause[],
    private wish: Wish,
    private readonly open: Open,
    private readonly wished: (wish: Wish) => void,
  ) {
    this.scroller = element("div", { class: "grid", role: "grid", tabindex: 0, "aria-label": "Verdicts of clauses by execution" }, this.canvas);
    this.root = element("section", { class: "matrix" }, this.scroller, this.status);
    this.scroller.addEventListener("scroll", () => {
      this.drawSoon();
    });
    this.scroller.addEventListener("keydown", (event) => {
      this.press(event);
    });
    this.scroller.addEventListener("click", ({ target }) => {
      const at = target instanceof Element ? target.closest<HTMLElement>("[data-row]") : null;
      if (at !== null) {
        this.move(Number(at.dataset["row"]), Number(at.dataset["column"]));
        this.act();
      }
    });
    new ResizeObserver(() => {
      this.drawSoon();
    }).observe(this.scroller);
    this.arrange(wish);
  }

  /** How many executions are shown. */
  get count(): number {
    return this.rows.length;
  }

  arrange(wish: Wish): void {
    this.wish = wish;
    this.rows = arranged(this.every, wish);
    this.columns = columnsOf(this.every, this.clauses.length, wish);
    this.scroller.setAttribute("aria-rowcount", String(this.rows.length + 1));
    this.scroller.setAttribute("aria-colcount", String(this.columns.length + 2));
    this.canvas.style.width = `${NAME + (this.columns.length + 1) * COLUMN}px`;
    this.canvas.style.height = `${HEAD + this.rows.length * ROW}px`;
    this.move(Math.min(this.active.row, this.rows.length - 1), Math.min(this.active.column, this.columns.length + 1));
  }

  private drawSoon(): void {
    if (!this.drawn) {
      this.drawn = true;
      requestAnimationFrame(() => {
        this.draw();
      });
    }
  }

  private draw(): void {
    this.drawn = false;
    const { scrollTop, scrollLeft, clientWidth, clientHeight } = this.scroller;
    const [top, bottom] = inSight(scrollTop, clientHeight - HEAD, ROW, this.rows.length);
    const [left, right] = inSight(scrollLeft, clientWidth - NAME, COLUMN, this.columns.length + 1);
    const rows = this.rows.slice(top, bottom).map((row, place) => this.row(row, top + place, left, right));
    this.canvas.replaceChildren(this.heads(left, right), ...rows);
    const active = idOf(this.active.row, this.active.column);
    // Scrolled away by the mouse, it does not exist.
    if (this.canvas.querySelector(`#${active}`) === null) {
      this.scroller.removeAttribute("aria-activedescendant");
    } else {
      this.scroller.setAttribute("aria-activedescendant", active);
    }
  }

  private heads(left: number, right: number): HTMLElement {
    const corner = this.head(0, "Execution", ROWS);
    const heads = Array.from({ length: right - left }, (_, place) => {
      const column = left + place;
      return column === 0 ? this.head(1, "all clauses", WHOLE) : this.head(column + 1, this.nameOf(column - 1), this.columns[column - 1] ?? 0);
    });
    return element("div", { class: "heads", role: "row", "aria-rowindex": 1 }, corner, ...heads);
  }

  private head(column: number, words: string, by: number): HTMLElement {
    const sorted = this.wish.by === by ? (this.wish.descending ? "descending" : "ascending") : "none";
    // Heads of clauses are turned round.
    const [up, down] = column === 0 ? [" ▲", " ▼"] : [" ▼", " ▲"];
    const mark = sorted === "none" ? "" : sorted === "ascending" ? up : down;
    const head = this.cell("columnheader", -1, column, words + mark, `Sort by ${words}`);
    head.setAttribute("aria-sort", sorted);
    return head;
  }

  private row(row: Row, number: number, left: number, right: number): HTMLElement {
    const cells = Array.from({ length: right - left }, (_, place) => {
      const column = left + place;
      return column === 0 ? this.verdict(number, 1, row.verdict, "") : this.judged(number, column + 1, row.cells[this.columns[column - 1] ?? -1]);
    });
    const name = this.cell("rowheader", number, 0, row.words || `execution ${row.index + 1}`, row.words);
    const made = element("div", { class: "line", role: "row", "aria-rowindex": number + 2 }, name, ...cells);
    made.style.top = `${HEAD + number * ROW}px`;
    return made;
  }

  private judged(row: number, column: number, clause: JudgedClause | undefined): HTMLElement {
    return clause === undefined ? this.cell("gridcell", row, column, "", "not judged") : this.verdict(row, column, clause.verdict, marginOf(clause));
  }

  private verdict(row: number, column: number, verdict: Verdict, margin: string): HTMLElement {
    const cell = this.cell("gridcell", row, column, SIGNS[verdict], [verdict, margin].filter(Boolean).join(" by "));
    cell.classList.add("verdict", verdict);
    return cell;
  }

  private cell(role: string, row: number, column: number, text: string, words: string): HTMLElement {
    const at = { id: idOf(row, column), "aria-colindex": column + 1, "data-row": row, "data-column": column };
    const active = row === this.active.row && column === this.active.column;
    const made = element("div", { role, class: active ? "cell active" : "cell", title: words, ...at }, text);
    if (role === "gridcell") {
      made.setAttribute("aria-label", words);
    }
    if (column > 0) {
      made.style.left = `${NAME + (column - 1) * COLUMN}px`;
    }
    return made;
  }

  private press(event: KeyboardEvent): void {
    const { row, column } = this.active;
    const page = Math.max(1, Math.floor((this.scroller.clientHeight - HEAD) / ROW) - 1);
    const last = { row: this.rows.length - 1, column: this.columns.length + 1 };
    const places: Readonly<Record<string, readonly [number, number]>> = {
      ArrowDown: [row + 1, column],
      ArrowUp: [row - 1, column],
      ArrowRight: [row, column + 1],
      ArrowLeft: [row, column - 1],
      PageDown: [row + page, column],
      PageUp: [Math.max(0, row - page), column],
      Home: event.ctrlKey ? [0, 0] : [row, 0],
      End: event.ctrlKey ? [last.row, last.column] : [row, last.column],
    };
    const place = event.altKey || event.metaKey ? undefined : places[event.key];
    if (place !== undefined) {
      this.move(Math.max(-1, Math.min(last.row, place[0])), Math.max(0, Math.min(last.column, place[1])));
      event.preventDefault();
    } else if (event.key === "Enter" || event.key === " ") {
      this.act();
      event.preventDefault();
    }
  }

  /** Make a cell the active one and bring it into sight. */
  private move(row: number, column: number): void {
    this.active = { row, column };
    const { scrollTop, scrollLeft, clientWidth, clientHeight } = this.scroller;
    const [top, left] = [row * ROW, (column - 1) * COLUMN];
    if (row >= 0) {
      this.scroller.scrollTop = Math.min(top, Math.max(scrollTop, top + ROW - (clientHeight - HEAD)));
    }
    if (column > 0) {
      this.scroller.scrollLeft = Math.min(left, Math.max(scrollLeft, left + COLUMN - (clientWidth - NAME)));
    }
    this.status.textContent = this.words();
    this.drawSoon();
  }

  /** The active cell in words. */
  private words(): string {
    const { row, column } = this.active;
    const shown = this.rows[row];
    const clause = shown?.cells[this.columns[column - 2] ?? -1];
    if (shown === undefined || column === 0) {
      return shown?.words ?? "";
    }
    const what = column === 1 ? `all clauses: ${shown.verdict}` : `${this.nameOf(column - 2)}: ${clause === undefined ? "not judged" : [clause.verdict, marginOf(clause)].filter(Boolean).join(" by ")}`;
    return `${what} · ${shown.words}`;
  }

  /** Sort by the active head, or replay the active cell. */
  private act(): void {
    const { row, column } = this.active;
    const found = this.rows[row];
    if (found !== undefined) {
      this.open(found.index, found.cells[this.columns[column - 2] ?? -1]?.iri ?? "");
    } else if (row < 0) {
      const by = column === 0 ? ROWS : column === 1 ? WHOLE : (this.columns[column - 2] ?? ROWS);
      this.wished({ ...this.wish, by, descending: this.wish.by === by && !this.wish.descending });
    }
  }

  private nameOf(column: number): string {
    const clause = this.clauses[this.columns[column] ?? -1];
    return clause === undefined ? "" : clause.role === "when" ? "behaviour" : clause.name;
  }
}

function marginOf({ robustness, unit }: JudgedClause): string {
  return robustness === null || unit === "" ? "" : signed(robustness, unit);
}

function idOf(row: number, column: number): string {
  return `cell-${row < 0 ? "head" : row}-${column}`;
}
