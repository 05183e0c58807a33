// A sequence of test steps in one session on the examples.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./checkout.mjs";
import { Session } from "./session.mjs";

/**
 * Open a session before the first step and close it after the last, with a picture where one failed.
 *
 * @param {string} name of that picture
 * @param {(session: Session) => void} opened takes the session before the first step
 * @param {Partial<Parameters<typeof Session.open>[0]>} [options] of the session
 * @returns {(title: string, body: (context: import("node:test").TestContext) => Promise<void>) => void} what adds a step:
 *   a later one stands on the earlier ones
 */
export function story(name, opened, { settings = {}, ...options } = {}) {
  /** @type {Session} */
  let session;
  let failed;

  before(async () => {
    const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
    session = await Session.open({
      workspace: EXAMPLES,
      ...options,
      settings: { "robbdd.server.path": server, ...settings },
    });
    opened(session);
  });

  after(async () => {
    await session?.close(failed === undefined ? undefined : `${name}-failed`);
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
