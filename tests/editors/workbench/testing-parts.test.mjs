// Parts of the Testing view: the executions of a .bddx, a row of a table by its icon, a run with recording, a replay from a row.
import assert from "node:assert/strict";
import { readFile, readdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { EXAMPLES } from "./harness/checkout.mjs";
import { story } from "./harness/story.mjs";
import { TestingView } from "./harness/testingView.mjs";

const FILE = "pickplace.bdd";
/** A table of two rows, and a clause that says that the part is in the bin before it was picked. */
const ROWS_FILE = "rows.bdd";
const ROWS = ["<cubes.cube0>", "<balls.ball0>"];
const RUN_LIMIT = 3 * 60_000;

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** @type {TestingView} */
let tests;

const step = story("testing-parts", (opened) => {
  session = opened;
  workbench = opened.workbench;
  tests = new TestingView(workbench);
}, {
  workspace: join(EXAMPLES, "pickplace"),
  settings: { "testing.automaticallyOpenPeekView": "never" },
  prepare: async (workspace) => {
    const text = await readFile(join(workspace, FILE), "utf8");
    await writeFile(join(workspace, ROWS_FILE), withRows(text));
  },
});

step("an execution is listed with what it says, and run by itself", async () => {
  await tests.show();
  await tests.expand("pickplace.bddx");
  const execution = /in-simulation.*4 scenarios.*by built-in.*in bench_sim.*near-goal/;
  await tests.row(execution).waitFor();
  await tests.runRow(execution);
  await tests.rowsThat("passed", execution).waitFor({ timeout: RUN_LIMIT });
  await tests.expand(execution);
  await tests.expand("thing = cube0, goal = left_ws");
  await tests.rowsThat("passed", /Then at-goal.*\+\d+.*mm/).waitFor();
  await workbench.screenshot("testing-execution");
  assert.equal(await tests.rowsThat("passed", /^\s*tidy-bench/).count(), 0, "the scenarios as they are were not run");
  await tests.collapse("pickplace.bddx");
});

step("the icon beside a row of a table runs this row alone", async () => {
  await workbench.closePanel();
  await workbench.openFile(ROWS_FILE);
  await tests.expand("rows-bench");
  await tests.expand("by-rows");
  await tests.row("thing = ball0").waitFor();
  await workbench.goTo(await lineOf(ROWS[1]), 1);
  await clickIcon(await lineOf(ROWS[1]));
  await tests.rowsThat("failed", "thing = ball0").waitFor({ timeout: RUN_LIMIT });
  assert.equal(await tests.rowsThat("failed", "thing = cube0").count(), 0);
  await workbench.screenshot("testing-row");
});

step("a run with recording tells where the recording and the pictures are", async () => {
  await tests.choose("thing = cube0", "Execute Using Profile");
  const profile = workbench.page.locator(".quick-input-list .monaco-list-row", { hasText: "Run with Recording" });
  await profile.waitFor();
  await workbench.page.keyboard.type("Recording");
  await workbench.page.keyboard.press("Enter");
  await tests.rowsThat("failed", "thing = cube0").waitFor({ timeout: RUN_LIMIT });
  const told = workbench.page.locator(".part.panel .xterm-rows", { hasText: "picture of a violation" });
  await told.waitFor({ timeout: RUN_LIMIT });
  await workbench.screenshot("testing-recorded");
  const words = (await told.textContent()).replaceAll("\u00a0", " ");
  assert.match(words, /Recorded, for a replay too: /);
  const { length } = await session.runs();
  const pictures = await readdir(join(session.workspace, ".robbdd", "runs", String(length), "pictures"));
  assert.ok(pictures.some((name) => name.endsWith(".png")), pictures.join(", "));
});

step("the menu of a clause's row opens the replay at this clause", async () => {
  await tests.expand("thing = cube0");
  await tests.choose("Then at-goal", "Replay");
  const page = workbench.webview();
  await page.locator(".row.chosen", { hasText: "at-goal" }).waitFor();
  assert.match(await page.locator(".title").textContent(), /cube0/);
  await workbench.screenshot("testing-replay");
});

step("a run from the palette that is refused says why at the variant, until it is run again", async () => {
  const path = join(session.workspace, ROWS_FILE);
  const text = await readFile(path, "utf8");
  await workbench.openFile(ROWS_FILE);
  await workbench.goTo(text.slice(0, text.indexOf("Given:")).split("\n").length, 1);
  await writeFile(path, text.replace("Given:", "Given"));
  await workbench.lines(/^\s*Given\s*$/).waitFor();
  await workbench.command("RobBDD: Run Scenarios of This File");
  await tests.rowsThat("error", "by-rows").waitFor();
  await workbench.page.locator(".part.panel", { hasText: /the\smodel\shas\serrors/ }).first().waitFor();
  await workbench.screenshot("testing-refused-elsewhere");
  await writeFile(path, text);
  await workbench.lines(/^\s*Given:\s*$/).waitFor();
  await workbench.command("RobBDD: Run Scenarios of This File");
  await tests.rowsThat("failed", "by-rows").waitFor({ timeout: RUN_LIMIT });
  assert.equal(await tests.rowsThat("error").count(), 0);
});

/** The icon in the margin beside a line. */
async function clickIcon(line) {
  const number = workbench.page.locator(".editor-group-container.active .line-numbers", { hasText: new RegExp(`^${line}$`) });
  const { y, height } = await number.boundingBox();
  for (const icon of await workbench.page.locator(".editor-group-container.active .testing-run-glyph").all()) {
    const box = await icon.boundingBox();
    if (box !== null && Math.abs(box.y - y) < height / 2) {
      await workbench.page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
      return;
    }
  }
  assert.fail(`there is no icon beside line ${line}`);
}

/** The line of a row of the table, from 1. */
async function lineOf(cell) {
  const lines = (await session.text(ROWS_FILE)).split("\n");
  return lines.findIndex((line) => line.includes(`| ${cell} |`)) + 1;
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
