// The walkthrough: from an empty folder to the first green clause, by its own buttons, each step ticked when it is done.
import { mkdir, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { LANGUAGE_SERVER, SAMPLES, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const RUN_LIMIT = 3 * 60_000;
const TITLE = "Get Started with RobBDD";

/** @type {Session} */
let session;
let passed = false;

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({ workspace: SAMPLES, settings: { "robbdd.server.path": server }, prepare: emptied });
});

after(async () => {
  await session?.close(passed ? undefined : "walkthrough-not-passed");
});

test("each step's button works and its tick comes with the deed", async () => {
  const { workbench } = session;
  const { page } = workbench;
  await openWalkthrough(workbench);
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`walkthrough-${scheme}`);
  }

  await press(workbench, "project", "New Project…");
  await page.locator(".quick-input-list .monaco-list-row", { hasText: "pickplace" }).click();
  await page.locator(".quick-input-title", { hasText: "New RobBDD Project" }).waitFor();
  await page.keyboard.press("Enter");
  await page.locator('.tab.active[data-resource-name="pickplace.bdd"]').waitFor();
  await done(workbench, "server");
  await done(workbench, "project");
  await done(workbench, "criteria");

  await press(workbench, "criteria", "Open a Model");
  await page.locator('.tab.active[data-resource-name="pickplace.bdd"]').waitFor();

  await press(workbench, "run", "Run Scenarios of This File");
  const verdict = page.locator(".editor-instance .monaco-editor .view-line", { hasText: "✔" });
  await verdict.first().waitFor({ timeout: RUN_LIMIT });
  await done(workbench, "run");
  await workbench.screenshot("walkthrough-green");

  await press(workbench, "break", "Show the Problems");
  await page.locator(".markers-panel").waitFor();
  await done(workbench, "break");
  await workbench.screenshot("walkthrough-done");
  passed = true;
});

async function openWalkthrough(workbench) {
  await workbench.command("Welcome: Open Walkthrough");
  const { page } = workbench;
  await page.locator(".quick-input-list .monaco-list-row", { hasText: TITLE }).click();
  await page.locator(".gettingStartedContainer .getting-started-step").first().waitFor();
}

/** The part of the page that belongs to a step. */
function stepOf(workbench, id) {
  return workbench.page.locator(`.getting-started-step[data-step-id$="#${id}"]`);
}

async function press(workbench, id, button) {
  const step = stepOf(workbench, id);
  await step.click();
  await workbench.screenshot(`walkthrough-${id}`);
  await step.getByRole("button", { name: button }).click();
}

async function done(workbench, id) {
  await stepOf(workbench, id).locator(".codicon-getting-started-step-checked").waitFor({ state: "attached" });
}

/** A folder that holds nothing yet but a note. */
async function emptied(workspace) {
  await rm(workspace, { recursive: true });
  await mkdir(workspace);
  await writeFile(join(workspace, "notes.txt"), "Nothing yet.\n");
}
