// A recorded execution: played in 3D over a timeline of events and clauses; without WebGL only the timeline.
import assert from "node:assert/strict";
import { join } from "node:path";
import { describe } from "node:test";
import { accessibleInContrast, accessibleInEach } from "./harness/axe.mjs";
import { execute } from "./harness/models.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";

const FILE = "tworobots/heights.bdd";
const CELL = "ownrobot/cell.scenex";
/** The ball hangs below the suction cup, lower than the rim of the tallest bin. */
const FAILS = 'part = ball and robot = ur10 and scale = "1.1"';

/** @type {import("./harness/session.mjs").Session} */
let session;
/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** The page of the replay. */
let page;

/** A story about the replay of the only stored execution. */
function replayed(name, webgl) {
  const step = story(name, (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, { webgl, prepare: (workspace) => execute(join(workspace, FILE), FAILS, /1 violated/) });
  step("the command shows the replay", async () => {
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().waitFor({ state: "attached" });
    await workbench.command("RobBDD: Show Replay…");
    page = workbench.webview("Replay");
    await page.locator(".row").first().waitFor();
  });
  return step;
}

describe("with three dimensions", () => {
  const step = replayed("replay", true);

  step("the only stored execution is shown at its violation, in three dimensions", async () => {
    await page.locator(".stage canvas").waitFor();
    await page.locator(".label", { hasText: "ball" }).waitFor();
    await page.locator(".title", { hasText: "ball" }).waitFor();
    const clause = page.locator(".row.chosen");
    await clause.locator(".sign.violated").waitFor();
    await eventually(async () => assert.ok((await time()) > 0));
    await page.locator(".caption", { hasText: "violated by −" }).waitFor();
    await page.locator(".tracks text.event").nth(3).waitFor();
    await eventually(async () => assert.ok(await painted(), "the scene has not been drawn"));
  });

  step("the time line can be read in a dark and in a light theme", async () => {
    await accessibleInEach(workbench, page, "replay");
  });

  step("the keyboard plays, stops and steps", async () => {
    await page.locator(".stage").press("Home");
    await eventually(async () => assert.equal(await time(), 0));
    const play = page.getByRole("button", { name: "Play or pause" });
    await page.locator(".stage").press("Space");
    await play.locator("[data-icon=pause]").waitFor();
    await page.locator(".readout").filter({ hasText: /^0\.[2-9]|^[1-9]/ }).waitFor();
    await page.locator(".stage").press("Space");
    await play.locator("[data-icon=play]").waitFor();
    const stopped = await time();
    await page.locator(".row .name").first().press("ArrowRight");
    await eventually(async () => assert.ok((await time()) > stopped));
    await page.locator(".stage").press("Home");
    await page.locator(".stage").press("v");
    await eventually(async () => assert.ok((await time()) > 0));
  });

  step("what moves is somewhere else at another time", async () => {
    const label = page.locator(".label", { hasText: "ball" });
    const place = () => label.getAttribute("style");
    await page.locator(".stage").press("End");
    await drawn();
    const end = await place();
    await page.locator(".stage").press("Home");
    await eventually(async () => assert.notEqual(await place(), end));
  });

  step("the camera follows the tool", async () => {
    const follow = page.getByLabel("Follow with the camera");
    await page.locator(".stage").press("Home");
    await follow.selectOption({ label: "Follow ur10 tool" });
    await page.getByRole("button", { name: /^Coordinate frames/ }).click();
    const tool = page.locator(".label.frame", { hasText: "ur10 tool" });
    const goal = page.locator(".label", { hasText: "left_ws" });
    await drawn();
    const [still, before] = [await tool.getAttribute("style"), await goal.getAttribute("style")];
    await page.locator(".stage").press("End");
    await drawn();
    // Labels give way to others, but along the vertical only.
    const left = (style) => Math.round(Number.parseFloat(/left: ([^p]*)px/.exec(style)[1]));
    assert.ok(Math.abs(left(await tool.getAttribute("style")) - left(still)) <= 1, "the tool stays where it is in the picture");
    assert.notEqual(left(await goal.getAttribute("style")), left(before), "and the scene moves");
    await workbench.screenshot("replay-followed");
    await page.locator(".stage").press("h");
    assert.equal(await follow.inputValue(), "");
  });

  step("contact forces are shown in words", async () => {
    await page.locator(".stage").press("v");
    await page.getByRole("button", { name: /^Contact forces/ }).click();
    // At the violation, the ball has left the cup. In between, the cup holds it.
    await page.locator(".slider").fill("4");
    await page.locator(".label.force", { hasText: /^ur10 – ball [\d.]+ N$/ }).waitFor();
    await workbench.screenshot("replay-forces");
    await page.locator(".stage").press("o");
    await page.locator(".label.force").waitFor({ state: "detached" });
  });

  step("a picture of the moment and a link to it are copied, and the link leads back", async () => {
    await workbench.page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.getByRole("button", { name: /^Copy a picture/ }).click();
    await page.locator(".said", { hasText: "Picture copied." }).waitFor();
    const types = await workbench.page.evaluate(async () => (await navigator.clipboard.read()).flatMap((item) => item.types));
    assert.deepEqual(types, ["image/png"]);
    await page.locator(".slider").fill("2.5");
    await page.getByRole("button", { name: /^Copy a link/ }).click();
    await page.locator(".said", { hasText: "Link copied." }).waitFor();
    await page.locator(".stage").press("Home");
    await workbench.command("RobBDD: Open Link to a Moment…");
    await workbench.page.locator(".quick-input-widget", { hasText: "Paste a link that was copied" }).waitFor();
    await workbench.acceptInput();
    await eventually(async () => assert.equal(await time(), 2.5));
  });

  step("the toolbar is one stop with arrow keys, and nothing is read in each frame", async () => {
    assert.deepEqual(await page.locator("[role=toolbar] [tabindex='0']").count(), 1);
    await page.getByRole("button", { name: "Play or pause" }).focus();
    await workbench.page.keyboard.press("ArrowRight");
    assert.equal(await page.locator(":focus").getAttribute("aria-label"), "Speed");
    await workbench.page.keyboard.press("End");
    assert.match(await page.locator(":focus").getAttribute("aria-label"), /^Copy a link/);
    assert.equal(await page.locator(".readout").evaluate((one) => one.closest("output, [aria-live], [role=status]")), null);
    assert.equal(await page.locator(".stage").getAttribute("role"), "application");
  });

  step("clicking the timeline seeks", async () => {
    const { x, y, width } = await page.locator(".tracks").boundingBox();
    await workbench.page.mouse.click(x + width / 2, y + 60);
    const duration = Number.parseFloat((await page.locator(".readout").textContent()).split("/")[1]);
    await eventually(async () => assert.ok(Math.abs((await time()) - duration / 2) < duration / 20));
  });

  step("a clause is chosen by its name, and leads to its text", async () => {
    await page.locator(".row .name", { hasText: "in-hand" }).click();
    await page.locator(".caption .sentence", { hasText: "is held by" }).waitFor();
    await page.getByRole("button", { name: "Go to the text of in-hand" }).click();
    await workbench.cursorAt((await session.placeOf(FILE, "in-hand:")).line);
  });

  step("a recording of another text says so", async () => {
    const { line, column } = await session.placeOf(FILE, "evt-place-end", "at-goal: holds(");
    await workbench.command("View: Focus First Editor Group");
    await workbench.goTo(line, column);
    for (let letter = 0; letter < "evt-place-end".length; letter += 1) {
      await workbench.page.keyboard.press("Delete");
    }
    await workbench.page.keyboard.insertText("evt-end");
    await workbench.save();
    await workbench.command("RobBDD: Show Replay…");
    await page.getByText("The model has been edited since: at-goal has changed").waitFor();
    await workbench.screenshot("replay-stale");
  });

  step("the panel comes back with the window", async () => {
    await workbench.reload();
    await page.locator(".label", { hasText: "ball" }).waitFor();
  });

  step("the scene of a .scenex is drawn next to its text", async () => {
    await workbench.command("View: Close All Editors");
    await workbench.openFile(CELL);
    await workbench.command("RobBDD: Show Scene");
    page = workbench.webview("Scene cell.scenex");
    await page.locator(".stage canvas").waitFor();
    for (const name of ["five", "table", "bin", "cube0"]) {
      await page.locator(".label", { hasText: name }).waitFor();
    }
    await page.getByText("At a sampled pose: cube0, cube1.").waitFor();
    await eventually(async () => assert.ok(await painted(), "the scene has not been drawn"));
    await workbench.screenshot("scene");
  });

  step("it follows an edit of a pose, and keeps the last scene while the text has an error", async () => {
    // The remark on an error makes the scene lower, so only the column counts.
    const left = () => page.locator(".label", { hasText: "bin" }).evaluate(({ style }) => Number.parseFloat(style.left));
    const before = await left();
    const { line, column } = await session.placeOf(CELL, "-100, 500, 0");
    await workbench.command("View: Focus First Editor Group");
    await workbench.goTo(line, column + "-100, ".length);
    await workbench.page.keyboard.press("Delete");
    await workbench.type("2");
    await eventually(async () => assert.ok((await left()) < before - 30));
    await workbench.type("(");
    await page.locator(".problem", { hasText: "Out of date: line" }).waitFor();
    assert.ok((await left()) < before - 30);
    await workbench.page.keyboard.press("Backspace");
    await page.locator("[role=status]:not(:empty)").waitFor({ state: "detached" });
  });

  step("an overlap is listed and leads to its text", async () => {
    const { line, column } = await session.placeOf(CELL, "-100, 500, 0");
    await workbench.goTo(line, column);
    for (const _ of "-100, 200") {
      await workbench.page.keyboard.press("Delete");
    }
    await workbench.type("-480, 0");
    const fault = page.getByRole("button", { name: /overlap by \d+ mm/ });
    await fault.waitFor();
    await accessibleInEach(workbench, page, "scene-overlap");
    await accessibleInContrast(session, page, "scene");
    await page.getByRole("button", { name: "Show the whole scene" }).focus();
    await workbench.page.keyboard.press("ArrowRight");
    assert.match(await page.locator(":focus").getAttribute("aria-label"), /the names in the scene/);
    await fault.click();
    await workbench.cursorAt((await session.placeOf(CELL, "model bin_model")).line);
  });

  step("a wrong name of the robot's file has a quick fix, and the right one leads into the file", async () => {
    const { line, column } = await session.placeOf(CELL, 'tool: "tcp"');
    await workbench.goTo(line, column + 'tool: "tcp'.length);
    await workbench.type("x");
    await workbench.problem("has no site or body 'tcpx'; did you mean 'tcp'?").then((problem) => problem.waitFor());
    await workbench.closePanel();
    await workbench.goTo(line, column + 'tool: "t'.length);
    await workbench.press("Control+.", workbench.page.locator(".action-widget .monaco-list-row.focused", { hasText: "Change to 'tcp'" }));
    await workbench.page.keyboard.press("Enter");
    await workbench.lines('tool: "tcp"').waitFor();
    await workbench.goTo(line, column + 'tool: "t'.length);
    await workbench.page.keyboard.press("F12");
    await workbench.lines('<site name="tcp"').waitFor();
    await workbench.screenshot("scene-definition");
  });
});

describe("without WebGL", () => {
  const step = replayed("replay-flat", false);

  step("without WebGL the page says so, and the time line works", async () => {
    await page.getByText("WebGL is missing").waitFor();
    await page.locator(".row .name").first().press("Home");
    await eventually(async () => assert.equal(await time(), 0));
    await page.getByRole("button", { name: "Jump to the violation" }).click();
    await eventually(async () => assert.ok((await time()) > 0));
    await workbench.screenshot("replay-without-webgl");
  });
});

async function time() {
  return Number.parseFloat(await page.locator(".readout").textContent());
}

/** Wait until the screen has been redrawn. */
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
