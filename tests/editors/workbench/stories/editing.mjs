// Writing a model: a mistake is mended by its quick fix, names are completed by kind, a name changes in all files.
import assert from "node:assert/strict";
import { eventually } from "../harness/patience.mjs";
import { story } from "../harness/story.mjs";

const FILE = "pickplace/pickplace.bdd";
const SCENE = "pickplace/bench.scene";

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function editing(window) {
  const step = story("editing", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, { window });

  step("a misspelt name is mended by its quick fix", async () => {
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().waitFor();
    await goBefore(FILE, "evt-end>");
    await workbench.type("x");
    await workbench.waitForError();
    await workbench.press("Control+.", workbench.page.locator(".action-widget .monaco-list-row.focused", { hasText: "Change to 'evt-end'" }));
    await workbench.screenshot("editing-quick-fix");
    await workbench.page.keyboard.press("Enter");
    await workbench.waitForNoError();
    await workbench.save();
    await eventually(async () => assert.match(await session.text(FILE), /until <evt-end>/));
  });

  step("after a time's bracket, only events are offered", async () => {
    await goBefore(FILE, "evt-end>");
    const offered = workbench.page.locator(".suggest-widget.visible .monaco-list-row .label-name");
    await workbench.press("Control+Space", offered.filter({ hasText: "evt-pick-start" }).first());
    await workbench.screenshot("editing-completion");
    await eventually(async () => {
      const names = await offered.allTextContents();
      assert.ok(names.length > 0);
      assert.deepEqual(
        names.filter((name) => !name.startsWith("evt-")),
        [],
      );
    });
    await workbench.page.keyboard.press("Escape");
  });

  step("a renamed workspace has its new name in the story, whose file is closed", async () => {
    await workbench.command("View: Close All Editors");
    await workbench.openFile(SCENE);
    await goBefore(SCENE, "right_ws }");
    const input = workbench.page.locator(".rename-box input, .rename-box .rename-input").first();
    await workbench.press("F2", input);
    await input.fill("far_ws");
    await workbench.screenshot("editing-rename");
    await workbench.page.keyboard.press("Enter");
    await workbench.lines("workspace far_ws").first().waitFor();
    await workbench.command("File: Save All Files");
    for (const file of [FILE, SCENE]) {
      await eventually(async () => assert.doesNotMatch(await session.text(file), /right_ws/));
    }
    await workbench.openFile(FILE);
    await goBefore(FILE, "<places.far_ws>");
    await workbench.lines("<places.far_ws>").first().waitFor();
    await workbench.codeLens("Run").first().waitFor();
    await workbench.waitForNoError();
  });
}

/** Put the cursor before a text of a file on disk. */
async function goBefore(path, text) {
  const { line, column } = await session.placeOf(path, text);
  await workbench.goTo(line, column);
}
