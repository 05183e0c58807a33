// Edits are judged at once on stored traces: beside the clause, in the verdict's colour but slanted, until a run.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { dirname, join } from "node:path";
import { promisify } from "node:util";
import { LANGUAGE_SERVER } from "../harness/checkout.mjs";
import { LONG, TRY, eventually } from "../harness/patience.mjs";
import { story } from "../harness/story.mjs";
import { themeColour, verdictAt } from "../harness/verdicts.mjs";

const FILE = "pickplace/pickplace.bdd";
const GOAL = /^\s*at-goal:/;
const REJUDGED = /^✗ 4 flipped, 0 of 4 hold \(re-judged, not executed\) · worst −\d+ mm$/;

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function edits(window) {
  const step = story("edits", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, { window });

  step("an edited clause says beside it which executions flip, without a run", async () => {
    await workbench.openFile(FILE);
    // The lines and what is drawn after them need the width of the window.
    await workbench.command("View: Toggle Primary Side Bar Visibility");
    await workbench.codeLens("Run").first().click();
    await verdictAt(workbench, GOAL, /^✔ 4\/4[^(]*$/, { timeout: LONG });
    await replaceAt("place-end", "at-goal:", "place", "pick");
    await eventually(async () => {
      const found = await verdictAt(workbench, GOAL, REJUDGED);
      assert.deepEqual([found.side, found.slanted], ["after", true]);
      assert.equal(found.colour, await themeColour(workbench, "robbdd.violatedForeground"));
    });
    await inBothThemes("edits-flipped");
  });

  step("hovering over it lists the executions that flip, each with what it was", async () => {
    const hover = workbench.page.locator(".monaco-hover:visible", { hasText: /✔\s\+\d+\smm\s→\s✗\s−\d+\smm/ });
    await eventually(async () => {
      const { middle } = await verdictAt(workbench, GOAL, REJUDGED);
      await workbench.page.mouse.move(5, 5);
      await workbench.page.mouse.move(middle.x, middle.y);
      await hover.waitFor({ timeout: TRY });
    });
    await workbench.screenshot("edits-hover");
    await workbench.page.mouse.move(5, 5);
  });

  step("an undone edit has the verdict of the run again", async () => {
    await workbench.page.keyboard.press("Escape");
    await replaceAt("pick-end", "at-goal:", "pick", "place");
    await verdictAt(workbench, GOAL, /^✔ 4\/4[^(]*$/);
  });

  step("what the traces do not tell is unknown", async () => {
    await replaceAt("after <evt-place-end>", "at-goal:", "", "9 seconds ");
    await verdictAt(workbench, GOAL, /^\? 0 of 4 hold, 4 unknown \(re-judged, not executed\)$/);
    await inBothThemes("edits-unknown");
    await replaceAt("9 seconds after", "at-goal:", "9 seconds ", "");
    await verdictAt(workbench, GOAL, /^✔ 4\/4[^(]*$/);
  });

  step("a change beyond clauses judges nothing, and says what changed", async () => {
    await replaceAt("source>, before", "at-source:", "source", "goal");
    await verdictAt(workbench, GOAL, /^\? the scene changed since the run: execute a new run$/);
    await inBothThemes("edits-scene");
    await replaceAt("goal>, before", "at-source:", "goal", "source");
    await verdictAt(workbench, GOAL, /^✔ 4\/4[^(]*$/);
  });

  step("next to a wide line, the verdict is in sight", async () => {
    await workbench.command("View: Toggle Primary Side Bar Visibility");
    await replaceAt("goal>, from", "goal-untouched:", "goal", "source");
    const { side, slanted } = await verdictAt(workbench, /^\s*\)$/, /^↑ . .*4 hold \(re-judged, not executed\)/);
    assert.deepEqual([side, slanted], ["after", true]);
    await inBothThemes("edits-wide");
    await replaceAt("source>, from", "goal-untouched:", "source", "goal");
    await verdictAt(workbench, GOAL, /^✔ 4\/4[^(]*$/);
  });

  step("a run of the command line takes the place of the editor's, whose store is new to the window", async () => {
    const robbdd = join(dirname(LANGUAGE_SERVER), "robbdd");
    await promisify(execFile)(robbdd, ["run", FILE, "--repeat", "2"], { cwd: session.workspace });
    await verdictAt(workbench, GOAL, /^✔ 8\/8[^(]*$/, { timeout: LONG });
  });
}

/** Replace the beginning of a text after another one, as someone who types. */
async function replaceAt(text, after, old, typed) {
  const { line, column } = await session.placeOf(FILE, original(text), after);
  await workbench.goTo(line, column);
  for (let letter = 0; letter < old.length; letter += 1) {
    await workbench.page.keyboard.press("Delete");
  }
  await workbench.type(typed);
  await workbench.page.keyboard.press("Escape");
  const behind = text.slice(old.length);
  await workbench.lines(new RegExp(`${typed}${behind}`.replaceAll(" ", "\\s"))).first().waitFor();
}

/** The text of the file on disk, which no step saves, at the place of a text in the editor. */
function original(text) {
  return { "pick-end": "place-end", "9 seconds after": "after <evt-place-end>", "goal>, before": "source>, before", "source>, from": "goal>, from" }[text] ?? text;
}

async function inBothThemes(name) {
  for (const scheme of ["light", "dark"]) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`${name}-${scheme}`);
  }
}
