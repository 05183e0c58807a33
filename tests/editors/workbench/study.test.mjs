// The results of a stored run over its variations: a heat map and margins, which lead to the replay of each execution.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { execute } from "./harness/models.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "tworobots/heights.bdd";

/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;

/** @type {import("./harness/session.mjs").Session} */
let session;

const step = story("study", (opened) => {
  session = opened;
  ({ workbench } = opened);
}, { prepare: run });

step("a heat map counts what passed, and its cells lead to the replay of the worst", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.command("RobBDD: Show Study…");
  await workbench.pick("Run 1");
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

step("the history of a clause lists its runs, and two of them are compared", async () => {
  await workbench.openFile(FILE);
  const lines = (await session.text(FILE)).split("\n");
  await workbench.goTo(lines.findIndex((line) => line.includes("at-goal: holds(")) + 1, 20);
  await workbench.page.keyboard.press("Control+K");
  await workbench.page.keyboard.press("Alt+H");
  const history = workbench.webview("History of at-goal");
  await history.getByRole("heading", { name: "at-goal: holds in 0 of 2 runs" }).waitFor();
  await eventually(async () => assert.deepEqual(await history.locator("td.verdict").allTextContents(), ["✗ 0/1", "✗ 3/4"]));
  await history.locator("tr.stale", { hasText: "the clause has changed since" }).waitFor();
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`history-${scheme}`);
  }
  await history.getByRole("button", { name: /^Show which executions flipped/ }).click();
  const comparison = workbench.webview("Run 1 → 2");
  await comparison.getByRole("heading", { name: "Run 1 → run 2: 1 flipped, 0 the same, 3 only in run 1" }).waitFor();
  await comparison.getByText("the model has changed").waitFor();
  await comparison.getByText(/^at-goal ✔ → ✗ \(\+.* → −.*\)/).waitFor();
  await workbench.screenshot("comparison");
  await comparison.getByRole("button", { name: "Replay run 1 and run 2 next to each other" }).click();
  await workbench.page.locator(".tab", { hasText: /Replay bin-heights.*\(run 1\)/ }).waitFor();
  await workbench.page.locator(".tab.active", { hasText: "(run 2)" }).waitFor();
});

/**
 * Execute four scenarios, one of which fails: the ball under the suction cup hits the rim of the bin. Then execute one
 * that holds again, with a clause that expects the part in the bin too early.
 */
async function run(workspace) {
  const path = join(workspace, FILE);
  await execute(path, 'scale = "1.1"', /3 hold, 1 violated/);
  const text = await readFile(path, "utf8");
  await writeFile(path, text.replace("<goal>, after <evt-place-end>", "<goal>, after <evt-pick-end>"));
  await execute(path, 'scale = "1.1" and robot = panda and part = cube', /1 violated/);
  await writeFile(path, text);
}
