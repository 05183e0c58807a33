// The study page: a heat map over two variables with its executions and margins, or the matrix of all verdicts.
import "./study.css";
import type { FromStudy, StudyPart, StudyState, ToStudy } from "../../src/panels/study/messages";
import { unpacked } from "../../src/panels/study/packed";
import type { JudgedClause, JudgedScenario } from "../../src/panels/study/results";
import { signed } from "../../src/quantity";
import { intervalWords } from "../../src/statistics";
import { announcer, button, drawn, element } from "../shared/elements";
import { connect } from "../shared/host";
import { toolbar } from "../shared/toolbar";
import { executions } from "./executions";
import { MatrixPart } from "./matrixPart";
import { type Bin, type Cell, type Dimension, cell, clauses, dimensions, failing, histogram, local, openingPair } from "./tables";

const BINS = 40;
const WIDTH = 300;
const HEIGHT = 40;
const NOTHING = "";
const NOTE =
  "Below the counts: 95 % interval (Wilson) of the probability that an execution holds, for executions that are independent samples; an unknown one may be either. Press a cell to list its executions.";

const host = connect<FromStudy, StudyState>((message) => {
  begin(message as ToStudy);
});
const title = element("h1");
const across = element("select", { "aria-label": "Variable across" });
const down = element("select", { "aria-label": "Variable down" });
const subject = element("select", { "aria-label": "What is counted" });
const map = element("div", { class: "map" });
const failures = element("p");
const listed = element("div", { class: "listed" });
const margins = element("div", { class: "margins" });
const spoken = announcer();
const tabs = { factors: tab("Factors", "factors"), matrix: tab("Matrix", "matrix") } as const;
const choices = element("span", { class: "choices" }, element("label", {}, "Passed: ", subject), element("label", {}, "across ", across), element("label", {}, "down ", down));
const factors = element("main", {}, title, failures, map, element("p", { class: "note" }, NOTE), listed, element("h2", {}, "Margins of the clauses"), margins);
const matrix = new MatrixPart(replay, spoken.say);
let scenarios: readonly JudgedScenario[] = [];
let found: readonly Dimension[] = [];
let studied: ToStudy["studied"] | undefined;
let part: StudyPart = host.kept?.part ?? "factors";

document.body.append(element("header", {}, toolbar("Study", tabs.factors, tabs.matrix, choices, matrix.choices)), factors, matrix.root, spoken.root);
for (const choice of [across, down, subject]) {
  choice.addEventListener("change", () => {
    listed.replaceChildren();
    draw();
  });
}

function tab(words: string, shows: StudyPart): HTMLButtonElement {
  return button(words, `${words}: show this part of the study`, () => {
    show(shows);
  });
}

/** Show one part of the page. */
function show(shown: StudyPart): void {
  part = shown;
  for (const [name, one] of Object.entries(tabs)) {
    one.setAttribute("aria-pressed", String(name === part));
  }
  factors.hidden = choices.hidden = part !== "factors";
  matrix.hidden = part !== "matrix";
  keep();
}

function begin(message: ToStudy): void {
  ({ studied } = message);
  scenarios = unpacked(message.results);
  title.textContent = message.title;
  found = dimensions(scenarios);
  const every = clauses(scenarios);
  offer(subject, [[NOTHING, "scenarios"], ...every.map((clause): Choice => [clause.iri, named(clause)])], host.kept?.clause);
  const names = found.map(({ name }): Choice => [name, local(name)]);
  const none: Choice = [NOTHING, "nothing"];
  const [first, second] = openingPair(found);
  offer(across, [...names, none], host.kept?.across ?? first?.name);
  offer(down, [none, ...names], host.kept?.down ?? second?.name);
  margins.replaceChildren(...every.map(distribution));
  matrix.begin(message.title, scenarios, every);
  draw();
  show(message.show ?? part);
}

function keep(): void {
  if (studied !== undefined) {
    host.keep({ studied, across: across.value, down: down.value, clause: subject.value, part });
  }
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
  failures.replaceChildren(...failureList(failing(scenarios, subject.value), subject.value));
  keep();
}

function dimension(name: string): Dimension | undefined {
  return found.find((one) => one.name === name);
}

function heatMap(columns: Dimension | undefined, rows: Dimension | undefined, clause: string): HTMLElement {
  const heads = columns?.values ?? [NOTHING];
  const where = (one: Dimension | undefined, value: string) => (one === undefined ? [] : [[one.name, value] as const]);
  const corner = element("th", { scope: "col", class: "corner" }, rows === undefined ? "" : local(rows.name));
  const body = (rows?.values ?? [NOTHING]).map((value) => {
    const cells = heads.map((head) => {
      const at = [...where(columns, head), ...where(rows, value)];
      return square(cell(scenarios, at, clause), clause, at.map(([name, one]) => `${local(name)} = ${one}`).join(", "));
    });
    return element("tr", {}, element("th", { scope: "row" }, value), ...cells);
  });
  const table = element("table", {}, element("tr", {}, corner, ...heads.map((head) => element("th", { scope: "col" }, head))));
  if (columns !== undefined) {
    table.prepend(element("caption", {}, local(columns.name)));
  }
  table.append(...body);
  return table;
}

/** A cell: how many hold, as colour and text, their interval and the worst margin; it lists its executions. */
function square(counted: Cell | undefined, clause: string, words: string): HTMLElement {
  if (counted === undefined) {
    return element("td", { class: "none", title: "Not executed" }, "–");
  }
  const { passed, total, unknown, worst, unit, indices } = counted;
  const press = element("button", { type: "button", title: `${words}: list these executions`, "aria-expanded": "false" }, `${passed}/${total}`);
  press.append(element("small", {}, intervalWords(passed, total, unknown)));
  if (worst !== undefined && unit !== "") {
    press.append(element("small", {}, `worst ${signed(worst, unit)}`));
  }
  press.style.setProperty("--passed", `${(100 * passed) / total}%`);
  press.addEventListener("click", () => {
    list(press, words, indices, clause);
  });
  return element("td", {}, press);
}

/** A button that lists the executions that do not hold, over all values; nothing if all hold. */
function failureList(indices: readonly number[], clause: string): HTMLElement[] {
  if (indices.length === 0) {
    return [];
  }
  const press = button("What does not hold", "What does not hold: list these executions, the worst first", () => {
    list(press, "Do not hold", indices, clause);
  });
  press.setAttribute("aria-expanded", "false");
  return [press];
}

/** List executions below the map, where the keyboard goes; `press` is the button that asked for it. */
function list(press: HTMLElement, words: string, indices: readonly number[], clause: string): void {
  for (const other of factors.querySelectorAll("[aria-expanded]")) {
    other.setAttribute("aria-expanded", String(other === press));
  }
  listed.replaceChildren(executions(words, indices, scenarios, clause, replay));
  listed.querySelector("button")?.focus();
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
