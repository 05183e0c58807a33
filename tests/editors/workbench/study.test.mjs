// The results of a stored run over its variations: a heat map and margins, which lead to the replay of each execution.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "tworobots/heights.bdd";

/** @type {Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
let passed = false;

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({ workspace: EXAMPLES, settings: { "robbdd.server.path": server }, prepare: run });
  workbench = session.workbench;
});

after(async () => {
  await session?.close(passed ? undefined : "study-failed");
});

test("a heat map counts what passed, and its cells lead to the replay of the worst", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.command("RobBDD: Show Study…");
  const page = workbench.webview();
  await page.getByRole("heading", { name: "3 hold, 1 violated" }).waitFor();
  assert.deepEqual(await page.locator("td").allTextContents(), ["1/1", "1/1", "1/1", "0/1"]);
  await page.getByLabel("What is counted").selectOption({ label: "at-goal" });
  await page.locator("td", { hasText: /^0\/1worst −/ }).waitFor();
  assert.ok((await page.locator(".margins rect.violated").count()) > 0);
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`study-${scheme}`);
  }
  await page.locator("td button").last().click();
  await workbench.page.locator(".tab.active", { hasText: "Replay bin-heights" }).waitFor();
  await workbench.webview().locator(".row.chosen", { hasText: "at-goal" }).waitFor();
  passed = true;
});

/** Execute four scenarios, of which physics lets one fail: the ball under the suction cup meets the rim of the bin. */
async function run(workspace) {
  const robbdd = join(dirname(LANGUAGE_SERVER), "robbdd");
  const { stdout } = await promisify(execFile)(robbdd, ["run", join(workspace, FILE), "--where", 'scale = "1.1"']).catch((error) => error);
  assert.match(stdout, /3 hold, 1 violated/);
}
