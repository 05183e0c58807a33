// The executions of a cell, the worst first, with their replays.
import type { JudgedScenario } from "../../src/panels/study/results";
import { signed } from "../../src/quantity";
import { button, element } from "../shared/elements";
import { local, shown } from "./tables";

/** Maximum number of executions in the list. */
const MOST = 200;
const SIGNS = { holds: "✔", violated: "✗", unknown: "?" } as const;

/** List executions by their numbers; `clause` is the IRI of the counted clause, or empty for whole executions. */
export function executions(
  words: string,
  indices: readonly number[],
  scenarios: readonly JudgedScenario[],
  clause: string,
  replay: (index: number, clause: string) => void,
): HTMLElement {
  const rows = indices.slice(0, MOST).flatMap((index) => {
    const scenario = scenarios[index];
    return scenario === undefined ? [] : [row(index, scenario, clause, replay)];
  });
  const heads = ["Execution", "Verdict", "Margin", "Replay"].map((text) => element("th", { scope: "col" }, text));
  const more = indices.length > MOST ? [element("p", {}, `… and ${indices.length - MOST} more: the matrix has them all.`)] : [];
  const title = `${words || "All"}: ${indices.length} execution${indices.length === 1 ? "" : "s"}`;
  return element("section", { class: "executions" }, element("h2", {}, title), element("table", {}, element("tr", {}, ...heads), ...rows), ...more);
}

function row(index: number, { values, verdict, clauses }: JudgedScenario, clause: string, replay: (index: number, clause: string) => void): HTMLElement {
  const judged = clauses.find(({ iri }) => iri === clause);
  const outcome = judged?.verdict ?? verdict;
  const margin = judged === undefined || judged.robustness === null || judged.unit === "" ? "" : signed(judged.robustness, judged.unit);
  const words = Object.entries(values).map(([name, value]) => `${local(name)} = ${shown(value)}`).join(", ");
  const press = button("Replay", `Replay ${words || `execution ${index + 1}`}`, () => {
    replay(index, clause);
  });
  return element(
    "tr",
    {},
    element("td", {}, words || `execution ${index + 1}`),
    element("td", { class: outcome }, element("span", { class: "outcome" }, `${SIGNS[outcome]} ${outcome}`)),
    element("td", { class: "number" }, margin),
    element("td", {}, press),
  );
}
