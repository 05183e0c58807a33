// The graph of a model next to its text: it follows edits and the cursor, links to the text, and is restored.
import assert from "node:assert/strict";
import { accessible } from "../harness/axe.mjs";
import { contrast } from "../harness/contrast.mjs";
import { eventually } from "../harness/patience.mjs";
import { story } from "../harness/story.mjs";
import { SCHEMES } from "../harness/workbench.mjs";

const FILE = "tworobots/heights.bdd";

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;
/** The page of the graph. */
let page;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function graph(window) {
  const step = story("graph", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, { window });

  step("the command shows the graph next to the model, at the node of the cursor and large enough to read", async () => {
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().waitFor({ state: "attached" });
    await cursorAt("goal-untouched:");
    await workbench.command("RobBDD: Show Graph");
    page = workbench.webview("Graph heights.bdd");
    await node("at-goal").filter({ hasText: "part is located at goal" }).waitFor();
    await eventually(async () => assert.equal(await page.locator("[data-iri]").count(), 16));
    await current("goal-untouched").waitFor();
    await eventually(async () => assert.ok(await inWindow("goal-untouched")));
    assert.ok((await percent()) >= 100, "its text has the size of the interface");
    await workbench.screenshot("graph-opened");
  });

  step("the node at the cursor is marked and visible", async () => {
    await cursorAt("does not drop");
    await current("not-dropped").waitFor();
    await cursorAt("evt-end>");
    await current("evt-end").waitFor();
    await cursorAt("User Story");
    await current("fill-tall-bins").waitFor();
    await eventually(async () => {
      assert.ok(await inWindow("fill-tall-bins"));
      assert.equal(await page.locator("[data-iri].current").count(), 1);
    });
  });

  step("a click on a node selects its text", async () => {
    await page.getByRole("button", { name: "Show the whole picture" }).click();
    await node("goal-untouched").click();
    await workbench.page.locator(".view-overlays .selected-text").first().waitFor();
    await current("goal-untouched").waitFor();
    await workbench.cursorAt((await session.placeOf(FILE, "goal-untouched:")).line);
  });

  step("an edit redraws the picture and leaves it where it is", async () => {
    const before = await place();
    await cursorAt("holds(<part> is located at <goal>", "holds(".length);
    await workbench.type("x");
    await page.locator("header + .problem", { hasText: "Out of date" }).waitFor();
    assert.ok(await node("at-goal").isVisible(), "the last good picture stays");
    await workbench.screenshot("graph-out-of-date");
    await workbench.undo();
    await page.locator(".problem:not(:empty)").waitFor({ state: "detached" });
    await cursorAt('"the cell does not', 1);
    await workbench.type("really, ");
    await node("fill-tall-bins").filter({ hasText: "really," }).waitFor();
    await page.locator(".problem:not(:empty)").waitFor({ state: "detached" });
    assert.equal(await place(), before);
  });

  step("the keyboard moves, zooms and opens", async () => {
    const before = await place();
    await page.locator(".canvas").press("ArrowRight");
    await eventually(async () => assert.notEqual(await place(), before));
    await page.locator(".canvas").press("0");
    const whole = await percent();
    await page.locator(".canvas").press("+");
    await page.locator(".canvas").press("+");
    await eventually(async () => assert.ok((await percent()) > whole));
    await page.locator(".canvas").press("0");
    await eventually(async () => assert.equal(await percent(), whole));
    await node("in-hand").press("Enter");
    await current("in-hand").waitFor();
  });

  step("it can be read in a dark and in a light theme", async () => {
    for (const scheme of Object.keys(SCHEMES)) {
      await workbench.changeScheme(scheme);
      await workbench.themed(page, SCHEMES[scheme]);
      const [text, ground] = await node("in-hand").evaluate((group) => [
        getComputedStyle(group.querySelector("text")).fill,
        getComputedStyle(group.querySelector("rect")).fill,
      ]);
      assert.ok(contrast(text, ground) >= 4.5, `${scheme}: ${text} on ${ground}`);
      await workbench.screenshot(`graph-${scheme}`);
      await accessible(page, `graph (${scheme})`);
    }
  });

  step("a hidden page keeps its state", async () => {
    await page.getByRole("button", { name: "Larger" }).click();
    const before = await place();
    await workbench.page.locator(".tab", { hasText: "Graph heights.bdd" }).click();
    await workbench.openFile("tworobots/cell.scene");
    await workbench.page.locator("iframe.webview.ready").waitFor({ state: "hidden" });
    await workbench.page.locator(".tab", { hasText: "Graph heights.bdd" }).click();
    await current("in-hand").waitFor();
    await eventually(async () => assert.equal(await place(), before));
  });

  step("the panel comes back with the window", async () => {
    await workbench.reload();
    // Which tab was in front VS Code writes down now and then only.
    await workbench.page.locator(".tab", { hasText: "Graph heights.bdd" }).click();
    await node("at-goal").waitFor();
  });
}

/** The node with a name. */
function node(name) {
  return page.locator(`[data-iri$="/${name}"]`);
}

function current(name) {
  return page.locator(`.current[data-iri$="/${name}"]`);
}

function place() {
  return page.locator(".canvas > g").getAttribute("transform");
}

async function percent() {
  return Number.parseInt(await page.locator(".percent").textContent());
}

/** Whether a node is within the window of its page. */
function inWindow(name) {
  return node(name).evaluate((group) => {
    const { left, top, right, bottom } = group.getBoundingClientRect();
    return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
  });
}

/** Put the cursor into the first line of the model on disk with a text, so many signs behind its beginning. */
async function cursorAt(text, behind = 1) {
  const { line, column } = await session.placeOf(FILE, text);
  await workbench.command("View: Focus First Editor Group");
  await workbench.goTo(line, column + behind);
}
