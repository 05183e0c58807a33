// Breakpoints on clauses pause a simulation: stack, variables, the scene in 3D, steps; by F5 without a configuration, and by
// the lens of a scenario.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { EXAMPLES } from "./harness/checkout.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { verdictAt } from "./harness/verdicts.mjs";

const STORY = "pickplace.bdd";
const SCENARIO = "Scenario part-to-bin";

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** Time that the page of the paused scene shows, s. */
let shown;

const step = story("debugging", (opened) => {
  session = opened;
  workbench = opened.workbench;
}, { webgl: true, workspace: join(EXAMPLES, "pickplace"), prepare: expectTooLong });

step("F5 simulates the model, and a breakpoint on a clause pauses it there with its margin", async () => {
  await workbench.openFile(STORY);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await toggleBreakpoint("in-hand:");
  await workbench.page.keyboard.press("F5");
  await pausedAt("in-hand:", "opens");
  await workbench.page.locator(".debug-call-stack .monaco-list-row", { hasText: "in-hand" }).first().waitFor();
  await workbench.page.locator(".debug-variables .monaco-list-row", { hasText: "margin now" }).first().waitFor();
});

step("the scene is shown in 3D at the pause, and follows a step", async () => {
  await workbench.command("RobBDD: Show the Paused Scene");
  const readout = scene().locator(".readout");
  await readout.filter({ hasText: /\d s/ }).waitFor();
  shown = await readout.innerText();
  const [now, end] = shown.split(" / ");
  assert.equal(`${now} s`, end);
  for (const scheme of ["light", "dark"]) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`debugging-${scheme}`);
  }
  await workbench.command("Debug: Step Over");
  await eventually(async () => {
    assert.notEqual(await readout.innerText(), shown);
  });
  await pausedAt("in-hand:", "turns negative");
});

step("it continues to its end", async () => {
  await toggleBreakpoint("in-hand:");
  await workbench.command("Debug: Continue");
  await ended();
});

step("the lens of a scenario debugs the execution that is chosen by its values, and it pauses where a clause turns negative", async () => {
  await workbench.openFile(STORY);
  await toggleBreakpoint("at-goal:");
  await workbench.goTo((await session.placeOf(STORY, SCENARIO)).line, 1);
  await workbench.codeLens("Debug").first().click();
  await workbench.page.locator(".quick-input-widget", { hasText: "Debug: which scenario?" }).waitFor();
  await workbench.screenshot("debugging-choice");
  await workbench.pick("ball0");
  await pausedAt("in-hand:", "turns negative");
  await workbench.page.locator(".debug-call-stack .monaco-list-row", { hasText: "part-to-bin" }).first().waitFor();
});

step("the scene follows each pause, and selects its clause", async () => {
  await scene().locator(".row.chosen", { hasText: "in-hand" }).waitFor();
  await scene().locator(".title", { hasText: "ball0" }).waitFor();
  await inBoth("negative");
  await workbench.command("Debug: Continue");
  await pausedAt("at-goal:", "opens");
  await scene().locator(".row.chosen", { hasText: "at-goal" }).waitFor();
  await inBoth("opens");
});

step("the verdicts of the debugged execution are beside its clauses", async () => {
  await workbench.command("Debug: Continue");
  await ended();
  await workbench.openFile(STORY);
  await workbench.goTo((await session.placeOf(STORY, "at-goal:")).line, 1);
  await verdictAt(workbench, /in-hand:/, /^✗ 0\/2/);
  await verdictAt(workbench, /at-goal:/, /^\? 2 of 4 executed/);
});

/** The page of the paused scene. */
function scene() {
  return workbench.webview("Paused");
}

async function toggleBreakpoint(clause) {
  await workbench.goTo((await session.placeOf(STORY, clause)).line, 1);
  await workbench.command("Debug: Toggle Breakpoint");
}

/** Wait until the execution is paused at a moment of a clause of the model. */
async function pausedAt(clause, moment) {
  const words = new RegExp(`^${clause.replace(":", "")} ${moment}.* at \\d`);
  await workbench.page.getByText(words).first().waitFor();
  await workbench.page.locator(".debug-top-stack-frame-line").first().waitFor({ state: "attached" });
  await workbench.cursorAt((await session.placeOf(STORY, clause)).line);
}

async function ended() {
  await workbench.page.locator(".debug-toolbar").waitFor({ state: "hidden" });
}

async function inBoth(moment) {
  for (const scheme of ["light", "dark"]) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`debugging-${moment}-${scheme}`);
  }
}

/** Expect the part in the hand until the behaviour has ended: it is released before. */
async function expectTooLong(workspace) {
  const path = join(workspace, STORY);
  const text = await readFile(path, "utf8");
  const long = text.replace("<robot>, after <evt-pick-end>", "<robot>, from <evt-pick-end> until <evt-place-end>");
  assert.notEqual(long, text);
  await writeFile(path, long);
}
