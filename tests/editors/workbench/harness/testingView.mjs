// The Testing view of a workbench: rows of its tree with their states.
import { PATIENCE } from "./workbench.mjs";

const MOST_TRIES = 6;

export class TestingView {
  /** @param {import("./workbench.mjs").Workbench} workbench */
  constructor(workbench) {
    this.workbench = workbench;
    this.page = workbench.page;
  }

  async show() {
    await this.page.locator('.activitybar .action-label[aria-label^="Testing"]').click();
  }

  /** Rows of the tree by their words. */
  row(text) {
    return this.page.locator(".test-explorer-tree .monaco-list-row", { hasText: text });
  }

  /** The rows that show a state: `passed`, `failed`, `error`, `queued`, or `run` while it is being executed. */
  rowsThat(state, text = /./) {
    const icon = this.page.locator(state === "run" ? ".computed-state.codicon-loading" : `.codicon-testing-${state}-icon`);
    return this.row(text).filter({ has: icon });
  }

  async expand(text) {
    const found = this.row(text).first();
    const expanded = found.and(this.page.locator('[aria-expanded="true"]'));
    await found.waitFor();
    // While the tree is being filled its rows move, and a click may meet nothing.
    for (let tries = 0; tries < MOST_TRIES && !(await expanded.isVisible()); tries += 1) {
      // The words about the row that was pointed at last may cover this one.
      await this.page.mouse.move(0, 0);
      await found.click();
      await this.page.keyboard.press("ArrowRight");
      await expanded.waitFor({ timeout: PATIENCE / MOST_TRIES }).catch(() => {});
    }
    await expanded.waitFor();
  }

  async collapse(text) {
    await this.row(text).first().click();
    await this.page.keyboard.press("ArrowLeft");
    await this.row(text).first().and(this.page.locator('[aria-expanded="false"]')).waitFor();
  }

  async runRow(text) {
    await this.press(text, ".codicon-testing-run-icon");
  }

  /** Press an icon of a row. It is there while the row is pointed at. */
  async press(text, icon) {
    const found = this.row(text).first();
    const button = found.locator(icon).first();
    await found.waitFor();
    for (let tries = 1; ; tries += 1) {
      try {
        await found.hover({ timeout: PATIENCE / MOST_TRIES });
        await button.click({ timeout: PATIENCE / MOST_TRIES });
        return;
      } catch (error) {
        // While the tree is being filled its rows move away from under the pointer.
        if (tries === MOST_TRIES) {
          throw error;
        }
        await this.page.mouse.move(0, 0);
      }
    }
  }

  /** Choose an entry of a row's menu. */
  async choose(text, entry) {
    await this.row(text).first().click({ button: "right" });
    const item = this.page.locator(".context-view .action-menu-item", { hasText: entry }).first();
    await item.waitFor();
    // A click on an entry is swallowed while the menu is being opened.
    await item.hover();
    await this.page.keyboard.press("Enter");
  }
}
