// Verdicts in the text: in colours of the theme, faded when stale, in every editor of a document, until removed.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { LANGUAGE_SERVER } from "../harness/checkout.mjs";
import { contrast } from "../harness/contrast.mjs";
import { LONG, TRY, eventually } from "../harness/patience.mjs";
import { story } from "../harness/story.mjs";
import { noVerdictAt, themeColour, verdictAt } from "../harness/verdicts.mjs";
import { HIGH_CONTRAST, PLAIN } from "../harness/workbench.mjs";

const FILE = "pickplace/pickplace.bdd";
/** What WCAG 2 asks of text. */
const READABLE = 4.5;
/** Minimum contrast of signs, also when faded. */
const VISIBLE = 3;
/** Lines of the model, and the theme's names of their verdict colours. */
const HOLDS = { line: /^\s*at-source:/, words: /^✔ 4\/4[^(]*$/, side: "after", colour: "robbdd.holdsForeground" };
const VIOLATED = { line: /^\s*at-goal:/, words: /^✗ 0\/4[^(]*$/, side: "before", colour: "robbdd.violatedForeground" };
const RATE = { line: /^\s*Scenario part-to-bin/, words: /^✗ 0\/4 passed$/, side: "after", colour: "robbdd.violatedForeground" };
const ALL = [HOLDS, VIOLATED, RATE];

/** @type {import("../harness/session.mjs").Session} */
let session;
/** @type {import("../harness/workbench.mjs").Workbench} */
let workbench;

/** @param {import("../harness/story.mjs").SharedWindow} window */
export function verdicts(window) {
  const step = story("verdicts", (opened) => {
    session = opened;
    workbench = opened.workbench;
  }, {
    window,
    prepare: async (workspace) => {
      // The goal clause is evaluated before the object can be there.
      const text = await readFile(join(workspace, FILE), "utf8");
      const late = "is located at <goal>, after <evt-place-end>";
      assert.ok(text.includes(late));
      await writeFile(join(workspace, FILE), text.replace(late, "is located at <goal>, after <evt-pick-end>"));
    },
  });

  step("verdicts are drawn in the colours of every theme, where they can be read", async () => {
    await workbench.openFile(FILE);
    await workbench.codeLens("Run").first().click();
    await verdictAt(workbench, RATE.line, RATE.words, { timeout: LONG });
    await inEveryTheme("fresh", async (name) => {
      const [holds, violated] = [await drawn(HOLDS, name), await drawn(VIOLATED, name)];
      await drawn(RATE, name);
      assert.notEqual(holds.colour, violated.colour);
    });
    // What is drawn takes the place of the hint or the lens.
    await workbench.lines(/[✔✗]/).first().waitFor({ state: "detached" });
    await workbench.codeLens("passed").first().waitFor({ state: "detached" });
    await workbench.codeLens("Rerun 4 failed").waitFor();
  });

  step("hovering over a verdict lists each scenario", async () => {
    const hover = workbench.page.locator(".monaco-hover:visible", { hasText: /goal\s=\sleft_ws:\s✔\s\+\d+\smm/ });
    await eventually(async () => {
      const { middle } = await verdictAt(workbench, HOLDS.line, HOLDS.words);
      await workbench.page.mouse.move(5, 5);
      await workbench.page.mouse.move(middle.x, middle.y);
      await hover.waitFor({ timeout: TRY });
    });
    await workbench.screenshot("verdicts-hover");
    await workbench.page.mouse.move(5, 5);
  });

  step("hovering over a violated clause shows the moment and the margin over time", async () => {
    for (const scheme of ["light", "dark"]) {
      await workbench.changeScheme(scheme);
      await workbench.focusEditor();
      const { line, column } = await session.placeOf(FILE, "at-goal:");
      await workbench.goTo(line, column);
      // The picture of the moment is taken when the run is over; the hover that was there before has none.
      const pictures = workbench.page.locator(".monaco-hover img");
      await eventually(async () => {
        await workbench.page.keyboard.press("Escape");
        await workbench.command("Show or Focus Hover");
        await pictures.nth(1).waitFor({ timeout: TRY });
        await pictures.first().scrollIntoViewIfNeeded({ timeout: TRY });
        for (const picture of await pictures.all()) {
          const width = await picture.evaluate((image) => image.decode().then(() => image.naturalWidth));
          assert.ok(width >= 300, `a picture is ${width} pixels wide`);
        }
      }, LONG);
      await workbench.screenshot(`results-hover-${scheme}`);
      await workbench.page.keyboard.press("Escape");
    }
  });

  step("a verdict follows its clause through edits, and fades when the clause itself is edited", async () => {
    const { line, column } = await session.placeOf(FILE, ", after", "at-goal:");
    await workbench.goTo(1, 1);
    await workbench.page.keyboard.press("Enter");
    await workbench.goTo(line + 1, column);
    await workbench.type(", 5 seconds");
    await verdictAt(workbench, VIOLATED.line, /\(stale\)$/);
    await verdictAt(workbench, RATE.line, /\(stale\)$/);
    await inEveryTheme("stale", async (name) => {
      const fresh = await drawn(HOLDS, name);
      await faded(VIOLATED, fresh, name);
      await faded(RATE, fresh, name);
    });
    for (let letter = 0; letter < ", 5 seconds".length; letter += 1) {
      await workbench.page.keyboard.press("Backspace");
    }
    await drawn(VIOLATED, "undone");
    await drawn(RATE, "undone");
  });

  step("every editor of a document shows them, also after scrolling", async () => {
    await workbench.page.setViewportSize({ width: 1360, height: 500 });
    await workbench.command("View: Split Editor");
    const editors = [".editor-group-container.active", ".editor-group-container:not(.active)"];
    for (const group of editors) {
      const editor = `${group} .editor-instance .monaco-editor`;
      await workbench.page.locator(`${editor} .view-line`).first().waitFor();
      await workbench.page.locator(`${editor} .view-lines`).click();
      await workbench.goTo((await session.placeOf(FILE, "Scenario part-to-bin")).line + 1, 1);
      await drawn(RATE, group);
      await workbench.goTo((await session.placeOf(FILE, "at-source:")).line + 1, 1);
      await drawn(HOLDS, group);
    }
    await workbench.screenshot("verdicts-split");
    await workbench.command("View: Join All Editor Groups");
    await workbench.page.setViewportSize({ width: 1360, height: 1040 });
  });

  step("they go with the settings that turn hints and lenses off, and with the server", async () => {
    await session.server.configure({ "editor.inlayHints.enabled": "off" });
    await noVerdictAt(workbench, HOLDS.line);
    await drawn(RATE, "without hints");
    await session.server.configure({ "editor.inlayHints.enabled": "on", "editor.codeLens": false });
    await noVerdictAt(workbench, RATE.line);
    await drawn(HOLDS, "without lenses");
    await session.server.configure({ "editor.codeLens": true });
    await all("with both");
    await session.server.configure({ "robbdd.server.path": join(session.workspace, "no-such-server") });
    for (const { line } of ALL) {
      await noVerdictAt(workbench, line);
    }
    await session.server.configure({ "robbdd.server.path": LANGUAGE_SERVER });
    await all("with the server again");
  });

  step("they are there again when the window is", async () => {
    await workbench.reload();
    // The window stores its layout now and then: it may come back with two groups, another file, or scrolled elsewhere.
    await workbench.command("View: Join All Editor Groups");
    await workbench.openFile(FILE);
    await workbench.goTo((await session.placeOf(FILE, "at-source:")).line + 1, 1);
    await all("reloaded");
  });
}

/** Wait until a verdict is drawn as the theme wants it. */
function drawn({ line, words, side, colour }, name) {
  return eventually(async () => {
    const found = await verdictAt(workbench, line, words);
    assert.deepEqual([found.side, found.slanted], [side, false], name);
    assert.equal(found.colour, await themeColour(workbench, colour), name);
    const measured = contrast(found.colour, found.ground);
    assert.ok(measured >= READABLE, `${name}: "${found.words}" has ${measured.toFixed(1)}`);
    return found;
  });
}

/** Wait until one is drawn as stale in the theme's colour, fainter than a fresh one. */
function faded({ line, side }, fresh, name) {
  return eventually(async () => {
    const found = await verdictAt(workbench, line, /^✗ 0\/4.* \(stale\)$/);
    assert.deepEqual([found.side, found.slanted], [side, true], name);
    assert.equal(found.colour, await themeColour(workbench, "robbdd.staleForeground"), name);
    assert.notEqual(found.colour, fresh.colour, name);
    const [before, after] = [contrast(fresh.colour, fresh.ground), contrast(found.colour, found.ground)];
    assert.ok(after >= VISIBLE && after < before, `${name}: ${after} of ${before}`);
  });
}

async function all(name) {
  for (const one of ALL) {
    await drawn(one, name);
  }
}

async function inEveryTheme(name, look) {
  for (const [contrasts, { settings, schemes }] of Object.entries({ plain: PLAIN, high: HIGH_CONTRAST })) {
    await session.server.configure(settings);
    for (const scheme of Object.keys(schemes)) {
      await workbench.changeScheme(scheme, schemes);
      await look(`${contrasts} ${scheme}`);
      await workbench.screenshot(`verdicts-${name}-${contrasts}-${scheme}`);
    }
  }
  await session.server.configure(PLAIN.settings);
  await workbench.changeScheme("dark");
}
