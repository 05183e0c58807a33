// A variant of thousands of scenarios in the Testing view: the first are there at once, the others as they are asked for.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { EXAMPLES } from "./harness/checkout.mjs";
import { execute } from "./harness/models.mjs";
import { TRY, eventually, timed } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { TestingView } from "./harness/testingView.mjs";
import { verdictAt } from "./harness/verdicts.mjs";

/** A multiple of four: for each part, two sources and two goals. */
const COUNT = Number(process.env.ROBBDD_SCENARIOS ?? 5000);

/** Letters that are typed to measure the time from a key to its frame. */
const LETTERS = 40;

/** Where they are typed: at the end of an event's name in a clause. */
let place = { line: 0, column: 0 };
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** @type {TestingView} */
let tests;

const step = story("thousands", (opened) => {
  workbench = opened.workbench;
  tests = new TestingView(workbench);
}, {
  workspace: join(EXAMPLES, "pickplace"),
  prepare: async (workspace) => {
    const change = async (name, old, fresh) => {
      const path = join(workspace, name);
      const text = await readFile(path, "utf8");
      assert.ok(text.includes(old));
      await writeFile(path, text.replace(old, fresh));
    };
    const path = join(workspace, "pickplace.bdd");
    // So many cubes fit on no table.
    await execute(path, "thing = cube0 and goal = left_ws", /1 hold/);
    await change("bench.scene", "count: 2", `count: ${COUNT / 4}`);
    await change("pickplace.bdd", "{ <cubes.cube0>, <balls.ball0> }", "obj set <cubes>");
    await change("pickplace.bdd", "{ <places.table_ws> }", "{ <places.table_ws>, <places.right_ws> }");
    const text = await readFile(path, "utf8");
    await writeFile(join(workspace, "plain.txt"), text);
    const lines = text.split("\n");
    const line = lines.findIndex((entry) => entry.includes("at-goal:"));
    place = { line: line + 1, column: lines[line].indexOf("evt-place-end") + "evt-place-end".length + 1 };
  },
});

step("the first scenarios are listed at once, with what lists more", async () => {
  await tests.show();
  await tests.expand("tidy-bench");
  await tests.row(new RegExp(`part-to-bin.*1 of ${COUNT.toLocaleString("en")} executed, 1 passed`)).waitFor();
  await told("the first", async () => {
    await tests.expand("part-to-bin");
    await tests.row("scenario 1,").first().waitFor();
  });
});

for (const [first, last] of [[201, 400], [401, 800], [801, 1600]]) {
  const words = (number) => number.toLocaleString("en");
  step(`scenarios ${first} to ${last} are listed when they are asked for`, async () => {
    const more = tests.row(`More: ${words(first)} to ${words(last)}`);
    await atTheEnd(more);
    await told(`${first} to ${last}`, async () => {
      await more.click();
      await workbench.page.keyboard.press("ArrowRight");
      await more.waitFor({ state: "detached" });
    });
  });
}

step("the rows end with an item for unlisted scenarios", async () => {
  await atTheEnd(tests.row(/More: 1,601 to 3,200/));
  await tests.row("scenario 1600,").waitFor();
  await workbench.screenshot("testing-thousands");
});

step("a key shows its letter about as soon as in plain text, with hints, verdicts and the Testing view", async () => {
  const plain = await typed("plain.txt");
  await workbench.openFile("pickplace.bdd");
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.goTo(place.line, 1);
  await verdictAt(workbench, /./, /changed since the run/);
  const model = await typed("pickplace.bdd");
  await workbench.waitForError();
  await workbench.screenshot("typing");
  console.log(`key to frame: ${words(model)} in the model, ${words(plain)} in plain text, ratio ${(model.median / plain.median).toFixed(2)}`);
});

/**
 * Type letters at the end of a name, and measure the time from each key to the frame after it, ms. The window computes
 * nothing else between two keys: each waits for the frame of the one before.
 */
async function typed(file) {
  await workbench.openFile(file);
  await workbench.goTo(place.line, place.column);
  await workbench.page.evaluate(() => {
    globalThis.keyTimes = [];
    const after = ({ timeStamp }) => {
      requestAnimationFrame(() => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => globalThis.keyTimes.push(performance.now() - timeStamp);
        port2.postMessage(undefined);
      });
    };
    globalThis.stopTiming = () => document.removeEventListener("keydown", after, true);
    document.addEventListener("keydown", after, true);
  });
  for (let letter = 0; letter < LETTERS; letter += 1) {
    await workbench.page.keyboard.press("x");
    await workbench.page.waitForFunction((count) => globalThis.keyTimes.length >= count, letter + 1);
  }
  await workbench.lines("x".repeat(LETTERS)).waitFor();
  const times = await workbench.page.evaluate(() => {
    globalThis.stopTiming();
    return globalThis.keyTimes.slice(5).sort((one, other) => one - other);
  });
  return { median: times[Math.floor(times.length / 2)], p95: times[Math.floor(times.length * 0.95)] };
}

function words({ median, p95 }) {
  return `p50 ${median.toFixed(1)}, p95 ${p95.toFixed(1)} ms`;
}

/** Go to the last row, which is this when all have come. */
async function atTheEnd(row) {
  await eventually(async () => {
    await workbench.page.keyboard.press("End");
    await row.waitFor({ timeout: TRY });
  });
}

/** Tell how long something took. */
async function told(name, task) {
  console.log(`${name} of ${COUNT} scenarios: ${Math.round(await timed(task))} ms`);
}
