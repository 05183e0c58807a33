"use strict";
// The heat map of two factors and the matrix of scenarios × clauses: drawn on demand, which keeps the page small.
(() => {
  const MOST_ROWS = 200;
  const data = JSON.parse(document.getElementById("data").textContent);
  const { scenarios, clauses, of, judged } = data.matrix;
  const byClause = { name: "clause", levels: clauses };
  const everything = { name: "", levels: ["all executions"], of: data.verdicts.map(() => 0) };
  const nothing = () => ({ h: 0, v: 0, u: 0 });
  const LETTERS = { holds: "h", violated: "v", unknown: "u" };

  function element(name, text, attributes = {}) {
    const made = Object.assign(document.createElement(name), attributes);
    made.textContent = text;
    return made;
  }
  function cell({ h, v, u }) {
    const total = h + v + u;
    const made = element("td", total === 0 ? "—" : `${h}/${total}${u > 0 ? ` (${u} unknown)` : ""}`);
    if (total > 0) {
      made.style.background = `color-mix(in srgb, color-mix(in srgb, var(--good) ${(100 * h) / total}%, var(--bad)) 35%, var(--back))`;
    }
    return made;
  }
  function fill(table, words, columns, names, cells) {
    const head = element("tr", "");
    head.append(element("td", ""), ...columns.map((level) => element("th", level, { scope: "col" })));
    const body = cells.map((line, number) => {
      const row = element("tr", "");
      row.append(element("th", names[number], { scope: "row" }), ...line.map(cell));
      return row;
    });
    table.replaceChildren(element("caption", words), head, ...body);
  }

  const chosen = ["rows", "columns"].map((name) => document.getElementById(name));
  function heat() {
    const rows = data.factors[chosen[0].value];
    const byClauses = chosen[1].value === "clauses";
    const columns = byClauses ? byClause : (data.factors[chosen[1].value] ?? everything);
    const cells = rows.levels.map(() => columns.levels.map(nothing));
    data.verdicts.forEach((verdict, index) => {
      const line = cells[rows.of[index]];
      if (byClauses) {
        [...judged[index]].forEach((letter, place) => letter !== "-" && (line[place][letter] += 1));
      } else {
        line[columns.of[index]][LETTERS[verdict]] += 1;
      }
    });
    const words = columns === everything ? `Pass rate by ${rows.name}.` : `Pass rate by ${rows.name} and ${columns.name}.`;
    fill(document.getElementById("heat"), words, columns.levels, rows.levels, cells);
  }
  if (chosen[0] !== null) {
    for (const one of chosen) {
      one.addEventListener("change", heat);
    }
    heat();
  }

  const failing = document.getElementById("failing");
  function matrix() {
    const cells = scenarios.map(() => clauses.map(nothing));
    judged.forEach((letters, index) => [...letters].forEach((letter, place) => letter !== "-" && (cells[of[index]][place][letter] += 1)));
    const wanted = scenarios.map((_, number) => number).filter((number) => !failing.checked || cells[number].some(({ v, u }) => v + u > 0));
    const shown = wanted.slice(0, MOST_ROWS);
    const left = wanted.length > shown.length ? ` The first ${MOST_ROWS} of ${wanted.length} are shown.` : "";
    fill(
      document.getElementById("matrix"),
      `Executions in which each clause holds: ${shown.length} scenario${shown.length === 1 ? "" : "s"}.${left}`,
      clauses,
      shown.map((number) => scenarios[number]),
      shown.map((number) => cells[number]),
    );
  }
  failing.addEventListener("change", matrix);
  matrix();
})();
