/* Order of the search results: of pages that contain the words, guides are first and pages on the project last; within a
   section, the order is that of the table of contents.
   Sphinx loads this file in place of its own scores; the numbers but SECTIONS are its defaults. */
const SECTIONS = { Start: 4, "How to": 4, Reference: 2, Explanation: 1, Examples: 0, Project: -2 };
const AT_THE_END_OF_GUIDES = { changelog: -4, upgrading: -1 };

function weight(docname) {
  let place = 0;
  for (const caption of document.querySelectorAll(".sidebar-tree .caption")) {
    for (const link of caption.nextElementSibling?.querySelectorAll("a") ?? []) {
      place += 1;
      if (link.getAttribute("href") === `${docname}.html`) return (SECTIONS[caption.textContent.trim()] ?? 0) - place / 1000;
    }
  }
  return -1;
}

var Scorer = {
  score: ([docname, , , , score]) => score + weight(docname) + (AT_THE_END_OF_GUIDES[docname] ?? 0),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
