// The example as its reader meets it: no complaint, a mistake is marked and goes again, a run puts verdicts beside clauses.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";
import { PATIENCE, SCHEMES } from "./harness/workbench.mjs";

const FILE = "pickplace/pickplace.bdd";
const RUN_LIMIT = 5 * 60_000;

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
  session = await Session.open({ workspace: EXAMPLES, settings: { "robbdd.server.path": server } });
  workbench = session.workbench;
});

after(async () => {
  await session?.close(failed === undefined ? undefined : "example-failed");
});

step("the example opens without an error", async () => {
  await workbench.openFile(FILE);
  // The code lens is the sign that the server has understood the file.
  await workbench.codeLens("Run").first().waitFor();
  assert.equal(await workbench.errors.count(), 0);
  const problems = await workbench.openProblems();
  await problems.getByText("No problems have been detected").waitFor();
  await workbench.closePanel();
});

step("a broken name is underlined and stands in the Problems view", async () => {
  const { line, column, name } = await firstReference();
  await workbench.goTo(line, column);
  await workbench.type("x");
  await workbench.waitForError();
  await (await workbench.problem(`x${name}`)).first().waitFor();
  await workbench.screenshot("example-mistake");
});

step("undoing the mistake takes both away", async () => {
  await workbench.focusEditor();
  await workbench.undo();
  await workbench.waitForNoError();
  const problems = await workbench.openProblems();
  await problems.getByText("No problems have been detected").waitFor();
  await workbench.closePanel();
});

step("the Run code lens puts a verdict at every clause", async () => {
  await workbench.codeLens("Run").first().click();
  await workbench.statusText(/RobBDD \d+\/\d+/);
  await workbench.statusText(/RobBDD$/, RUN_LIMIT);
  const clauses = workbench.lines("holds(");
  const count = await clauses.count();
  assert.ok(count > 0);
  for (let index = 0; index < count; index += 1) {
    await clauses.nth(index).filter({ hasText: /[✔✗]/ }).waitFor({ timeout: PATIENCE });
  }
});

step("the run is told in the output channel, with its summary at the end", async () => {
  await workbench.command("RobBDD: Show Runs");
  const output = workbench.page.locator(".output-view-container .view-lines, .output-view .view-lines").first();
  await output.filter({ hasText: /scenarios? passed/ }).waitFor();
  await workbench.closePanel();
});

step("the verdicts can be read in a dark and in a light theme", async () => {
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    const [hint, ground] = await workbench.verdictColours();
    assert.notEqual(hint, ground);
    await workbench.screenshot(`example-${scheme}`);
  }
});

step("the Gherkin code lens opens the feature that it wrote", async () => {
  await workbench.codeLens("Gherkin").first().click();
  await workbench.page.locator('.tab.active[data-resource-name$=".feature"]').waitFor();
  await workbench.lines("Scenario").first().waitFor();
});

/** Where the name of the first reference to an event stands in the example: line and column from 1. */
async function firstReference() {
  const lines = (await session.text(FILE)).split("\n");
  for (const [index, text] of lines.entries()) {
    const match = /until <(?<name>[\w-]+)>/.exec(text);
    if (match !== null) {
      return { line: index + 1, column: text.indexOf("<", match.index) + 2, name: match.groups.name };
    }
  }
  throw new Error(`${FILE} has no reference behind "until"`);
}
