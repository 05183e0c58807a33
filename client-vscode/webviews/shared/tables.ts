// Tables of a report, which become blocks in a narrow column.
import { element } from "./elements";

/** A table; each cell knows its head, which a narrow column shows in front of it. A first cell with a head has its own line. */
export function stacked(heads: readonly string[], rows: readonly HTMLTableRowElement[]): HTMLElement {
  for (const { cells } of rows) {
    for (const [place, cell] of [...cells].entries()) {
      const head = heads[place] ?? "";
      if (place === 0 && head !== "") {
        cell.classList.add("first");
      } else if (head !== "") {
        cell.dataset["head"] = head;
      }
    }
  }
  const top = element("tr", {}, ...heads.map((head) => (head === "" ? element("td") : element("th", { scope: "col" }, head))));
  return element("div", { class: "wide", tabindex: 0, role: "region", "aria-label": heads.filter(Boolean).join(", ") }, element("table", { class: "stacked" }, top, ...rows));
}
