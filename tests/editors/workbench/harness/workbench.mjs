// The workbench as a person sees it: small helpers over its page.
import assert from "node:assert/strict";
import { mkdir } from "node:fs/promises";
import { dirname, join } from "node:path";
import { SCREENSHOTS } from "./checkout.mjs";
import { PATIENCE, TRY, eventually } from "./patience.mjs";

/** Colour schemes and the class that the window wears in each. */
export const SCHEMES = { dark: "vs-dark", light: "vs" };

/** Settings under which it wears the usual themes. */
export const PLAIN = {
  settings: { "workbench.preferredDarkColorTheme": "Default Dark Modern", "workbench.preferredLightColorTheme": "Default Light Modern" },
  schemes: SCHEMES,
};

/** Settings under which the window wears a theme of high contrast in each scheme, and the classes that it has then. */
export const HIGH_CONTRAST = {
  settings: {
    "workbench.preferredDarkColorTheme": "Default High Contrast",
    "workbench.preferredLightColorTheme": "Default High Contrast Light",
  },
  schemes: { dark: "hc-black", light: "hc-light" },
};

/** The classes that the page of a panel wears in each of these. */
const PAGE_CLASSES = {
  "vs-dark": ".vscode-dark",
  vs: ".vscode-light",
  "hc-black": ".vscode-high-contrast:not(.vscode-high-contrast-light)",
  "hc-light": ".vscode-high-contrast-light",
};

const GROUP = ".editor-group-container.active";
export const EDITOR = `${GROUP} .editor-instance .monaco-editor`;
const QUICK_INPUT = ".quick-input-widget .quick-input-filter input";
const TOASTS = ".notifications-toasts .notification-list-item";

export class Workbench {
  /** @param {import("playwright-core").Page} page */
  constructor(page) {
    this.page = page;
    this.errors = page.locator(`${EDITOR} .squiggly-error`);
    this.status = page.locator(`[id="robbdd.robbdd-workbench.robbdd.status"]`);
    this.notifications = page.locator(TOASTS);
  }

  /** Open the workbench at an address and wait until it can be used. */
  static async open(page, address) {
    page.setDefaultTimeout(PATIENCE);
    await page.goto(address);
    const workbench = new Workbench(page);
    await workbench.#restored();
    return workbench;
  }

  /** Open a file of the workspace by its name or the end of its path. */
  async openFile(path) {
    const name = path.split("/").at(-1);
    await this.#ask("Control+P", path);
    await this.#focusedEntry(name).waitFor();
    await this.page.keyboard.press("Enter");
    await this.page.locator(`${GROUP} .tab.active[data-resource-name="${name}"]`).waitFor();
    // The lines of the file before stay for a moment.
    await this.page.locator(`${EDITOR}[data-uri$="/${name}"] .view-line`).first().waitFor();
  }

  /** Run a command of the palette by its full title. */
  async command(title) {
    await eventually(async () => {
      await this.#ask("F1", `>${title}`);
      try {
        await this.#focusedEntry(title).waitFor({ timeout: TRY });
      } catch (error) {
        // What is offered later does not come into a list that is open.
        await this.page.keyboard.press("Escape");
        throw error;
      }
    });
    await this.page.keyboard.press("Enter");
  }

  /** Choose an entry of the list that a command, or another list, has opened. */
  async pick(text) {
    await eventually(async () => {
      // A long list shows only its first entries until it is filtered. The list before stays for a moment, and takes the text.
      await this.page.locator(QUICK_INPUT).fill(text, { timeout: TRY });
      await this.#focusedEntry(text).waitFor({ timeout: TRY });
    });
    await this.page.keyboard.press("Enter");
  }

  /** Accept the text of the quick input, wherever the focus is. */
  async acceptInput() {
    await this.page.locator(QUICK_INPUT).press("Enter");
  }

  /** Change the system's colour scheme, which the theme follows, and wait until the window has changed. */
  async changeScheme(scheme, schemes = SCHEMES) {
    await this.page.emulateMedia({ colorScheme: scheme });
    await this.page.locator(`.monaco-workbench.${schemes[scheme]}`).waitFor();
  }

  /** Put the cursor before a character; lines and columns count from 1. */
  async goTo(line, column) {
    await this.#ask("Control+G", `:${line}:${column}`);
    await this.page.keyboard.press("Enter");
    await this.cursorAt(line, column);
    await this.page.locator(`${EDITOR}.focused`).waitFor();
  }

  /** Wait until the cursor of the active editor is in a line, and before a character of it where one is named. */
  async cursorAt(line, column = "\\d+") {
    await this.page.locator(".statusbar-item", { hasText: new RegExp(`Ln ${line}, Col ${column}(?!\\d)`) }).waitFor();
  }

  /** Give the active editor the keyboard. */
  async focusEditor() {
    await this.command("View: Focus Active Editor Group");
  }

  async type(text) {
    await this.page.keyboard.type(text);
  }

  /** Press a key until what it opens is visible: a busy window may lose the first, or close at once what it opened. */
  async press(key, opened) {
    await eventually(async () => {
      if (!(await opened.isVisible())) {
        await this.page.keyboard.press(key);
      }
      await opened.waitFor({ timeout: TRY });
    });
  }

  /** Save the active editor and wait until it is no longer marked as changed. */
  async save() {
    await this.page.keyboard.press("Control+S");
    await this.page.locator(`${GROUP} .tab.active.dirty`).waitFor({ state: "detached" });
  }

  async undo() {
    await this.page.keyboard.press("Control+Z");
  }

  /** Wait until an error is underlined in the active editor. */
  async waitForError() {
    await this.errors.first().waitFor({ state: "attached" });
  }

  /** Wait until no error is underlined. */
  async waitForNoError() {
    await this.errors.first().waitFor({ state: "detached" });
  }

  /** Show the Problems view and return its locator. */
  async openProblems() {
    const panel = this.page.locator(".markers-panel");
    if (!(await panel.isVisible())) {
      await this.page.keyboard.press("Control+Shift+M");
    }
    await panel.waitFor();
    return panel;
  }

  /** A problem of the Problems view whose message matches. */
  async problem(text) {
    return (await this.openProblems()).locator(".monaco-list-row", { hasText: text });
  }

  async closePanel() {
    await this.command("View: Hide Panel");
    await this.page.locator(".part.panel").waitFor({ state: "hidden" });
  }

  /** Close every editor without saving it, the panel and what the mouse shows; show the files. */
  async tidy() {
    await this.page.mouse.move(5, 5);
    const tabs = this.page.locator(".editor-group-container .tab");
    for (let open = await tabs.count(); open > 0; open = await tabs.count()) {
      await this.command("View: Revert and Close Editor");
      await eventually(async () => assert.ok((await tabs.count()) < open, "no editor was closed"));
    }
    if (await this.page.locator(".part.panel").isVisible()) {
      await this.closePanel();
    }
    await this.command("View: Show Explorer");
    await this.#restored();
    await this.changeScheme("light");
  }

  /** A code lens of the active editor by its text. */
  codeLens(text) {
    return this.page.locator(`${EDITOR} .codelens-decoration a`, { hasText: text });
  }

  /** The visible lines of the active editor that match, with their inlay hints in the text; verdicts are drawn beside it, see `verdicts.mjs`. */
  lines(text) {
    return this.page.locator(`${EDITOR} .view-line`, { hasText: text });
  }

  /** The colour, as CSS says it, of the first piece of text in the editor that reads exactly like this. */
  async colourOf(text) {
    const tokens = this.page.locator(`${EDITOR} .view-line span > span`);
    await tokens.first().waitFor();
    const colours = await tokens.evaluateAll(
      (spans, wanted) =>
        spans
          .filter((span) => span.textContent.replaceAll("\u00a0", " ").trim() === wanted)
          .map((span) => getComputedStyle(span).color),
      text,
    );
    if (colours.length === 0) {
      throw new Error(`no token of its own reads "${text}"`);
    }
    return colours[0];
  }

  /** Wait until the status item of the extension reads like this. */
  async statusText(pattern, timeout = PATIENCE) {
    await this.status.filter({ hasText: pattern }).waitFor({ timeout });
  }

  /** Wait for the toast with this text and return it. It stays while it is pointed at. */
  async notification(text) {
    const toast = this.notifications.filter({ hasText: text }).first();
    await toast.hover();
    return toast;
  }

  /** Wait for a toast that says this, be it for a moment only. */
  async said(pattern) {
    // Looked for within the page, with each picture: a question from here may come too late.
    await this.page.waitForFunction(
      ([selector, source]) => [...document.querySelectorAll(selector)].some((item) => new RegExp(source).test(item.textContent)),
      [TOASTS, pattern.source],
      { polling: "raf" },
    );
  }

  /**
   * The page of the panel whose title has these words: the last in sight, and none but that, since for a moment a panel
   * stays beside the one that takes its place.
   */
  webview(title) {
    const inSight = this.page.locator("iframe.webview.ready:visible").last();
    return inSight.contentFrame().frameLocator(`#active-frame[title*="${title}"]`);
  }

  /** Wait until the page of a panel has the colours of the scheme whose class the window wears. */
  async themed(page, windowClass) {
    await page.locator(`body${PAGE_CLASSES[windowClass]}`).waitFor();
  }

  /** Give the page of a panel, in the second group of editors, the keyboard. */
  async focusPanel(page) {
    await this.page.keyboard.press("Control+2");
    await eventually(async () => {
      assert.ok(await page.locator("body").evaluate(() => document.hasFocus()), "the page has not got the keyboard");
    });
  }

  /** Load the window again, as after a crash or an update, and wait until it can be used. */
  async reload() {
    await this.page.reload();
    await this.#restored();
  }

  /** A view in the side bar has its rows when the window has come back, whichever view that is. */
  async #restored() {
    await this.page.locator(".part.sidebar .monaco-list-row").first().waitFor();
  }

  /** What the window shows, in words, with the verdicts, which are drawn beside the lines. */
  text() {
    return this.page.evaluate((lines) => {
      const drawn = [...document.querySelectorAll(`${lines} span`)].flatMap((span) =>
        ["::before", "::after"].map((side) => getComputedStyle(span, side).content).filter((content) => content.startsWith('"')),
      );
      return `${document.body.innerText}\nbeside the text: ${[...new Set(drawn)].join(" ")}`;
    }, `${EDITOR} .view-line`);
  }

  /** Write a picture of the whole window below the build output. */
  async screenshot(name) {
    const path = join(SCREENSHOTS, `${name}.png`);
    await mkdir(dirname(path), { recursive: true });
    await this.page.screenshot({ path });
    return path;
  }

  /** Open the quick input by a key and put a text into it. */
  async #ask(key, text) {
    // What was asked before may still be going away, and take the key for itself.
    await this.page.locator(".quick-input-widget").waitFor({ state: "hidden" });
    const input = this.page.locator(QUICK_INPUT);
    await eventually(async () => {
      // A page that comes to the front takes the key, or the focus from the input, which then goes away.
      if (!(await input.isVisible())) {
        await this.page.keyboard.press(key);
      }
      await input.fill(text, { timeout: TRY });
    });
  }

  /** The entry of the quick input's list that Enter takes, if its label has this text. */
  #focusedEntry(text) {
    const label = this.page.locator(".label-name", { hasText: text });
    return this.page.locator(".quick-input-list .monaco-list-row.focused").filter({ has: label });
  }
}
