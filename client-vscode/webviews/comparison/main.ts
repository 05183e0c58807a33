// The page that compares two runs: what differs in their input, each clause in both, and the executions that flipped.
import "./comparison.css";
import { type Change, type Comparison, type Side, changeWords, sign, summaryOf, totalsWords } from "../../src/panels/comparison/answer";
import type { ComparisonState, FromComparison, ToComparison } from "../../src/panels/comparison/messages";
import { titleOf } from "../../src/panels/replay/answer";
import { outcome } from "../../src/panels/runs";
import { button, element } from "../shared/elements";
import { connect } from "../shared/host";
import { stacked } from "../shared/tables";

/** Maximum number of executions in the table. */
const MOST = 500;

const host = connect<FromComparison, ComparisonState>((message) => {
  receive(message as ToComparison);
});
const page = element("main");
document.body.append(page);

function receive({ pair, comparison }: ToComparison): void {
  host.keep({ pair });
  const { before, after, inputs, changes } = comparison;
  const sides = [before, after].map((run) => element("li", {}, `Run ${run.run} of ${run.path}: ${outcome(run)}`));
  const different = inputs.length > 0 ? inputs : ["nothing: model, seed, files and versions are the same"];
  page.replaceChildren(
    element("h1", {}, `Run ${before.run} → run ${after.run}: ${summaryOf(comparison)}`),
    element("ul", {}, ...sides),
    element("h2", {}, "What differs in their input"),
    element("ul", {}, ...different.map((words) => element("li", {}, words))),
    element("h2", {}, "Executions"),
    changes.length === 0 ? element("p", {}, "No execution flipped.") : executions(comparison),
    element("h2", {}, "Clauses"),
    clauses(comparison),
  );
}

function executions({ before, after, changes }: Comparison): HTMLElement {
  const heads = ["Execution", `Run ${before.run}`, `Run ${after.run}`, "Clauses that flipped", "Replay"];
  const rows = changes.slice(0, MOST).map((change) => {
    const again = change.repetition > 1 ? `, repetition ${change.repetition}` : "";
    const flips = change.clauses.length === 0 ? [] : [element("ul", {}, ...change.clauses.map((clause) => element("li", {}, changeWords(clause))))];
    const name = element("td", {}, titleOf(change), element("div", { class: "remark" }, `${change.values}${again}`));
    return element("tr", {}, name, verdict(change.before), verdict(change.after), element("td", {}, ...flips), element("td", {}, replays(change, before.run, after.run)));
  });
  const table = stacked(heads, rows);
  return changes.length > MOST ? element("div", {}, table, element("p", {}, `… and ${changes.length - MOST} more`)) : table;
}

function verdict(side: Side | null): HTMLElement {
  return element("td", { class: `verdict ${side?.verdict ?? ""}` }, side === null ? "not executed" : `${sign(side.verdict)} ${side.verdict}`);
}

/** Buttons for the replays of an execution: each run alone, or both next to each other. */
function replays({ before, after, clauses: [clause] }: Change, one: number, other: number): HTMLElement {
  const selects = clause === undefined ? {} : { clause: clause.iri };
  const first = before?.trace === true ? { before: before.index } : undefined;
  const second = after?.trace === true ? { after: after.index } : undefined;
  const made = element("div", { class: "buttons" });
  const add = (label: string, title: string, indices: Partial<FromComparison>) => {
    made.append(
      button(label, title, () => {
        host.post({ type: "replay", ...indices, ...selects });
      }),
    );
  };
  if (first !== undefined && second !== undefined) {
    add("Both", `Replay run ${one} and run ${other} next to each other`, { ...first, ...second });
  }
  if (first !== undefined) {
    add(`${one}`, `Replay run ${one}`, first);
  }
  if (second !== undefined) {
    add(`${other}`, `Replay run ${other}`, second);
  }
  return made;
}

function clauses({ before, after, clauses: every }: Comparison): HTMLElement {
  const heads = ["Clause", `Run ${before.run}`, `Run ${after.run}`];
  const rows = every.map(({ role, name, before: old, after: now }) =>
    element("tr", {}, ...[role === "when" ? "behaviour" : name, totalsWords(old), totalsWords(now)].map((text) => element("td", {}, text))),
  );
  return stacked(heads, rows);
}
