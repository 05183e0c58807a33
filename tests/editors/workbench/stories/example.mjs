// The example as its reader meets it: no finding, a mistake is marked and unmarked, a run shows verdicts at clauses.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { contrast } from "../harness/contrast.mjs";
import { writeEndless } from "../harness/models.mjs";
import { LONG, eventually } from "../harness/patience.mjs";
import { story } from "../harness/story.mjs";
import { themeColour, verdictAt } from "../harness/verdicts.mjs";
import { SCHEMES } from "../harness/workbench.mjs";

const FILE = "pickplace/pickplace.bdd";
/** The example, but that its run lasts until it is cancelled. */
const ENDLESS_FILE = "pickplace/endless.bdd";
/** What WCAG 2 asks of text. */
const READABLE = 4.5;

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function example(window) {
  const step = story("example", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, {
    window,
    prepare: async (workspace) => {
      await writeEndless(join(workspace, ENDLESS_FILE), await readFile(join(workspace, FILE), "utf8"));
    },
  });

  step("the example opens without an error", async () => {
    await workbench.openFile(FILE);
    // The code lens is the sign that the server has understood the file.
    await workbench.codeLens("Run").first().waitFor();
    await workbench.waitForNoError();
    const problems = await workbench.openProblems();
    await problems.getByText("No problems have been detected").waitFor();
    await workbench.closePanel();
  });

  step("a broken name is underlined and listed in the Problems view", async () => {
    const { line, column } = await session.placeOf(FILE, "evt-end>", "until <");
    await workbench.goTo(line, column);
    await workbench.type("x");
    await workbench.waitForError();
    await (await workbench.problem("xevt-end")).first().waitFor();
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
    const clauses = await workbench.lines("holds(").allTextContents();
    assert.ok(clauses.length > 0);
    for (const text of clauses) {
      const [name] = /\S+:/.exec(text);
      await verdictAt(workbench, new RegExp(name), /^[✔✗]/, { timeout: LONG });
    }
  });

  step("the run is told in the output channel, with its summary at the end", async () => {
    await workbench.command("RobBDD: Show Runs");
    const output = workbench.page.locator(".part.panel .view-lines");
    await output.filter({ hasText: /\d+\sof\s\d+\sscenarios\spassed/ }).waitFor({ timeout: LONG });
    await workbench.statusText(/RobBDD$/);
    await workbench.screenshot("example-runs");
    await workbench.closePanel();
  });

  step("the verdicts can be read in a dark and in a light theme", async () => {
    for (const scheme of Object.keys(SCHEMES)) {
      await workbench.changeScheme(scheme);
      await eventually(async () => {
        const { colour, ground } = await verdictAt(workbench, /holds\(/, /^✔/);
        assert.equal(colour, await themeColour(workbench, "robbdd.holdsForeground"));
        assert.ok(contrast(colour, ground) >= READABLE, `${scheme}: ${colour} on ${ground}`);
      });
      await workbench.screenshot(`example-${scheme}`);
    }
  });

  step("the Gherkin code lens opens the feature that it wrote", async () => {
    await workbench.codeLens("Gherkin").first().click();
    await workbench.page.locator('.tab.active[data-resource-name$=".feature"]').waitFor();
    await workbench.lines("Scenario").first().waitFor();
  });

  step("a run can be cancelled, and says that it is not complete", async () => {
    await workbench.openFile(ENDLESS_FILE);
    await workbench.codeLens("Run").first().waitFor();
    await workbench.command("RobBDD: Run Scenarios of This File");
    await workbench.statusText(/RobBDD \d+\/\d+/);
    await workbench.command("RobBDD: Cancel Run");
    await workbench.statusText(/RobBDD$/);
    await workbench.command("RobBDD: Show Runs");
    const output = workbench.page.locator(".part.panel .view-lines");
    await output.filter({ hasText: /endless\.bdd:\s\d+\sof\s\d+\sscenarios\spassed.*not\sfinished/ }).waitFor();
  });

  step("a restarted server marks mistakes again", async () => {
    await workbench.command("RobBDD: Restart Language Server");
    await workbench.command("RobBDD: Show Log");
    // The old server is gone: whatever is marked from here on, the new one has marked. On a busy machine its time to end by
    // itself may run out, so that it is ended by force.
    const output = workbench.page.locator(".part.panel .view-lines");
    await output.filter({ hasText: /Server\sprocess\sexited/ }).waitFor();
    await workbench.focusEditor();
    await workbench.goTo(1, 1);
    await workbench.type("import 'no-such.scene' ");
    await (await workbench.problem("no-such.scene")).first().waitFor();
  });
}
