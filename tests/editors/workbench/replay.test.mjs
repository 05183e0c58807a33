// A recorded execution: played in three dimensions over a time line of events and clauses; without WebGL the time line alone.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

const FILE = "tworobots/heights.bdd";
/** The ball hangs below the suction cup, lower than the rim of the tallest bin. */
const FAILS = 'part = ball and robot = ur10 and scale = "1.1"';

/** @type {Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** The page of the replay. */
let page;
let failed;

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

const open = async (webgl) => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({ workspace: EXAMPLES, settings: { "robbdd.server.path": server }, webgl, prepare: run });
  workbench = session.workbench;
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.command("RobBDD: Show Replay…");
  page = workbench.webview();
  await page.locator(".row").first().waitFor();
};

before(() => open(true));

after(async () => {
  await session?.close(failed === undefined ? undefined : "replay-failed");
});

step("the only stored execution is shown at its violation, in three dimensions", async () => {
  await page.locator(".stage canvas").waitFor();
  await page.locator(".label", { hasText: "ball" }).waitFor();
  assert.match(await page.locator(".title").textContent(), /ball/);
  const clause = page.locator(".row.chosen");
  await clause.locator(".sign.violated").waitFor();
  assert.ok((await time()) > 0);
  assert.match(await page.locator(".caption").textContent(), /violated by −/);
  assert.ok((await page.locator(".tracks text.event").count()) >= 4);
  assert.ok(await painted(), "the scene has been drawn");
});

step("the time line can be read in a dark and in a light theme", async () => {
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    await workbench.screenshot(`replay-${scheme}`);
  }
});

step("the keyboard plays, stops and steps", async () => {
  await page.locator(".stage").press("Home");
  assert.equal(await time(), 0);
  await page.locator(".stage").press("Space");
  await page.getByRole("button", { name: "Play or pause" }).filter({ hasText: "⏸" }).waitFor();
  await page.locator(".readout").filter({ hasText: /^0\.[2-9]|^[1-9]/ }).waitFor();
  await page.locator(".stage").press("Space");
  const stopped = await time();
  await page.locator(".row .name").first().press("ArrowRight");
  assert.ok((await time()) > stopped);
  await page.locator(".stage").press("v");
  assert.ok((await time()) > stopped);
});

step("what moves is somewhere else at another time", async () => {
  const label = page.locator(".label", { hasText: "ball" });
  const place = () => label.getAttribute("style");
  await page.locator(".stage").press("End");
  await drawn();
  const end = await place();
  await page.locator(".stage").press("Home");
  await drawn();
  assert.notEqual(await place(), end);
});

step("pressing the time line goes there", async () => {
  const { x, y, width } = await page.locator(".tracks").boundingBox();
  await workbench.page.mouse.click(x + width / 2, y + 60);
  const duration = Number.parseFloat((await page.locator(".readout").textContent()).split("/")[1]);
  assert.ok(Math.abs((await time()) - duration / 2) < duration / 20);
});

step("a clause is chosen by its name, and leads to its text", async () => {
  await page.locator(".row .name", { hasText: "in-hand" }).click();
  await page.locator(".caption .sentence", { hasText: "is held by" }).waitFor();
  await page.getByRole("button", { name: "Go to the text of in-hand" }).click();
  const line = (await session.text(FILE)).split("\n").findIndex((text) => text.includes("in-hand:")) + 1;
  await workbench.page.locator(".statusbar-item", { hasText: new RegExp(`Ln ${line}, Col`) }).waitFor();
});

step("a recording of another text says so", async () => {
  const lines = (await session.text(FILE)).split("\n");
  const line = lines.findIndex((text) => text.includes("at-goal: holds("));
  await workbench.command("View: Focus First Editor Group");
  await workbench.goTo(line + 1, lines[line].lastIndexOf("evt-place-end") + 1);
  for (let letter = 0; letter < "evt-place-end".length; letter += 1) {
    await workbench.page.keyboard.press("Delete");
  }
  await workbench.page.keyboard.insertText("evt-end");
  await workbench.page.keyboard.press("Control+S");
  await workbench.command("RobBDD: Show Replay…");
  await page.getByText("The model has been edited since: at-goal reads otherwise").waitFor();
  await workbench.screenshot("replay-stale");
});

step("the panel comes back with the window", async () => {
  await workbench.reload();
  page = workbench.webview();
  await page.locator(".label", { hasText: "ball" }).waitFor();
});

step("without WebGL the page says so, and the time line works", async () => {
  await session.close();
  await open(false);
  await page.getByText("WebGL is missing").waitFor();
  await page.locator(".row .name").first().press("Home");
  assert.equal(await time(), 0);
  await page.getByRole("button", { name: "Go to the violation" }).click();
  assert.ok((await time()) > 0);
  await workbench.screenshot("replay-without-webgl");
});

/** Execute one scenario that fails, and keep it. */
async function run(workspace) {
  const robbdd = join(dirname(LANGUAGE_SERVER), "robbdd");
  const { stdout } = await promisify(execFile)(robbdd, ["run", join(workspace, FILE), "--where", FAILS]).catch((error) => error);
  assert.match(stdout, /1 violated/);
}

async function time() {
  return Number.parseFloat(await page.locator(".readout").textContent());
}

/** Wait until the screen has shown what was asked for. */
function drawn() {
  return page
    .locator(".stage")
    .evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** Whether the picture of the scene has more than one colour. */
async function painted() {
  const picture = await page.locator(".stage").screenshot();
  return picture.length > 10_000;
}
