// The study page: a heat map over two variables, and the distribution of each clause's margins.
import "./study.css";
import type { FromStudy, StudyState, ToStudy } from "../../src/panels/study/messages";
import type { JudgedClause, JudgedScenario } from "../../src/panels/study/results";
import { signed } from "../../src/quantity";
import { drawn, element } from "../shared/elements";
import { connect } from "../shared/host";
import { type Bin, type Cell, type Dimension, cell, clauses, dimensions, histogram } from "./tables";

const BINS = 40;
const WIDTH = 300;
const HEIGHT = 40;
const NOTHING = "";

const host = connect<FromStudy, StudyState>((message) => {
  begin(message as ToStudy);
});
const title = element("h1");
const across = element("select", { "aria-label": "Variable across" });
const down = element("select", { "aria-label": "Variable down" });
const subject = element("select", { "aria-label": "What is counted" });
const map = element("div", { class: "map" });
const margins = element("div", { class: "margins" });
let scenarios: readonly JudgedScenario[] = [];
let found: readonly Dimension[] = [];
let studied: ToStudy["studied"] | undefined;

document.body.append(
  element(
    "header",
    { role: "toolbar", "aria-label": "Study" },
    element("label", {}, "Passed: ", subject),
    element("label", {}, "across ", across),
    element("label", {}, "down ", down),
  ),
  element("main", {}, title, map, element("h2", {}, "Margins of the clauses"), margins),
);
for (const choice of [across, down, subject]) {
  choice.addEventListener("change", () => {
    draw();
  });
}

function begin(message: ToStudy): void {
  ({ studied } = message);
  ({ scenarios } = message.results);
  title.textContent = message.title;
  found = dimensions(scenarios);
  const every = clauses(scenarios);
  offer(subject, [[NOTHING, "scenarios"], ...every.map((clause): Choice => [clause.iri, named(clause)])], host.kept?.clause);
  const names = found.map(({ name }): Choice => [name, local(name)]);
  const none: Choice = [NOTHING, "nothing"];
  offer(across, [...names, none], host.kept?.across);
  offer(down, [none, ...names], host.kept?.down ?? found[1]?.name);
  margins.replaceChildren(...every.map(distribution));
  draw();
}

type Choice = readonly [value: string, label: string];

function offer(select: HTMLSelectElement, choices: readonly Choice[], wanted: string | undefined): void {
  select.replaceChildren(...choices.map(([value, label]) => element("option", { value }, label)));
  if (wanted !== undefined && choices.some(([value]) => value === wanted)) {
    select.value = wanted;
  }
}

function draw(): void {
  map.replaceChildren(heatMap(dimension(across.value), dimension(down.value), subject.value));
  if (studied !== undefined) {
    host.keep({ studied, across: across.value, down: down.value, clause: subject.value });
  }
}

function dimension(name: string): Dimension | undefined {
  return found.find((one) => one.name === name);
}

function heatMap(columns: Dimension | undefined, rows: Dimension | undefined, clause: string): HTMLElement {
  const heads = columns?.values ?? [NOTHING];
  const where = (one: Dimension | undefined, value: string) => (one === undefined ? [] : [[one.name, value] as const]);
  const corner = element("th", { scope: "col", class: "corner" }, rows === undefined ? "" : local(rows.name));
  const body = (rows?.values ?? [NOTHING]).map((value) => {
    const cells = heads.map((head) =>
      square(cell(scenarios, [...where(columns, head), ...where(rows, value)], clause), clause),
    );
    return element("tr", {}, element("th", { scope: "row" }, value), ...cells);
  });
  const table = element("table", {}, element("tr", {}, corner, ...heads.map((head) => element("th", { scope: "col" }, head))));
  if (columns !== undefined) {
    table.prepend(element("caption", {}, local(columns.name)));
  }
  table.append(...body);
  return table;
}

/** A cell: the pass rate as colour and text, and the worst margin; it links to the worst execution. */
function square(counted: Cell | undefined, clause: string): HTMLElement {
  if (counted === undefined) {
    return element("td", { class: "none", title: "Not executed" }, "–");
  }
  const { passed, total, worst, unit, index } = counted;
  const press = element("button", { type: "button", title: "Replay the worst of these" }, `${passed}/${total}`);
  if (worst !== undefined && unit !== "") {
    press.append(element("small", {}, `worst ${signed(worst, unit)}`));
  }
  press.style.setProperty("--passed", `${(100 * passed) / total}%`);
  press.addEventListener("click", () => {
    replay(index, clause);
  });
  return element("td", {}, press);
}

/** A clause with its verdict counts and its margins as bars: below zero violated. */
function distribution(clause: JudgedClause): HTMLElement {
  const judged = scenarios.flatMap((scenario) => scenario.clauses.filter(({ iri }) => iri === clause.iri));
  const count = (wanted: string) => judged.filter(({ verdict }) => verdict === wanted).length;
  const tally = (["holds", "violated", "unknown"] as const)
    .filter((verdict) => count(verdict) > 0)
    .map((verdict) => element("span", { class: verdict }, `${count(verdict)} ${verdict === "holds" && count(verdict) > 1 ? "hold" : verdict}`));
  const head = element("div", { class: "clause", title: clause.sentence }, element("span", { class: "name" }, named(clause)), ...tally);
  const bins = clause.unit === "" ? [] : histogram(scenarios, clause.iri, BINS);
  return element("section", {}, head, bins.length > 0 ? bars(bins, clause) : element("div", { class: "none" }, noMargin(clause)));
}

function noMargin({ unit }: JudgedClause): string {
  return unit === "" ? "holds or does not: no margin" : "no margin was judged";
}

function bars(bins: readonly Bin[], clause: JudgedClause): Element {
  const most = Math.max(...bins.map(({ count }) => count));
  const [low, high] = [bins[0]?.from ?? 0, bins.at(-1)?.to ?? 0];
  const x = (value: number) => ((value - low) / (high - low)) * WIDTH;
  const label = (value: number, anchor: string) =>
    drawn("text", { x: x(value), y: HEIGHT + 12, "text-anchor": anchor }, value === 0 ? "0" : signed(value, clause.unit));
  const picture = drawn("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT + 16}`, role: "group", "aria-label": `Margins of ${clause.name}` });
  picture.append(drawn("line", { x1: 0, x2: WIDTH, y1: HEIGHT, y2: HEIGHT }));
  for (const { from, to, count, index } of bins) {
    if (count > 0) {
      // A single execution must still be visible and clickable.
      const height = Math.max(4, (count / most) * (HEIGHT - 4));
      const said = `${count} × ${signed(from, clause.unit)} to ${signed(to, clause.unit)}: replay the smallest`;
      const middle = (from + to) / 2;
      const bar = drawn(
        "rect",
        { class: middle < 0 ? "violated" : "holds", x: x(from) + 0.5, y: HEIGHT - height, width: x(to) - x(from) - 1, height, tabindex: 0, role: "button", "aria-label": said },
        drawn("title", {}, said),
      );
      bar.addEventListener("click", () => {
        replay(index, clause.iri);
      });
      bar.addEventListener("keydown", ({ key }) => {
        if (key === "Enter" || key === " ") {
          replay(index, clause.iri);
        }
      });
      picture.append(bar);
    }
  }
  picture.append(drawn("line", { class: "zero", x1: x(0), x2: x(0), y1: 0, y2: HEIGHT }), label(low, "start"), label(high, "end"));
  if (x(0) > 60 && x(0) < WIDTH - 60) {
    picture.append(label(0, "middle"));
  }
  return picture;
}

function replay(index: number, clause: string): void {
  host.post({ type: "replay", index, ...(clause === NOTHING ? {} : { clause }) });
}

/** A behaviour has a generated name, and its sentence differs between variations. */
function named({ role, name }: JudgedClause): string {
  return role === "when" ? "behaviour" : name;
}

/** The local name of a variable: the end of its IRI or CURIE. */
function local(name: string): string {
  return name.replace(/^.*[/#:]/, "").replace(/^var-/, "");
}
