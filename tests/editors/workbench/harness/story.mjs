// A sequence of test steps in one session on the examples.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./checkout.mjs";
import { Session } from "./session.mjs";

/** What several stories share: one window on the examples, since to load one takes longer than most of what is tested in it. */
export class SharedWindow {
  /** @type {Session | undefined} */
  #session;

  /** Open the window, or begin anew in it. */
  async open(options) {
    if (this.#session === undefined) {
      this.#session = await Session.open(options);
    } else {
      await this.#session.renew(options.workspace, options.prepare);
    }
    return this.#session;
  }

  /** Leave the window to the next story, or close it after a failure. */
  async leave(failure) {
    if (failure !== undefined) {
      await this.close(failure);
    }
  }

  async close(failure) {
    const session = this.#session;
    this.#session = undefined;
    await session?.close(failure);
  }
}

/**
 * Open a session before the first step and close it after the last, with a picture where one failed.
 *
 * @param {string} name of that picture
 * @param {(session: Session) => void} opened takes the session before the first step
 * @param {Partial<Parameters<typeof Session.open>[0]> & { window?: SharedWindow }} [options] of the session, and the window in
 *   which it is to be
 * @returns {(title: string, body: (context: import("node:test").TestContext) => Promise<void>) => void} what adds a step:
 *   a later one stands on the earlier ones
 */
export function story(name, opened, { window, settings = {}, ...options } = {}) {
  /** @type {Session} */
  let session;
  let failed;

  before(async () => {
    const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
    const wanted = { workspace: EXAMPLES, ...options, settings: { "robbdd.server.path": server, ...settings } };
    session = await (window?.open(wanted) ?? Session.open(wanted));
    opened(session);
  });

  after(async () => {
    const failure = failed === undefined ? undefined : `${name}-failed`;
    await (window?.leave(failure) ?? session?.close(failure));
  });

  return function step(title, body) {
    test(title, async (context) => {
      assert.equal(failed, undefined, `the step before failed: ${failed}`);
      try {
        await body(context);
      } catch (error) {
        failed = title;
        throw error;
      }
    });
  };
}
