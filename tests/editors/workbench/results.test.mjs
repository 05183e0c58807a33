// Results where one reads: hovering a violated clause shows the violated moment and the margin over time.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "pickplace/pickplace.bdd";
const RUN_LIMIT = 5 * 60_000;

/** @type {Session} */
let session;
let passed = false;

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({
    workspace: EXAMPLES,
    settings: { "robbdd.server.path": server },
    prepare: async (workspace) => {
      // The goal is asked for before the thing can be there.
      const text = await readFile(join(workspace, FILE), "utf8");
      const late = "is located at <goal>, after <evt-place-end>";
      assert.ok(text.includes(late));
      await writeFile(join(workspace, FILE), text.replace(late, "is located at <goal>, after <evt-pick-end>"));
    },
  });
});

after(async () => {
  await session?.close(passed ? undefined : "results-failed");
});

test("hover on a violated clause shows the moment and the margin over time", async () => {
  const { workbench } = session;
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().click();
  const clause = workbench.lines("at-goal:");
  await clause.filter({ hasText: "✗" }).waitFor({ timeout: RUN_LIMIT });
  await workbench.statusText(/RobBDD$/, RUN_LIMIT);
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.focusEditor();
    const line = (await session.text(FILE)).split("\n").findIndex((text) => text.includes("at-goal:")) + 1;
    await workbench.goTo(line, 15);
    const pictures = workbench.page.locator(".monaco-hover img");
    await hoverUntil(workbench, pictures.nth(1));
    await pictures.first().scrollIntoViewIfNeeded();
    for (const picture of await pictures.all()) {
      const width = await picture.evaluate((image) => image.decode().then(() => image.naturalWidth));
      assert.ok(width >= 300, `a picture is ${width} pixels wide`);
    }
    await workbench.screenshot(`results-hover-${scheme}`);
    await workbench.page.keyboard.press("Escape");
  }
  passed = true;
});

/** Ask for the hover until it has something: the picture of the moment is taken when the run is over. */
async function hoverUntil(workbench, wanted) {
  for (const deadline = Date.now() + RUN_LIMIT; ; ) {
    await workbench.command("Show or Focus Hover");
    try {
      return await wanted.waitFor({ timeout: 5_000 });
    } catch (error) {
      if (Date.now() > deadline) {
        throw error;
      }
      await workbench.page.keyboard.press("Escape");
    }
  }
}
