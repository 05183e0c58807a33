// Failures of different kinds: the cause of each can be read beside its clause, without a click.
import assert from "node:assert/strict";
import { SAMPLES } from "./harness/checkout.mjs";
import { EXECUTIONS, FAILURES, writeFailures } from "./harness/failures.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { TestingView } from "./harness/testingView.mjs";
import { verdictAt } from "./harness/verdicts.mjs";
import { EDITOR } from "./harness/workbench.mjs";

/** Prefixes, addresses and generated names are for machines. */
const FOR_MACHINES = /https?:|\b(?:env|t|t-\d+|sim|exec):\w|when-bhv|\.then\.|!=/;

/** The verdict of each scenario in the stored run, by its name. @type {Map<string, string>} */
let verdicts;
/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;

const step = story("causes", (opened) => {
  session = opened;
  workbench = opened.workbench;
}, {
  workspace: SAMPLES,
  settings: { "testing.automaticallyOpenPeekView": "never" },
  prepare: writeFailures,
});

step("executions that fail for different reasons run to their end", async () => {
  await workbench.openFile(EXECUTIONS);
  const { scenarios } = await session.runOf(() => workbench.command("RobBDD: Run Scenarios of This File"));
  assert.equal(scenarios.length, Object.keys(FAILURES).length);
  assert.deepEqual(scenarios.filter(({ verdict }) => verdict === "holds").map(({ name }) => name), []);
  verdicts = new Map(scenarios.map(({ name, verdict }) => [name.split(/[:/#]| -- /).at(-2), verdict]));
  await workbench.changeScheme("dark");
});

step("what has failed and what has an error is the same in the Testing view as in the results", async () => {
  const tests = new TestingView(workbench);
  await tests.show();
  await tests.expand(EXECUTIONS);
  for (const name of Object.keys(FAILURES)) {
    // A row has its label, then its description.
    await tests.turns(verdicts.get(name) === "violated" ? "failed" : "error", `run-${name}${name}-story.${name}`);
  }
  assert.deepEqual([...new Set(verdicts.values())].sort(), ["unknown", "violated"]);
  await workbench.screenshot("causes-tests");
});

for (const [name, { line, cause, margin }] of Object.entries(FAILURES)) {
  step(`${name}: the cause is in sight, at the line of its clause`, async () => {
    await workbench.openFile(`${name}.bdd`);
    await verdictAt(workbench, line, margin ?? new RegExp(cause.source.slice(1).replace(/ \\\(.*/, "")));
    await eventually(async () => {
      // The editor does not always draw the message of a test, and only the part that has room.
      const [message, ...others] = (await workbench.page.evaluate(messages, EDITOR)).filter(({ cut }) => !cut);
      if (message !== undefined) {
        assert.match(message.text, cause, "the cause comes first");
        assert.doesNotMatch(message.text, FOR_MACHINES);
        assert.match(message.line, line);
        assert.deepEqual(others, [], "consequences have no message of their own");
      }
    });
    await workbench.screenshot(`causes-${name}`);
  });
}

step("they can be read in light colours, too", async () => {
  await workbench.changeScheme("light");
  await workbench.openFile("unreachable.bdd");
  await verdictAt(workbench, FAILURES.unreachable.line, /panda cannot reach/);
  const { words, side } = await verdictAt(workbench, /placed:/, /because/);
  assert.deepEqual([words, side], ["? because of the behaviour", "after"]);
  await workbench.screenshot("causes-unreachable-light");
});

/** Runs in the page: the messages in an editor, each with the text of its line, and whether its end is out of sight. */
function messages(editor) {
  const plain = (element) => element.textContent.replaceAll("\u00a0", " ");
  const edge = document.querySelector(editor).getBoundingClientRect().right;
  return [...document.querySelectorAll(`${editor} .test-error-content-widget`)].map((widget) => {
    const { top, bottom, right } = widget.getBoundingClientRect();
    // An ellipsis is drawn where the text is wider than its box; a reader needs the first words of a cause.
    const boxes = [widget, ...widget.querySelectorAll("*")].filter(({ clientWidth }) => clientWidth > 0);
    const share = Math.min(1, ...boxes.map(({ clientWidth, scrollWidth }) => clientWidth / scrollWidth));
    const { length } = plain(widget);
    const shortened = length * share < Math.min(length, 30);
    const line = [...document.querySelectorAll(`${editor} .view-line`)].find((one) => {
      const place = one.getBoundingClientRect();
      return place.top < (top + bottom) / 2 && (top + bottom) / 2 < place.bottom;
    });
    return { text: plain(widget), line: line === undefined ? "" : plain(line), cut: right > edge || shortened };
  });
}
