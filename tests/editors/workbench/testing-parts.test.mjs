// Parts of the Testing view: the executions of a .bddx, a row of a table by its icon, a run with recording, a replay from a row.
import assert from "node:assert/strict";
import { readdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { LONG, TRY, eventually } from "./harness/patience.mjs";
import { testingStory } from "./harness/testingView.mjs";
import { verdictAt } from "./harness/verdicts.mjs";

/** A table of two rows, and a clause that says that the part is in the bin before it was picked. */
const ROWS_FILE = "rows.bdd";
const ROWS = ["<cubes.cube0>", "<balls.ball0>"];

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** @type {import("./harness/testingView.mjs").TestingView} */
let tests;

const step = testingStory("testing-parts", (opened, view) => {
  session = opened;
  workbench = opened.workbench;
  tests = view;
}, (text, workspace) => writeFile(join(workspace, ROWS_FILE), withRows(text)));

step("an execution is listed with its settings, and runs separately", async () => {
  await tests.show();
  await tests.expand("pickplace.bddx");
  const execution = /in-simulation.*4 scenarios.*by built-in.*in bench_sim.*near-goal/;
  await tests.row(execution).waitFor();
  await tests.runRow(execution);
  await tests.turns("passed", execution);
  await tests.expand(execution);
  await tests.expand("thing = cube0, goal = left_ws");
  await tests.turns("passed", /Then at-goal.*\+\d+.*mm/);
  await workbench.screenshot("testing-execution");
  assert.equal(await tests.rowsThat("passed", /^\s*tidy-bench/).count(), 0, "the scenarios as they are were not run");
  await tests.collapse("pickplace.bddx");
});

step("the executions of an open file run from the palette, and show results at their declarations", async () => {
  await workbench.openFile("pickplace.bddx");
  const { scenarios } = await session.runOf(() => workbench.command("RobBDD: Run Scenarios of This File"));
  assert.deepEqual(scenarios.map(({ execution }) => execution), Array(4).fill("exec:in-simulation"));
  await workbench.goTo((await session.placeOf("pickplace.bddx", "Scenario Exec")).line, 1);
  await verdictAt(workbench, /Scenario Exec .*in-simulation/, /4\/4 passed/);
  await workbench.screenshot("testing-executions");
});

step("the icon at a row of a table runs only this row", async () => {
  await workbench.closePanel();
  await workbench.openFile(ROWS_FILE);
  await tests.expand("rows-bench");
  await tests.expand("by-rows");
  await tests.row("thing = ball0").waitFor();
  const { line } = await session.placeOf(ROWS_FILE, `| ${ROWS[1]} |`);
  await workbench.goTo(line, 1);
  await clickIcon(line);
  await tests.turns("failed", "thing = ball0");
  assert.equal(await tests.rowsThat("failed", "thing = cube0").count(), 0);
  await workbench.screenshot("testing-row");
});

step("a run with recording reports the places of the recording and the pictures", async () => {
  await tests.choose("thing = cube0", "Execute Using Profile");
  await workbench.pick("Run with Recording");
  await tests.turns("failed", "thing = cube0");
  const terminal = workbench.page.locator(".part.panel .xterm-rows");
  const told = terminal.filter({ hasText: "picture of a violation" }).filter({ hasText: /Recording,\scan\sbe\sreplayed:/ });
  await told.first().waitFor({ timeout: LONG });
  await workbench.screenshot("testing-recorded");
  const { length } = await session.runs();
  const pictures = await readdir(join(session.workspace, ".robbdd", "runs", String(length), "pictures"));
  assert.ok(pictures.some((name) => name.endsWith(".png")), pictures.join(", "));
});

step("the menu of a clause's row opens the replay at this clause", async () => {
  await tests.expand("thing = cube0");
  await tests.choose("Then at-goal", "Replay");
  const page = workbench.webview("Replay");
  await page.locator(".row.chosen", { hasText: "at-goal" }).waitFor();
  await page.locator(".title", { hasText: "cube0" }).waitFor();
  await workbench.screenshot("testing-replay");
});

step("a run from the palette that is refused says why at the variant, until it is run again", async () => {
  const path = join(session.workspace, ROWS_FILE);
  const text = await session.text(ROWS_FILE);
  await workbench.openFile(ROWS_FILE);
  await workbench.goTo((await session.placeOf(ROWS_FILE, "Given:")).line, 1);
  await writeFile(path, text.replace("Given:", "Given"));
  await workbench.lines(/^\s*Given\s*$/).waitFor();
  await workbench.command("RobBDD: Run Scenarios of This File");
  await tests.turns("error", "by-rows");
  await workbench.page.locator(".part.panel", { hasText: /the\smodel\shas\serrors/ }).first().waitFor();
  await workbench.screenshot("testing-refused-elsewhere");
  await writeFile(path, text);
  await workbench.lines(/^\s*Given:\s*$/).waitFor();
  await workbench.command("RobBDD: Run Scenarios of This File");
  await tests.turns("failed", "by-rows");
  await tests.rowsThat("error").first().waitFor({ state: "detached" });
});

/** Click the icon in the margin of a line. */
async function clickIcon(line) {
  await eventually(async () => {
    const icons = workbench.page.locator(".editor-group-container.active .testing-run-glyph");
    // In one go: the editor may redraw its margin at any time.
    const beside = await icons.evaluateAll((found, wanted) => {
      const numbers = [...document.querySelectorAll(".editor-group-container.active .line-numbers")];
      const number = numbers.find(({ textContent }) => textContent === String(wanted))?.getBoundingClientRect();
      return found.findIndex((icon) => {
        const { top, height } = icon.getBoundingClientRect();
        return number !== undefined && Math.abs(top - number.top) < height / 2;
      });
    }, line);
    assert.ok(beside >= 0, `there is no icon beside line ${line}`);
    await icons.nth(beside).click({ timeout: TRY });
  });
}

function withRows(text) {
  const [head] = text
    .replace("https://example.org/robbdd/criteria/", "https://example.org/robbdd/rows/")
    .replace("tidy-bench", "rows-bench")
    .replace("part-to-bin", "by-rows")
    .replace("at <goal>, after <evt-place-end>", "at <goal>, before <evt-pick-start>")
    .split("                var <pick-place.thing>:");
  const columns = ["thing", "robot", "source", "goal"].map((name) => `<pick-place.${name}>`).join(" | ");
  const rows = ROWS.map((part) => `| ${part} | <arms.panda> | <places.table_ws> | <places.left_ws> |`);
  return [head.trimEnd(), `| ${columns} |`, "|---|---|---|---|", ...rows, "        }", "}", ""].join("\n");
}
