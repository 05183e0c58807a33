// Results where one reads: hovering a violated clause shows the violated moment and the margin over time.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { LONG, TRY, eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { verdictAt } from "./harness/verdicts.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "pickplace/pickplace.bdd";

/** @type {import("./harness/session.mjs").Session} */
let session;

const step = story("results", (opened) => {
  session = opened;
}, {
  prepare: async (workspace) => {
    // The goal clause is evaluated before the object can be there.
    const text = await readFile(join(workspace, FILE), "utf8");
    const late = "is located at <goal>, after <evt-place-end>";
    assert.ok(text.includes(late));
    await writeFile(join(workspace, FILE), text.replace(late, "is located at <goal>, after <evt-pick-end>"));
  },
});

step("hover on a violated clause shows the moment and the margin over time", async () => {
  const { workbench } = session;
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().click();
  await verdictAt(workbench, /at-goal:/, /^✗/, { timeout: LONG });
  await workbench.statusText(/RobBDD$/, LONG);
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.focusEditor();
    const { line, column } = await session.placeOf(FILE, "at-goal:");
    await workbench.goTo(line, column);
    // The picture of the moment is taken when the run is over; the hover that was there before has none.
    const pictures = workbench.page.locator(".monaco-hover img");
    await eventually(async () => {
      await workbench.page.keyboard.press("Escape");
      await workbench.command("Show or Focus Hover");
      await pictures.nth(1).waitFor({ timeout: TRY });
      await pictures.first().scrollIntoViewIfNeeded({ timeout: TRY });
      for (const picture of await pictures.all()) {
        const width = await picture.evaluate((image) => image.decode().then(() => image.naturalWidth));
        assert.ok(width >= 300, `a picture is ${width} pixels wide`);
      }
    }, LONG);
    await workbench.screenshot(`results-hover-${scheme}`);
    await workbench.page.keyboard.press("Escape");
  }
});
