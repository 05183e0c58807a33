// Runs as one wants them: options that are remembered, their estimate, a part of the scenarios, until a failure.
import assert from "node:assert/strict";
import { LONG } from "../harness/patience.mjs";
import { story } from "../harness/story.mjs";
import { verdictAt } from "../harness/verdicts.mjs";

const FILE = "pickplace/pickplace.bdd";
const SCENARIO = /^\s*Scenario part-to-bin/;

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function running(window) {
  const step = story("running", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, { window });

  step("the options of a run say how many executions there are", async () => {
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().waitFor();
    await workbench.command("RobBDD: Run with Options…");
    await entry(/Run.*all as in the model/s).waitFor();
    await extent(/: 4 executions$/).waitFor();
    await workbench.pick("Values");
    await answer("gaol=left_ws");
    await extent(/unknown variable 'gaol'; known variables: thing/).waitFor();
    await workbench.screenshot("running-no-such-variable");
    await workbench.pick("Values");
    await answer("goal=left_ws");
    await workbench.pick("Seed");
    await answer("7");
    await workbench.pick("Processes");
    await answer("1");
    await workbench.pick("Pictures");
    await entry(/Run.*where goal=left_ws, seed 7, 1 at a time, with pictures/s).waitFor();
    await extent(/: 2 executions/).waitFor();
    await workbench.screenshot("running-options");
  });

  step("only the chosen scenarios are executed, with the chosen seed", async () => {
    await workbench.pick("Run");
    const { line } = await session.placeOf(FILE, "Scenario part-to-bin");
    await workbench.goTo(line, 1);
    await verdictAt(workbench, SCENARIO, /^\? 2 of 4 executed, 2 passed$/, { timeout: LONG });
    // Pictures are rendered after the last verdict: of violations only.
    await workbench.page.locator(".notification-toast", { hasText: "No scenario was violated, so there is no picture." }).waitFor({ timeout: LONG });
    await workbench.screenshot("running-ended");
    const ended = JSON.parse(await session.text("pickplace/.robbdd/runs/1/results.json"));
    assert.deepEqual([ended.seed, ended.scenarios.length], [7, 2]);
  });

  step("they are remembered for the folder, also when the window loads again, until they are reset", async () => {
    await workbench.reload();
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().waitFor();
    await workbench.command("RobBDD: Run with Options…");
    await entry(/Run.*where goal=left_ws, seed 7, 1 at a time, with pictures/s).waitFor();
    await workbench.pick("Reset");
    await entry(/Run.*all as in the model/s).waitFor();
    await workbench.pick("Scenarios");
    await workbench.pick("All combinations of 2 variables");
    await entry(/Run.*all combinations of 2 variables/s).waitFor();
    await workbench.pick("Scenarios");
    await workbench.pick("A random sample of");
    await answer("1");
    await entry(/Run.*a random sample of 1/s).waitFor();
    await workbench.pick("Repetitions");
    await answer("5000");
    await extent(/: 5,000 executions, about \d+/).waitFor();
    await workbench.screenshot("running-estimate");
    await workbench.pick("Reset");
    await entry(/Run.*all as in the model/s).waitFor();
    await workbench.page.keyboard.press("Escape");
  });

  step("a run until a failure says that all executions held", async () => {
    await workbench.command("RobBDD: Run until It Fails…");
    await typed("2");
    const toast = await workbench.notification("executions held");
    await workbench.screenshot("running-all-held");
    assert.match(await toast.innerText(), /All 8 executions held\./);
  });
}

/** The title of the list, with the extent of the run. */
function extent(text) {
  return workbench.page.locator(".quick-input-title", { hasText: text });
}

/** An entry of the list of options. */
function entry(text) {
  return workbench.page.locator(".quick-input-list .monaco-list-row", { hasText: text });
}

/** Answer the question of an input box, after which the list of options is there again. */
async function answer(text) {
  await typed(text);
  await workbench.page.locator(".quick-input-list .monaco-list-row").first().waitFor();
}

/** Type the answer to the question of an input box. */
async function typed(text) {
  const input = workbench.page.locator(".quick-input-widget .quick-input-filter input");
  await workbench.page.locator(".quick-input-widget .quick-input-message").waitFor();
  await input.fill(text);
  await workbench.acceptInput();
}
