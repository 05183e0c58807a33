// The Testing view: its tree, runs begun in it and elsewhere, a failing clause, again, cancelling, refusals, runs on save.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { rename, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { promisify } from "node:util";
import { LANGUAGE_SERVER } from "./harness/checkout.mjs";
import { renamed, writeEndless } from "./harness/models.mjs";
import { TRY, eventually, timed } from "./harness/patience.mjs";
import { testingStory } from "./harness/testingView.mjs";
import { verdictAt } from "./harness/verdicts.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "pickplace.bdd";
/** A clause of it says that the part is in the bin before it was picked. */
const FAILING_FILE = "failing.bdd";
/** The same task under other names: one whose scenarios are run from the lens alone, and one that does not end. */
const LENS_FILE = "lens.bdd";
const ENDLESS_FILE = "endless.bdd";
const RESULTS = "ci-results.xml";
const BROKEN_RESULTS = "ci-broken.json";

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** @type {import("./harness/testingView.mjs").TestingView} */
let tests;

const step = testingStory("testing", (opened, view) => {
  session = opened;
  workbench = opened.workbench;
  tests = view;
}, async (text, workspace) => {
  await writeFile(join(workspace, FAILING_FILE), failing(text));
  await writeFile(join(workspace, LENS_FILE), renamed(text, "lens", "lens-bench", "part-by-lens"));
  await writeEndless(join(workspace, ENDLESS_FILE), renamed(text, "endless", "endless-bench", "part-again"));
  // What a CI job would have left: the failing model's results. It ends with 1, as they do not hold.
  const arguments_ = ["run", FAILING_FILE, "--no-store", "--junit", RESULTS];
  const run = promisify(execFile)(join(dirname(LANGUAGE_SERVER), "robbdd"), arguments_, { cwd: workspace });
  await assert.rejects(run, { code: 1 });
});

step("the view lists the stories of all files before any is opened", async () => {
  await tests.show();
  await tests.row("tidy-bench").first().waitFor();
  await tests.row("no-bench").first().waitFor();
});

step("a file that is written, renamed or deleted changes the tree", async () => {
  const text = (await session.text(FILE)).replace("tidy-bench", "new-bench").replaceAll("criteria/", "created/");
  const [path, moved] = ["new.bdd", "moved.bdd"].map((name) => join(session.workspace, name));
  await writeFile(path, text);
  await tests.row("new-bench").waitFor();
  await rename(path, moved);
  await writeFile(moved, text.replace("new-bench", "moved-bench"));
  await tests.row("moved-bench").waitFor();
  await tests.row("new-bench").waitFor({ state: "detached" });
  await rm(moved);
  await tests.row("moved-bench").waitFor({ state: "detached" });
});

step("a story expands to variants, scenarios and clauses", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor();
  await tests.expand("tidy-bench");
  await tests.expand("part-to-bin");
  await tests.expand("thing = cube0, goal = left_ws");
  await tests.row("Then at-goal").waitFor();
  await tests.row("Given at-source").waitFor();
  await workbench.screenshot("testing-tree");
});

step("the gutter offers to run the variant and each clause", async () => {
  const icons = workbench.page.locator(".editor-group-container.active .testing-run-glyph");
  await icons.nth(4).waitFor();
});

step("running a variant turns its clauses, with their margins", async () => {
  await tests.runRow("part-to-bin");
  await tests.turns("passed", "Then at-goal");
  await tests.turns("passed", "part-to-bin");
  await tests.row(/Then at-goal.*\+\d.*mm/).waitFor();
  await workbench.screenshot("testing-passed");
});

step("a run begun from the code lens shows in the view too", async () => {
  await workbench.openFile(LENS_FILE);
  await tests.expand("lens-bench");
  // The panel with the output of the run before covers the line of the lens.
  await workbench.closePanel();
  const { line } = await session.placeOf(LENS_FILE, "Scenario part-by-lens");
  await workbench.goTo(line, 1);
  await workbench.codeLens("Run").first().click();
  await tests.turns("passed", "part-by-lens");
});

step("a failing clause shows its margin, instant and expected value", async () => {
  await workbench.openFile(FAILING_FILE);
  await tests.expand("no-bench");
  await tests.expand("part-stays");
  await tests.runRow("part-stays");
  await tests.turns("failed", "part-stays");
  await tests.expand("goal = left_ws");
  await tests.rowsThat("failed", /Then at-goal.*−\d.*mm.*at \d+\.\d+ s/).waitFor();
  await tests.rowsThat("passed", "Then in-hand").first().waitFor();
  const { line } = await session.placeOf(FAILING_FILE, "at-goal");
  await workbench.goTo(line, 1);
  const told = /violated\sby\s−\d+.*mm\sat\s\d+\.\d+\ss/;
  const message = workbench.page.locator(".test-error-content-widget", { hasText: told });
  await message.first().waitFor();
  // The message covers the text after the clause, so the verdict is drawn before it.
  assert.equal((await verdictAt(workbench, /^\s*at-goal:/, /^✗/)).side, "before");
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`testing-failed-${scheme}`);
  }
  await message.first().click();
  await workbench.page.locator(".test-output-peek, .peekview-widget").first().waitFor();
  await workbench.screenshot("testing-peek");
  await workbench.page.keyboard.press("Escape");
});

step("only what failed is run again", async () => {
  const { scenarios } = await session.runOf(() => workbench.command("Test: Rerun Failed Tests"));
  assert.deepEqual([...new Set(scenarios.map(({ variant }) => variant.split("/").at(-1)))], ["part-stays"]);
  await tests.rowsThat("run").first().waitFor({ state: "detached" });
  await tests.turns("failed", "part-stays");
  await workbench.screenshot("testing-rerun");
});

step("a run that is cancelled ends", async (context) => {
  const beginning = await timed(async () => {
    await tests.runRow("endless-bench");
    await tests.turns("run", "endless-bench");
  });
  // The ball's own step never ends: its scenario is being executed, not queued.
  await workbench.status.filter({ hasText: "2/4" }).waitFor();
  await tests.turns("run", "endless-bench");
  const ending = await timed(async () => {
    await workbench.page.locator('.part.sidebar [aria-label^="Cancel Test Run"]').first().click();
    await tests.rowsThat("run").first().waitFor({ state: "detached" });
  });
  context.diagnostic(`begun after ${Math.round(beginning)} ms, ended after ${Math.round(ending)} ms`);
  assert.equal(await tests.rowsThat("error").count(), 0, "what was not judged has no result");
  await tests.expand("endless-bench");
  await tests.expand("part-again");
  await tests.turns("passed", "thing = cube0, goal = left_ws");
  // What was not finished has not passed.
  await tests.rowsThat("skipped", "thing = ball0").nth(1).waitFor();
  await workbench.screenshot("testing-cancelled");
  await tests.collapse("endless-bench");
});

step("a continuous run follows each save", async () => {
  await tests.press("part-stays", '[aria-label^="Turn on Continuous Run"]');
  const { line, column } = await session.placeOf(FAILING_FILE, "before <evt-pick-start>)", "at-goal");
  await workbench.focusEditor();
  await workbench.goTo(line, column);
  for (let letter = 0; letter < "before <evt-pick-start>".length; letter += 1) {
    await workbench.page.keyboard.press("Delete");
  }
  await workbench.type("after <evt-place-end>");
  await workbench.page.keyboard.press("Control+S");
  await tests.turns("passed", "part-stays");
  await tests.turns("passed", "Then at-goal");
  await workbench.screenshot("testing-continuous");
});

step("results of CI are imported, and a broken file says where", async () => {
  await importFile(RESULTS);
  await workbench.notification(`2 results of ${RESULTS} are shown`);
  await tests.turns("failed", "part-stays");
  await tests.turns("failed", /Then at-goal.*−\d+ mm/);
  await workbench.screenshot("testing-imported");
  await writeFile(join(session.workspace, BROKEN_RESULTS), '{\n  "scenarios": [,]\n}');
  await importFile(BROKEN_RESULTS);
  await workbench.notification(`${BROKEN_RESULTS}, line 2, column 17`);
});

step("a run that is refused says why at the variant, until it is run again", async () => {
  await rewrite(FAILING_FILE, (text) => text.replace("Given:", "Given"));
  await workbench.waitForError();
  await runsUntil("error");
  await workbench.page.locator(".part.panel", { hasText: /the\smodel\shas\serrors/ }).first().waitFor();
  await workbench.screenshot("testing-refused");
  await rewrite(FAILING_FILE, (text) => text.replace("Given", "Given:"));
  await workbench.waitForNoError();
  await runsUntil("passed");
});

step("after a restart the results of the session before are there", async () => {
  await workbench.reload();
  await tests.show();
  await tests.turns("passed", "no-bench");
  assert.equal(await tests.rowsThat("error").count(), 0, "what the cancelled run left open has no result");
  await workbench.screenshot("testing-restored");
});

/** Run the variant of a file that is being read anew: its row may be replaced between pointing and clicking. */
async function runsUntil(state) {
  await eventually(async () => {
    await tests.runRow("part-stays");
    await tests.rowsThat(state, "part-stays").first().waitFor({ timeout: 3 * TRY });
  });
}

async function rewrite(file, change) {
  const text = await session.text(file);
  const changed = change(text);
  assert.notEqual(changed, text);
  await writeFile(join(session.workspace, file), changed);
}

/** Choose a file of the workspace in the dialog of the import. */
async function importFile(name) {
  await workbench.command("RobBDD: Import Results");
  await workbench.page.locator(".quick-input-list .monaco-list-row", { hasText: name }).click();
}

function failing(text) {
  return renamed(text, "failing", "no-bench", "part-stays")
    .replace("at <goal>, after <evt-place-end>", "at <goal>, before <evt-pick-start>")
    .replace("{ <cubes.cube0>, <balls.ball0> }", "{ <cubes.cube0> }");
}
