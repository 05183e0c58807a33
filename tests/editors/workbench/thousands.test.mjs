// A variant of thousands of scenarios in the Testing view: the first are there at once, the others as they are asked for.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { EXAMPLES } from "./harness/checkout.mjs";
import { TRY, eventually, timed } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { TestingView } from "./harness/testingView.mjs";

/** A multiple of four: for each part, two sources and two goals. */
const COUNT = Number(process.env.ROBBDD_SCENARIOS ?? 5000);

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
    await change("bench.scene", "count: 2", `count: ${COUNT / 4}`);
    await change("pickplace.bdd", "{ <cubes.cube0>, <balls.ball0> }", "obj set <cubes>");
    await change("pickplace.bdd", "{ <places.table_ws> }", "{ <places.table_ws>, <places.right_ws> }");
  },
});

step("the first scenarios are listed at once, with what lists more", async () => {
  await tests.show();
  await tests.expand("tidy-bench");
  await tests.row(new RegExp(`part-to-bin.*${COUNT.toLocaleString("en")} scenarios`)).waitFor();
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
