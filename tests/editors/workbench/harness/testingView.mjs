// The Testing view of a workbench: rows of its tree with their states.
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { EXAMPLES } from "./checkout.mjs";
import { LONG, TRY, eventually } from "./patience.mjs";
import { story } from "./story.mjs";

const EXPANDED = '[aria-expanded="true"]';

export class TestingView {
  /** @param {import("./workbench.mjs").Workbench} workbench */
  constructor(workbench) {
    this.workbench = workbench;
    this.page = workbench.page;
  }

  async show() {
    await this.workbench.command("Testing: Focus on Test Explorer View");
    await this.page.locator(".test-explorer-tree").waitFor();
  }

  /** Rows of the tree by their words. */
  row(text) {
    return this.page.locator(".test-explorer-tree .monaco-list-row", { hasText: text });
  }

  /** The rows that show a state: `passed`, `failed`, `error`, `queued`, `skipped`, or `run` while it is being executed. */
  rowsThat(state, text = /./) {
    const icon = this.page.locator(state === "run" ? ".computed-state.codicon-loading" : `.codicon-testing-${state}-icon`);
    return this.row(text).filter({ has: icon });
  }

  /** Wait until a row shows a state; executing comes before it. */
  async turns(state, text) {
    await this.rowsThat(state, text).first().waitFor({ timeout: LONG });
  }

  async expand(text) {
    const found = this.row(text).first();
    const expanded = found.and(this.page.locator(EXPANDED));
    await found.waitFor();
    // While the tree is being filled its rows move, and a click may meet nothing.
    await eventually(async () => {
      if (!(await expanded.isVisible())) {
        await this.#select(found);
        await this.page.keyboard.press("ArrowRight");
      }
      await expanded.waitFor({ timeout: TRY });
    });
  }

  async collapse(text) {
    const found = this.row(text).first();
    const collapsed = found.and(this.page.locator('[aria-expanded="false"]'));
    await eventually(async () => {
      if (!(await collapsed.isVisible())) {
        await this.#select(found);
        await this.page.keyboard.press("ArrowLeft");
      }
      await collapsed.waitFor({ timeout: TRY });
    });
  }

  async runRow(text) {
    await this.press(text, ".codicon-testing-run-icon");
  }

  /** Press an icon of a row. It is there while the row is pointed at. */
  async press(text, icon) {
    const found = this.row(text).first();
    const button = found.locator(icon).first();
    await found.waitFor();
    // While the tree is being filled its rows move away from under the pointer.
    await eventually(async () => {
      await this.page.mouse.move(0, 0);
      await found.hover({ timeout: TRY });
      await button.click({ timeout: TRY });
    });
  }

  /** Choose an entry of a row's menu. */
  async choose(text, entry) {
    const found = this.row(text).first();
    const item = this.page.locator(".context-view .action-menu-item", { hasText: entry }).first();
    await found.waitFor();
    await eventually(async () => {
      await this.#select(found, "right");
      await item.waitFor({ timeout: TRY });
    });
    // A click on an entry is swallowed while the menu is being opened.
    await item.hover();
    await this.page.keyboard.press("Enter");
    await item.waitFor({ state: "hidden" });
  }

  async #select(row, button = "left") {
    // The words about the row that was pointed at last may cover this one.
    await this.page.mouse.move(0, 0);
    await row.click({ button, timeout: TRY });
  }
}

/**
 * A story that is told in the Testing view of the pick-and-place example.
 *
 * @param {string} name as `story` has it
 * @param {(session: import("./session.mjs").Session, tests: TestingView) => void} opened takes what was opened
 * @param {(text: string, workspace: string) => Promise<void>} prepare takes the text of the example's model
 */
export function testingStory(name, opened, prepare) {
  return story(name, (session) => opened(session, new TestingView(session.workbench)), {
    workspace: join(EXAMPLES, "pickplace"),
    settings: { "testing.automaticallyOpenPeekView": "never" },
    prepare: async (workspace) => prepare(await readFile(join(workspace, "pickplace.bdd"), "utf8"), workspace),
  });
}
