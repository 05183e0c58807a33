// Breakpoints on clauses pause a simulation: stack, variables, the scene in 3D, steps; by F5 without a configuration.
import assert from "node:assert/strict";
import { join } from "node:path";
import { EXAMPLES } from "./harness/checkout.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";

const STORY = "pickplace.bdd";

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** Time that the page of the paused scene shows, s. */
let shown;

const step = story("debugging", (opened) => {
  session = opened;
  workbench = opened.workbench;
}, { webgl: true, workspace: join(EXAMPLES, "pickplace") });

step("F5 simulates the model, and a breakpoint on a clause pauses it there with its margin", async () => {
  await workbench.openFile(STORY);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  const { line } = await session.placeOf(STORY, "in-hand:");
  await workbench.goTo(line, 1);
  await workbench.command("Debug: Toggle Breakpoint");
  await workbench.page.keyboard.press("F5");
  await workbench.page.locator(".debug-top-stack-frame-line").first().waitFor({ state: "attached" });
  await workbench.cursorAt(line);
  await workbench.page.locator(".debug-call-stack .monaco-list-row", { hasText: "in-hand" }).first().waitFor();
  await workbench.page.locator(".debug-variables .monaco-list-row", { hasText: "margin at the end" }).first().waitFor();
});

step("the scene is shown in 3D at the pause, and follows a step", async () => {
  await workbench.command("RobBDD: Show the Paused Scene");
  const readout = workbench.webview("Paused").locator(".readout");
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
});

step("it continues to its end", async () => {
  await workbench.command("Debug: Continue");
  await workbench.page.locator(".debug-toolbar").waitFor({ state: "hidden" });
});
