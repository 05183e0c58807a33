// The verdicts drawn in an editor, which are not elements of the page.
import { PATIENCE } from "./patience.mjs";
import { EDITOR } from "./workbench.mjs";

/**
 * Wait until a verdict is drawn at a visible line of an editor, and return its appearance.
 *
 * @param {import("./workbench.mjs").Workbench} workbench
 * @param {RegExp} line what the line reads
 * @param {RegExp} words what the verdict reads
 * @param {object} [options]
 * @param {string} [options.editor] the active one if none is named
 * @param {number} [options.timeout]
 * @returns {Promise<Drawn>}
 *
 * @typedef {object} Drawn
 * @property {string} words
 * @property {"before" | "after"} side of its place in the text
 * @property {string} colour as CSS says it, like `ground`, which is behind it
 * @property {string} ground
 * @property {boolean} slanted
 * @property {{x: number, y: number}} middle of what is drawn, in the window
 */
export async function verdictAt(workbench, line, words, { editor = EDITOR, timeout = PATIENCE } = {}) {
  const found = await workbench.page.waitForFunction(drawnAt, wanted(editor, line, words), { timeout });
  return found.jsonValue();
}

/** Wait until no verdict is drawn at visible lines that read like this. */
export async function noVerdictAt(workbench, line) {
  await workbench.page.waitForFunction(drawnAt, { ...wanted(EDITOR, line, /^[✔✗?] /), none: true });
}

/** A colour of the theme as CSS says computed ones. */
export function themeColour(workbench, id) {
  return workbench.page.evaluate((name) => {
    const probe = document.querySelector(".monaco-workbench").appendChild(document.createElement("i"));
    probe.style.color = `var(${name})`;
    const { color } = getComputedStyle(probe);
    probe.remove();
    return color;
  }, `--vscode-${id.replaceAll(".", "-")}`);
}

function wanted(editor, line, words) {
  return { editor, line: [line.source, line.flags], words: [words.source, words.flags] };
}

/** Runs in the page, in one go: the editor may redraw its lines at any time. */
function drawnAt({ editor, line, words, none = false }) {
  const [wantedLine, wantedWords] = [new RegExp(...line), new RegExp(...words)];
  for (const drawn of document.querySelectorAll(`${editor} .view-line`)) {
    for (const span of wantedLine.test(drawn.textContent.replaceAll("\u00a0", " ")) ? drawn.querySelectorAll("span") : []) {
      for (const side of ["before", "after"]) {
        const { content, color, fontStyle } = getComputedStyle(span, `::${side}`);
        // The content is a string of CSS, in quotes.
        if (content.startsWith('"') && wantedWords.test(content.slice(1, -1))) {
          const { left, top, width, height } = span.getBoundingClientRect();
          const ground = getComputedStyle(drawn.closest(".monaco-editor-background, .monaco-editor")).backgroundColor;
          const middle = { x: left + width / 2, y: top + height / 2 };
          return none ? false : { words: content.slice(1, -1), side, colour: color, ground, slanted: fontStyle === "italic", middle };
        }
      }
    }
  }
  return none;
}
