// A behaviour in Python that raises: the error is shown with its traceback and the code's output until it is fixed.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { EXAMPLES } from "./harness/checkout.mjs";
import { TRY, eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { TestingView } from "./harness/testingView.mjs";

const EXECUTIONS = "tidy.bddx";
const STORY = "tidy.bdd";
const CODE = "carrying.py";
/** Reads an argument that the behaviour does not get. */
const BROKEN = 'print("looking for a goal") or arguments["goal"]';
const SOUND = 'arguments["workspace"]';
const ERROR = "KeyError: 'goal'";
const EXECUTION = /by-our-code/;

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** @type {TestingView} */
let tests;

const step = story("user-code", (opened) => {
  session = opened;
  workbench = opened.workbench;
  tests = new TestingView(workbench);
}, {
  workspace: join(EXAMPLES, "ownrobot"),
  settings: { "testing.automaticallyOpenPeekView": "never" },
  prepare: (workspace) => replace(workspace, SOUND, BROKEN),
});

step("a behaviour that raises leaves its execution with an error, not with a verdict", async () => {
  await workbench.openFile(EXECUTIONS);
  await tests.show();
  await tests.expand(EXECUTIONS);
  await tests.runRow(EXECUTION);
  await tests.turns("error", EXECUTION);
});

step("Test Results shows the error once, with its traceback and the code's output", async () => {
  await workbench.command("Test Results: Focus on Test Results View");
  const output = workbench.page.locator(".part.panel .xterm-rows");
  const told = output.filter({ hasText: /error\s1:/ }).filter({ hasText: ERROR }).filter({ hasText: /│\slooking\sfor\sa\sgoal/ });
  await output.filter({ hasText: /0\sof\s2\sscenarios\spassed,\s2\serrored/ }).first().waitFor();
  // The terminal shows the end of the output; the traceback is at its beginning.
  const { x, y } = await output.first().boundingBox();
  await workbench.page.mouse.move(x + 50, y + 50);
  await eventually(async () => {
    await workbench.page.mouse.wheel(0, -10_000);
    assert.ok(await told.first().isVisible(), "the traceback is not in sight");
  });
  await workbench.screenshot("user-code-results");
  const text = await told.first().innerText();
  assert.equal(text.split(ERROR).length, 2, text);
});

step("a line of the traceback is a link to the code", async () => {
  const { line } = await session.placeOf(CODE, BROKEN);
  const call = workbench.page.locator(".part.panel .xterm-rows > div", { hasText: `line ${line}` });
  await eventually(async () => {
    // The terminal looks for links in a line when the pointer moves there, and takes its time: the pointer stays in the line.
    const { x, y, height } = await call.last().boundingBox();
    await workbench.page.mouse.move(x + 60, y + height / 2);
    await workbench.page.mouse.move(x + 120, y + height / 2, { steps: 10 });
    await workbench.page.keyboard.down("Control");
    await workbench.page.mouse.click(x + 124, y + height / 2);
    await workbench.page.keyboard.up("Control");
    await workbench.page.locator(`.tab.active[data-resource-name="${CODE}"]`).waitFor({ timeout: TRY / 5 });
  });
  await workbench.cursorAt(line);
  await workbench.waitForError();
  await workbench.screenshot("user-code-line");
});

step("Problems lists the error at the Python line, at the bhv: and at the scenario, each once", async () => {
  const problems = await workbench.openProblems();
  const places = [
    [CODE, await session.placeOf(CODE, BROKEN)],
    [EXECUTIONS, await session.placeOf(EXECUTIONS, "bhv: <ours>")],
    [STORY, await session.placeOf(STORY, "Scenario cube-to-bin")],
  ];
  await eventually(async () => {
    const rows = await problems.locator(".monaco-list-row", { hasText: "user-code-error" }).allTextContents();
    for (const [file, { line }] of places) {
      assert.equal(rows.filter((row) => row.includes(`[Ln ${line},`)).length, 1, `${file}, line ${line}: ${rows.join("\n")}`);
    }
    assert.equal(rows.length, places.length, rows.join("\n"));
  });
  await workbench.screenshot("user-code-problems");
  await problems.locator(".monaco-list-row", { hasText: "2 scenarios have no result" }).dblclick();
  await workbench.page.locator(`.tab.active[data-resource-name="${STORY}"]`).waitFor();
  await workbench.cursorAt((await session.placeOf(STORY, "Scenario cube-to-bin")).line);
});

step("code that is fixed takes the error from all places, and the next run has verdicts", async () => {
  await replace(session.workspace, BROKEN, SOUND);
  const problems = await workbench.openProblems();
  await problems.getByText("No problems have been detected").waitFor();
  await tests.show();
  await tests.runRow(EXECUTION);
  await tests.turns("passed", EXECUTION);
  await workbench.screenshot("user-code-fixed");
});

step("a breakpoint in the code stops a debugged run there, until it goes on", async () => {
  await workbench.openFile(CODE);
  const { line } = await session.placeOf(CODE, SOUND);
  await workbench.goTo(line, 1);
  await workbench.command("Debug: Toggle Breakpoint");
  await workbench.openFile(EXECUTIONS);
  await workbench.command("RobBDD: Debug Scenarios of This File");
  await workbench.page.locator(`.tab.active[data-resource-name="${CODE}"]`).waitFor();
  await workbench.page.locator(".debug-top-stack-frame-line").first().waitFor({ state: "attached" });
  await workbench.cursorAt(line);
  await workbench.page.locator(".debug-call-stack .monaco-list-row", { hasText: CODE }).first().waitFor();
  await workbench.screenshot("user-code-debugged");
  await workbench.command("Debug: Toggle Breakpoint");
  await workbench.page.keyboard.press("F5");
  await workbench.page.locator(".debug-toolbar").waitFor({ state: "hidden" });
});

async function replace(workspace, text, other) {
  const path = join(workspace, CODE);
  const before = await readFile(path, "utf8");
  assert.ok(before.includes(text));
  await writeFile(path, before.replace(text, other));
}
