// The Gherkin of a model next to its text: it follows every edit and the cursor, and survives a mistake.
import { story } from "../harness/story.mjs";

const FILE = "pickplace/pickplace.bdd";

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function preview(window) {
  const step = story("preview", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, { window });

  step("the command opens the feature next to the model", async () => {
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().waitFor();
    await workbench.command("RobBDD: Preview Gherkin");
    await shown(/Feature:\s/).first().waitFor();
    await shown(/#\s4\sscenarios/).first().waitFor();
  });

  step("the cursor in a clause shows its step", async () => {
    const { line, column } = await session.placeOf(FILE, "is held by");
    await workbench.goTo(line, column);
    await shown(/is\sheld\sby/).first().waitFor();
    await workbench.page.locator(".editor-group-container:not(.active) .cdr[class*=ced-]").first().waitFor();
    await workbench.screenshot("preview");
  });

  step("an edit changes the feature, unsaved", async () => {
    const { line, column } = await session.placeOf(FILE, "So That");
    await workbench.goTo(line, column + 'So That "'.length);
    await workbench.type("quickly ");
    await workbench.goTo(1, 1);
    await shown(/So\sthat\squickly/).first().waitFor();
  });

  step("a mistake keeps the last good feature and says so", async () => {
    await workbench.type("oops");
    await shown(/#\sout\sof\sdate/).first().waitFor();
    await shown(/So\sthat\squickly/).first().waitFor();
    await workbench.screenshot("preview-out-of-date");
    await workbench.undo();
    await shown(/#\s4\sscenarios/).first().waitFor();
  });
}

/** The lines of the preview that match; it is the group that does not have the keyboard. */
function shown(text) {
  return workbench.page.locator(".editor-group-container:not(.active) .view-line", { hasText: text });
}
