// The results of a stored run over its variations: a heat map and margins, which lead to the replay of each execution.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { accessibleInContrast, accessibleInEach } from "./harness/axe.mjs";
import { execute, study } from "./harness/models.mjs";
import { LONG, eventually, timed } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";

const FILE = "tworobots/heights.bdd";
const STUDY = "tworobots/heights.study";
/** The scenarios of one scale, one of which fails, as a study. */
const STUDY_TEXT = 'import "heights.bdd"\n\nStudy heights {\n    where: "scale = 1.1"\n    seed: 1\n}\n';

/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;

/** @type {import("./harness/session.mjs").Session} */
let session;

const step = story("study", (opened) => {
  session = opened;
  ({ workbench } = opened);
}, { prepare: run });

step("a heat map counts what passed, with intervals, and a cell lists its executions, the worst first", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.command("RobBDD: Show Study…");
  await workbench.pick("Run 1");
  const page = workbench.webview("Study");
  await page.getByRole("heading", { name: "3 hold, 1 violated" }).waitFor();
  const cells = page.locator(".map td");
  await eventually(async () => assert.deepEqual(await cells.allTextContents(), ["1/121–100 %", "1/121–100 %", "1/121–100 %", "0/10–79 %"]));
  await page.getByRole("button", { name: "What does not hold" }).press("Enter");
  await page.getByRole("heading", { name: "Do not hold: 1 execution" }).waitFor();
  await page.locator(".executions tr:has(td)", { hasText: /part = ball, robot = ur10.*✗ violated/ }).getByRole("button", { name: /^Replay/ }).and(page.locator(":focus")).waitFor();
  await page.getByLabel("What is counted").selectOption({ label: "at-goal" });
  await page.locator("td", { hasText: /^0\/10–79 %worst −/ }).waitFor();
  await page.locator(".margins rect.violated").first().waitFor();
  await accessibleInEach(workbench, page, "study");
  await page.locator(".map td button").last().click();
  const [listed] = await page.locator(".executions tr:has(td)").all();
  assert.match(await listed.textContent(), /part = ball, robot = ur10.*✗ violated−3\d/);
  await workbench.screenshot("study-executions");
  await listed.getByRole("button", { name: /^Replay/ }).press("Enter");
  await workbench.page.locator(".tab.active", { hasText: "Replay bin-heights" }).waitFor();
  await workbench.webview("Replay").locator(".row.chosen", { hasText: "at-goal" }).waitFor();
});

step("a matrix has the verdicts of all clauses in thousands of executions, for the keyboard", async () => {
  await workbench.openFile(FILE);
  await workbench.command("RobBDD: Show Matrix of Verdicts…");
  await workbench.pick("Run 1");
  const page = workbench.webview("Study");
  const grid = page.getByRole("grid");
  await eventually(async () => assert.equal(await grid.getAttribute("aria-rowcount"), "5"));
  assert.equal(await page.locator(".line .violated").count(), 3, "two clauses of one execution, and the execution");
  await accessibleInEach(workbench, page, "matrix");
  // As after a run of 1,680 scenarios of 40 clauses: scenario n violates clause n modulo 97, if there is one.
  const shown = await timed(() => page.locator("body").evaluate((body, [rows, columns]) => {
    const texts = Array.from({ length: columns }, (_, number) => ({ iri: `e:c${number}`, name: `clause-${number}`, role: "then", sentence: "", unit: "m" }));
    const scenarios = Array.from({ length: rows }, (_, row) => ({
      variant: "e:v",
      name: `e:v -- ${row + 1}`,
      values: { "e:seed": row, "e:robot": row % 2 ? "e:panda" : "e:ur10" },
      verdict: row % 97 < columns ? "violated" : "holds",
      judged: texts.map((_, column) => (row % 97 === column ? [column, "violated", -row / 1e4] : [column, "holds", 0.01])),
    }));
    window.postMessage({ type: "results", studied: { uri: "file:///none.bdd", run: 1 }, title: "Run 1", results: { texts, scenarios }, show: "matrix" });
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  }, [1680, 40]));
  await eventually(async () => assert.equal(await grid.getAttribute("aria-rowcount"), "1681"));
  assert.ok((await page.locator(".cell").count()) < 2500, "only what is in sight is on the page");
  await grid.focus();
  await workbench.page.keyboard.press("Control+End");
  await page.locator(".cell.active[data-row='1679'][data-column='41']").waitFor();
  await page.locator(".cellwords", { hasText: "clause-39: holds by +10.0 mm · seed = 1679, robot = panda" }).waitFor();
  await workbench.page.keyboard.press("Control+Home");
  await workbench.page.keyboard.press("ArrowRight");
  await workbench.page.keyboard.press("ArrowRight");
  await workbench.page.keyboard.press("ArrowUp");
  const sorted = await timed(async () => {
    await workbench.page.keyboard.press("Enter");
    await page.locator("[role=columnheader][aria-sort=ascending]", { hasText: "clause-0" }).waitFor();
  });
  await page.locator(".line [role=rowheader]", { hasText: "seed = 1649," }).waitFor();
  await page.getByLabel("Filter by values").fill("robot = panda");
  await page.locator(".count", { hasText: "840 of 1680 shown" }).waitFor();
  console.log(`1,680 executions of 40 clauses: shown after ${Math.round(shown)} ms, sorted after ${Math.round(sorted)} ms`);
  await workbench.screenshot("matrix-thousands");
});

step("the history of a clause lists its runs, and two of them are compared", async () => {
  await workbench.openFile(FILE);
  const lines = (await session.text(FILE)).split("\n");
  await workbench.goTo(lines.findIndex((line) => line.includes("at-goal: holds(")) + 1, 20);
  await workbench.page.keyboard.press("Control+K");
  await workbench.page.keyboard.press("Alt+H");
  const history = workbench.webview("History of at-goal");
  await history.getByRole("heading", { name: "at-goal: holds in 0 of 2 runs" }).waitFor();
  await eventually(async () => assert.deepEqual(await history.locator("td.verdict").allTextContents(), ["✗ 0/1", "✗ 3/4"]));
  await noneCut(history);
  await history.locator("tr.stale", { hasText: "the clause has changed since" }).waitFor();
  await accessibleInEach(workbench, history, "history");
  await history.getByRole("button", { name: /Show which executions flipped/ }).click();
  const comparison = workbench.webview("Run 1 → 2");
  await comparison.getByRole("heading", { name: "Run 1 → run 2: 1 flipped, 0 the same, 3 only in run 1" }).waitFor();
  await comparison.getByText("the model has changed").waitFor();
  await comparison.getByText(/^at-goal ✔ → ✗ \(\+.* → −.*\)/).waitFor();
  await noneCut(comparison);
  await accessibleInEach(workbench, comparison, "comparison");
  await accessibleInContrast(session, comparison, "comparison");
  await comparison.getByRole("button", { name: "Replay run 1 and run 2 next to each other" }).click();
  await workbench.page.locator(".tab", { hasText: /Replay bin-heights.*\(run 1\)/ }).waitFor();
  await workbench.page.locator(".tab.active", { hasText: "(run 2)" }).waitFor();
});

step("the executions of a study of the command line are listed, and one that does not hold is executed again to replay it", async () => {
  await workbench.command("View: Close All Editors");
  await workbench.openFile(STUDY);
  await workbench.codeLens("Show executions").first().click();
  const page = workbench.webview("Study heights");
  await page.getByRole("heading", { name: "Study heights: 3 hold, 1 violated" }).waitFor();
  await page.getByRole("button", { name: "What does not hold" }).press("Enter");
  await page.getByRole("heading", { name: "Do not hold: 1 execution" }).waitFor();
  await accessibleInEach(workbench, page, "study-file");
  await accessibleInContrast(session, page, "study-file");
  const replay = page.locator(".executions").getByRole("button", { name: /^Replay/ });
  await replay.press("Enter");
  const tab = workbench.page.locator(".tab.active", { hasText: "Replay bin-heights" });
  await tab.waitFor({ timeout: LONG });
  assert.match(await session.text("tworobots/.robbdd/studies/heights.study/runs/1/study.json"), /^\[\d\]/);
  await workbench.screenshot("study-file-replayed");
  // Now there is a recording, which is shown at once.
  await workbench.page.locator(".tab", { hasText: "Study heights" }).click();
  await page.getByRole("button", { name: "What does not hold" }).press("Enter");
  await replay.press("Enter");
  await tab.waitFor();
  assert.equal(await workbench.page.locator(".tab", { hasText: "Replay bin-heights" }).count(), 1);
});

/** Assert that a page in a narrow column shows all of its words. */
async function noneCut(page) {
  await eventually(async () => {
    const cut = await page.locator("h1, li, td, th, td button, p").evaluateAll((elements) => {
      return elements.filter((one) => one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.textContent);
    });
    assert.deepEqual(cut, []);
  });
}

/**
 * Execute four scenarios, one of which fails: the ball under the suction cup hits the rim of the bin. Then execute one
 * that holds again, with a clause that expects the part in the bin too early.
 */
async function run(workspace) {
  const path = join(workspace, FILE);
  await execute(path, 'scale = "1.1"', /3 hold, 1 violated/);
  const text = await readFile(path, "utf8");
  await writeFile(path, text.replace("<goal>, after <evt-place-end>", "<goal>, after <evt-pick-end>"));
  await execute(path, 'scale = "1.1" and robot = panda and part = cube', /1 violated/);
  await writeFile(path, text);
  await writeFile(join(workspace, STUDY), STUDY_TEXT);
  await study(join(workspace, STUDY), /3 of 4 hold/);
}
