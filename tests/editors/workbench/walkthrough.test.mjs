// The walkthrough: from an empty folder to the first green clause, by its own buttons, each step ticked when it is done.
import { mkdir, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { SAMPLES } from "./harness/checkout.mjs";
import { LONG } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { verdictAt } from "./harness/verdicts.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const TITLE = "Get Started with RobBDD";

/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;

const step = story("walkthrough", (opened) => {
  ({ workbench } = opened);
}, { workspace: SAMPLES, prepare: emptied });

step("each step's button works and its tick comes with the deed", async () => {
  const { page } = workbench;
  await openWalkthrough();
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`walkthrough-${scheme}`);
  }

  await press("project", "New Project…");
  await workbench.pick("pickplace");
  await page.locator(".quick-input-message", { hasText: "The name of its folder" }).waitFor();
  await workbench.acceptInput();
  await page.locator('.tab.active[data-resource-name="pickplace.bdd"]').waitFor();
  await done("server");
  await done("project");
  await done("criteria");

  await press("criteria", "Open a Model");
  await page.locator('.tab.active[data-resource-name="pickplace.bdd"]').waitFor();

  await press("run", "Run Scenarios of This File");
  await verdictAt(workbench, /holds\(/, /^✔/, { editor: ".editor-instance .monaco-editor", timeout: LONG });
  await done("run");
  await workbench.screenshot("walkthrough-green");

  await press("break", "Show the Problems");
  await page.locator(".markers-panel").waitFor();
  await done("break");
  await workbench.screenshot("walkthrough-done");
});

async function openWalkthrough() {
  await workbench.command("Welcome: Open Walkthrough");
  await workbench.pick(TITLE);
  await workbench.page.locator(".gettingStartedContainer .getting-started-step").first().waitFor();
}

/** The part of the page that belongs to a step. */
function stepOf(id) {
  return workbench.page.locator(`.getting-started-step[data-step-id$="#${id}"]`);
}

async function press(id, button) {
  await stepOf(id).click();
  await workbench.screenshot(`walkthrough-${id}`);
  await stepOf(id).getByRole("button", { name: button }).click();
}

async function done(id) {
  await stepOf(id).locator(".codicon-getting-started-step-checked").waitFor({ state: "attached" });
}

/** A folder that holds nothing yet but a note. */
async function emptied(workspace) {
  await rm(workspace, { recursive: true });
  await mkdir(workspace);
  await writeFile(join(workspace, "notes.txt"), "Nothing yet.\n");
}
