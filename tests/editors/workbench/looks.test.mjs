// The views in high contrast, by the keyboard alone, and in a narrow window.
import assert from "node:assert/strict";
import { join } from "node:path";
import { accessibleInEach } from "./harness/axe.mjs";
import { contrast } from "./harness/contrast.mjs";
import { execute } from "./harness/models.mjs";
import { eventually } from "./harness/patience.mjs";
import { story } from "./harness/story.mjs";
import { HIGH_CONTRAST } from "./harness/workbench.mjs";

/** What is read in an editor; brackets have colours of VS Code's own. */
const TEXT = ".editor-instance .view-line span > span:not([class*='bracket']), .codelens-decoration a";
const FILE = "tworobots/heights.bdd";
/** The line of `at-goal` in it. */
const CLAUSE = 48;
/** What WCAG 2 asks of text. */
const READABLE = 4.5;
const NARROW = { width: 760, height: 800 };
const WIDE = { width: 1360, height: 1040 };

/** @type {import("./harness/workbench.mjs").Workbench} */
let workbench;
/** The page of the view in front. */
let page;

const step = story(
  "looks",
  (opened) => {
    ({ workbench } = opened);
  },
  { settings: HIGH_CONTRAST.settings, webgl: true, prepare: run },
);

step("a model can be read in high contrast, and a run of the command line be replayed from a lens", async () => {
  await workbench.openFile(FILE);
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await inBoth("text", workbench.page.locator(TEXT));
  await workbench.goTo(61, 1);
  await workbench.codeLens("Replay").first().waitFor();
  await inBoth("lenses", workbench.page.locator(TEXT));
});

step("the graph can be read in high contrast, and followed by the keyboard", async () => {
  await workbench.command("RobBDD: Show Graph");
  page = workbench.webview("Graph");
  await page.locator('[data-iri$="/at-goal"]').waitFor();
  await inBoth("graph", page.locator(".canvas text, .legend li, header button, .percent"));
  await workbench.focusPanel(page);
  await tabTo('[data-iri$="/into-bin"]');
  await workbench.page.keyboard.press("Enter");
  await page.locator('.current[data-iri$="/into-bin"]').waitFor();
});

step("the study can be read in high contrast, and the keyboard leads from a cell to its replay", async () => {
  await workbench.command("View: Focus First Editor Group");
  await workbench.command("RobBDD: Show Study…");
  page = workbench.webview("Study");
  await page.getByRole("heading", { name: "3 hold, 1 violated" }).waitFor();
  await inBoth("study", page.locator("main h1, main h2, th, td button, td small, .note, .clause span, .none, svg text, label"));
  await workbench.focusPanel(page);
  await tabTo(".margins rect.violated");
  await tabTo("td:last-child button", "Shift+Tab");
  await workbench.page.keyboard.press("Enter");
  // The keyboard is at the worst of the listed executions.
  await page.locator(".executions button:focus").waitFor();
  await workbench.page.keyboard.press("Enter");
  await workbench.page.locator(".tab.active", { hasText: "Replay bin-heights" }).waitFor();
});

step("the replay can be read in high contrast, and is played by the keyboard", async () => {
  page = workbench.webview("Replay");
  await page.locator(".label", { hasText: "ball" }).waitFor();
  await inBoth("replay", page.locator(".title, .label, .row .text, .row .sign, .caption p, .tracks text, header button:enabled, .readout"));
  await workbench.focusPanel(page);
  // From the violation, it would play for a second only, which a slow machine may miss.
  await tabTo(".slider");
  await workbench.page.keyboard.press("Home");
  await page.locator(".readout").filter({ hasText: /^0\.00/ }).waitFor();
  await tabTo("header button:first-of-type", "Shift+Tab");
  await workbench.page.keyboard.press("Space");
  await page.getByRole("button", { name: "Play or pause" }).locator("[data-icon=pause]").waitFor();
  await workbench.page.keyboard.press("Space");
  await tabTo(".stage");
  const before = await page.locator(".label", { hasText: "ball" }).getAttribute("style");
  await workbench.page.keyboard.press("ArrowRight");
  await page.locator(`.label:not([style="${before}"])`, { hasText: "ball" }).waitFor();
  await tabTo(".row .name");
  await workbench.page.keyboard.press("Enter");
  await page.locator(".row.chosen", { hasText: "height" }).waitFor();
  await page.locator(".row.chosen .name:focus").waitFor();
});

step("axe finds no barrier in high contrast", async () => {
  await accessibleInEach(workbench, page, "contrast-axe-replay", HIGH_CONTRAST.schemes);
  for (const [tab, name] of [["Study run", "study"], ["Graph heights.bdd", "graph"]]) {
    await workbench.page.locator(".tab", { hasText: tab }).click();
    await workbench.webview(tab).locator("header").waitFor();
    await accessibleInEach(workbench, workbench.webview(tab), `contrast-axe-${name}`, HIGH_CONTRAST.schemes);
  }
  await workbench.command("View: Focus First Editor Group");
  await workbench.goTo(CLAUSE, 20);
  await workbench.page.keyboard.press("Control+K");
  await workbench.page.keyboard.press("Alt+H");
  const history = workbench.webview("History of");
  await history.getByRole("heading", { name: /holds in/ }).waitFor();
  await accessibleInEach(workbench, history, "contrast-axe-history", HIGH_CONTRAST.schemes);
  await workbench.command("View: Focus First Editor Group");
  await workbench.command("RobBDD: Show Matrix of Verdicts…");
  const matrix = workbench.webview("Study");
  await matrix.getByRole("grid").waitFor();
  await accessibleInEach(workbench, matrix, "contrast-axe-matrix", HIGH_CONTRAST.schemes);
  await workbench.page.locator(".tab", { hasText: "Replay bin-heights" }).click();
  await page.locator(".row").first().waitFor();
});

step("who wants no motion sees none, and a replay that is asked for still plays", async () => {
  await workbench.page.emulateMedia({ reducedMotion: "reduce" });
  await motionless(page);
  for (const tab of ["Study run", "Graph heights.bdd", "History of"]) {
    await workbench.page.locator(".tab", { hasText: tab }).click();
    await workbench.webview(tab).locator("h1, header").first().waitFor();
    await motionless(workbench.webview(tab));
  }
  await workbench.page.locator(".tab", { hasText: "Replay bin-heights" }).click();
  await page.locator(".row").first().waitFor();
  await workbench.page.emulateMedia({ reducedMotion: "no-preference" });
});

/** Assert that nothing in a page moves by itself, or slides. */
async function motionless(shown) {
  const moving = await shown.locator("body").evaluate(() => {
    const parts = [...document.querySelectorAll("*")].map((element) => getComputedStyle(element));
    return {
      asked: matchMedia("(prefers-reduced-motion: reduce)").matches,
      found: parts.filter(({ animationName, transitionDuration, scrollBehavior }) =>
        animationName !== "none" || !/^(0s(, )?)+$/.test(transitionDuration) || scrollBehavior !== "auto").length,
    };
  });
  assert.deepEqual(moving, { asked: true, found: 0 });
}

step("in a narrow window nothing is cut off, and no name covers another", async () => {
  await workbench.page.setViewportSize(NARROW);
  // A side bar would leave no room for two columns.
  await workbench.command("View: Close Primary Side Bar");
  await page.locator(".row").first().waitFor();
  // The behaviour's sentence may be: it is told in full when it is pointed at, or chosen.
  await noneCut(".row .name:not(:has-text('picks')), .readout, header button, header select");
  await noneCovered(".label");
  await noneCovered(".tracks text.event");
  await workbench.screenshot("narrow-replay");
  for (const [tab, name] of [["Study run", "study"], ["Graph heights.bdd", "graph"]]) {
    await workbench.page.locator(".tab", { hasText: tab }).click();
    page = workbench.webview(tab);
    await page.locator("header").waitFor();
    await noneCut("header button, header select, .legend li");
    await workbench.screenshot(`narrow-${name}`);
  }
  await workbench.page.setViewportSize(WIDE);
});

/** Check texts in both schemes: each has enough contrast to its background. */
async function inBoth(name, texts) {
  for (const scheme of Object.keys(HIGH_CONTRAST.schemes)) {
    await workbench.changeScheme(scheme, HIGH_CONTRAST.schemes);
    if (page !== undefined) {
      await workbench.themed(page, HIGH_CONTRAST.schemes[scheme]);
    }
    await eventually(() => areReadable(scheme, texts));
    await workbench.screenshot(`contrast-${name}-${scheme}`);
  }
}

async function areReadable(scheme, texts) {
  const found = await texts.evaluateAll((elements) =>
    elements
      .filter((element) => element.textContent.trim() !== "" && element.getClientRects().length > 0)
      .map((element) => {
        const { fill, color } = getComputedStyle(element);
        let behind = element;
        while (behind.parentElement !== null && /^rgba\(.*, 0(\.\d+)?\)$/.test(getComputedStyle(behind).backgroundColor)) {
          behind = behind.parentElement;
        }
        const ground = getComputedStyle(behind).backgroundColor;
        return { text: element.textContent, colour: element instanceof SVGElement ? fill : color, ground };
      }),
  );
  assert.ok(found.length > 0);
  for (const { text, colour, ground } of found) {
    const measured = contrast(colour, ground);
    assert.ok(measured >= READABLE, `${scheme}: "${text}" has ${measured.toFixed(1)}: ${colour} on ${ground}`);
  }
}

/** Press Tab until something has the keyboard, and shows that it has. */
async function tabTo(selector, key = "Tab") {
  const focused = page.locator(":focus");
  for (let presses = 0; presses < 60; presses += 1) {
    await workbench.page.keyboard.press(key);
    if ((await page.locator(selector).and(focused).count()) > 0) {
      const shown = await focused.evaluate((element) => {
        const style = getComputedStyle(element.querySelector(":scope > rect, :scope > polygon") ?? element);
        return (style.outlineStyle !== "none" && style.outlineWidth !== "0px") || style.strokeDasharray !== "none";
      });
      assert.ok(shown, `${selector} does not show that it has the keyboard`);
      return;
    }
  }
  assert.fail(`${selector} cannot be reached by ${key}`);
}

async function noneCut(selector) {
  await eventually(async () => {
    const cut = await page.locator(selector).evaluateAll((elements) =>
      elements
        .filter((element) => {
          const { left, right } = element.getBoundingClientRect();
          return left < 0 || right > innerWidth || element.scrollWidth > element.clientWidth + 1;
        })
        .map((element) => element.textContent),
    );
    assert.deepEqual(cut, []);
  });
}

async function noneCovered(selector) {
  await eventually(async () => {
    const covered = await page.locator(selector).evaluateAll((elements) => {
      const boxes = elements.map((element) => ({ name: element.textContent, box: element.getBoundingClientRect() }));
      return boxes.flatMap(({ name, box }, index) =>
        boxes
          .slice(index + 1)
          .filter(({ box: other }) => box.left < other.right - 1 && other.left < box.right - 1 && box.top < other.bottom - 1 && other.top < box.bottom - 1)
          .map((other) => `${name} and ${other.name}`),
      );
    });
    assert.deepEqual(covered, []);
  });
}

/** Execute four scenarios, one of which fails: the ball under the suction cup hits the rim of the bin. */
function run(workspace) {
  return execute(join(workspace, FILE), 'scale = "1.1"', /3 hold, 1 violated/);
}
