// The Testing view: its tree, runs begun in it and elsewhere, a failing clause, running again, cancelling, runs on save.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "pickplace.bdd";
/** A clause of it says that the part is where it was: that does not hold once it is in the bin. */
const FAILING_FILE = "failing.bdd";
const RUN_LIMIT = 3 * 60_000;
/** What a user may wait for a cancelled run, ms: half a second, and what this driver takes to look. */
const CANCEL_LIMIT = 1500;

/** @type {Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
let failed;

/** A step of the one story that this file tells; a later step stands on the earlier ones. */
function step(name, body) {
  test(name, async () => {
    assert.equal(failed, undefined, `the step before failed: ${failed}`);
    try {
      await body();
    } catch (error) {
      failed = name;
      throw error;
    }
  });
}

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({
    workspace: join(EXAMPLES, "pickplace"),
    settings: { "robbdd.server.path": server, "testing.automaticallyOpenPeekView": "never" },
    prepare: async (workspace) => {
      const text = await readFile(join(workspace, FILE), "utf8");
      await writeFile(join(workspace, FAILING_FILE), failing(text));
    },
  });
  workbench = session.workbench;
});

after(async () => {
  await session?.close(failed === undefined ? undefined : "testing-failed");
});

/** A row of the tree by its words. */
function row(text) {
  return workbench.page.locator(".test-explorer-tree .monaco-list-row", { hasText: text });
}

/** The rows that show a state: `passed`, `failed`, `error`, `queued` or `run`. */
function rowsThat(state, text = /./) {
  const icon = workbench.page.locator(`.codicon-testing-${state}-icon`);
  return row(text).filter({ has: icon });
}

async function expand(text) {
  const found = row(text).first();
  await found.waitFor();
  if ((await found.getAttribute("aria-expanded")) === "false") {
    await found.click();
    await workbench.page.keyboard.press("ArrowRight");
    await workbench.page.locator('.monaco-list-row[aria-expanded="true"]', { hasText: text }).first().waitFor();
  }
}

async function runRow(text) {
  await row(text).first().hover();
  await row(text).first().locator(".codicon-testing-run-icon").first().click();
}

step("the view lists the stories of all files, opened or not", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor();
  await workbench.page.locator('.activitybar .action-label[aria-label^="Testing"]').click();
  await row("tidy-bench").first().waitFor();
  await row("no-bench").first().waitFor();
});

step("a story expands to variants, scenarios and clauses", async () => {
  await expand("tidy-bench");
  await expand("part-to-bin");
  await expand("thing = cube0, goal = left_ws");
  await row("Then at-goal").waitFor();
  await row("Given at-source").waitFor();
  await workbench.screenshot("testing-tree");
});

step("the gutter offers to run the variant and each clause", async () => {
  const icons = workbench.page.locator(".editor-group-container.active .testing-run-glyph");
  await icons.first().waitFor();
  assert.ok((await icons.count()) >= 5, `${await icons.count()} icons`);
});

step("running a variant turns its clauses, with their margins", async () => {
  await runRow("part-to-bin");
  await rowsThat("passed", "Then at-goal").waitFor({ timeout: RUN_LIMIT });
  await rowsThat("passed", /part-to-bin/).first().waitFor({ timeout: RUN_LIMIT });
  await row(/Then at-goal.*\+\d.*mm/).waitFor();
  await workbench.screenshot("testing-passed");
});

function failing(text) {
  return text
    .replace("https://example.org/robbdd/criteria/", "https://example.org/robbdd/failing/")
    .replace("tidy-bench", "no-bench")
    .replace("part-to-bin", "part-stays")
    .replace("at-goal: holds(<thing> is located at <goal>", "at-goal: holds(<thing> is located at <source>")
    .replace("{ <cubes.cube0>, <balls.ball0> }", "{ <cubes.cube0> }");
}
