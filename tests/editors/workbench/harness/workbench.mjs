// The workbench as a person sees it: small helpers over its page.
import { mkdir } from "node:fs/promises";
import { dirname, join } from "node:path";
import { SCREENSHOTS } from "./checkout.mjs";

export const PATIENCE = 60_000;

/** Colour schemes and the class that the window wears in each. */
export const SCHEMES = { dark: "vs-dark", light: "vs" };

/** Settings under which the window wears a theme of high contrast in each scheme, and the classes that it has then. */
export const HIGH_CONTRAST = {
  settings: {
    "workbench.preferredDarkColorTheme": "Default High Contrast",
    "workbench.preferredLightColorTheme": "Default High Contrast Light",
  },
  schemes: { dark: "hc-black", light: "hc-light" },
};

const GROUP = ".editor-group-container.active";
const EDITOR = `${GROUP} .editor-instance .monaco-editor`;

export class Workbench {
  /** @param {import("playwright-core").Page} page */
  constructor(page) {
    this.page = page;
    this.errors = page.locator(`${EDITOR} .squiggly-error`);
    this.status = page.locator(`[id="robbdd.robbdd-workbench.robbdd.status"]`);
    this.notifications = page.locator(".notifications-toasts .notification-list-item");
  }

  /** Open the workbench at an address and wait until it can be used. */
  static async open(page, address) {
    page.setDefaultTimeout(PATIENCE);
    await page.goto(address);
    await page.locator(".explorer-folders-view .monaco-list-row").first().waitFor();
    return new Workbench(page);
  }

  /** Open a file of the workspace by its name or the end of its path. */
  async openFile(path) {
    const input = await this.#quickInput("Control+P");
    await input.fill(path);
    const name = path.split("/").at(-1);
    await this.page.locator(".quick-input-list .monaco-list-row.focused", { hasText: name }).waitFor();
    await this.page.keyboard.press("Enter");
    await this.page.locator(`${GROUP} .tab.active[data-resource-name="${name}"]`).waitFor();
    await this.page.locator(`${EDITOR} .view-line`).first().waitFor();
  }

  /** Run a command of the palette by its full title. */
  async command(title) {
    const input = await this.#quickInput("F1");
    await input.fill(`>${title}`);
    await this.page.locator(".quick-input-list .monaco-list-row.focused", { hasText: title }).waitFor();
    await this.page.keyboard.press("Enter");
  }

  /** Change the system's colour scheme, which the theme follows, and wait until the window has changed. */
  async changeScheme(scheme, schemes = SCHEMES) {
    await this.page.emulateMedia({ colorScheme: scheme });
    await this.page.locator(`.monaco-workbench.${schemes[scheme]}`).waitFor();
  }

  /** Put the cursor before a character; lines and columns count from 1. */
  async goTo(line, column) {
    const input = await this.#quickInput("Control+G");
    await input.fill(`:${line}:${column}`);
    await this.page.keyboard.press("Enter");
    await this.page.locator(".quick-input-widget").waitFor({ state: "hidden" });
  }

  /** Give the active editor the keyboard. */
  async focusEditor() {
    await this.command("View: Focus Active Editor Group");
  }

  async type(text) {
    await this.page.keyboard.type(text);
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

  /** Wait until nothing is underlined as an error any more. */
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

  /** A code lens of the active editor by its text. */
  codeLens(text) {
    return this.page.locator(`${EDITOR} .codelens-decoration a`, { hasText: text });
  }

  /** The visible lines of the active editor that match, with their inlay hints in the text. */
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

  /** The colour of the first verdict beside a clause and that of the ground it stands on. */
  async verdictColours() {
    // In one go: the editor may draw its lines anew at any time.
    const found = await this.page.waitForFunction((selector) => {
      const hint = [...document.querySelectorAll(selector)].find((span) => /[✔✗]/.test(span.textContent));
      const ground = hint?.closest(".monaco-editor-background, .monaco-editor");
      return ground ? [getComputedStyle(hint).color, getComputedStyle(ground).backgroundColor] : undefined;
    }, `${EDITOR} .view-line span > span`);
    return found.jsonValue();
  }

  /** Wait for the toast with this text and return it. */
  async notification(text) {
    const toast = this.notifications.filter({ hasText: text }).first();
    await toast.waitFor();
    return toast;
  }

  /** The page of the panel with a web view that is in front: the last, since for a moment a panel stays in sight beside the one that takes its place. */
  webview() {
    return this.page.locator("iframe.webview.ready:visible").last().contentFrame().frameLocator("#active-frame");
  }

  /** Load the window again, as after a crash or an update, and wait until it can be used. */
  async reload() {
    await this.page.reload();
    await this.page.locator(".explorer-folders-view .monaco-list-row").first().waitFor();
  }

  /** Write a picture of the whole window below the build output. */
  async screenshot(name) {
    const path = join(SCREENSHOTS, `${name}.png`);
    await mkdir(dirname(path), { recursive: true });
    await this.page.screenshot({ path });
    return path;
  }

  async #quickInput(key) {
    const input = this.page.locator(".quick-input-widget .quick-input-filter input");
    await this.page.keyboard.press(key);
    await input.waitFor();
    return input;
  }
}
