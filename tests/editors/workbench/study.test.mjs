// The results of a stored run over its variations: a heat map and margins, which lead to the replay of each execution.
import assert from "node:assert/strict";
import { join } from "node:path";
import { execute } from "./harness/models.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "tworobots/heights.bdd";

/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;

const step = story("study", (opened) => {
  ({ workbench } = opened);
}, { prepare: run });

step("a heat map counts what passed, and its cells lead to the replay of the worst", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.command("RobBDD: Show Study…");
  const page = workbench.webview("Study");
  await page.getByRole("heading", { name: "3 hold, 1 violated" }).waitFor();
  await eventually(async () => assert.deepEqual(await page.locator("td").allTextContents(), ["1/1", "1/1", "1/1", "0/1"]));
  await page.getByLabel("What is counted").selectOption({ label: "at-goal" });
  await page.locator("td", { hasText: /^0\/1worst −/ }).waitFor();
  await page.locator(".margins rect.violated").first().waitFor();
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`study-${scheme}`);
  }
  await page.locator("td button").last().click();
  await workbench.page.locator(".tab.active", { hasText: "Replay bin-heights" }).waitFor();
  await workbench.webview("Replay").locator(".row.chosen", { hasText: "at-goal" }).waitFor();
});

/** Execute four scenarios, one of which fails: the ball under the suction cup hits the rim of the bin. */
function run(workspace) {
  return execute(join(workspace, FILE), 'scale = "1.1"', /3 hold, 1 violated/);
}
