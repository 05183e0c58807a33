// A story that a test file tells in one session on the examples.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./checkout.mjs";
import { Session } from "./session.mjs";

/**
 * Open a session before the first step and close it after the last, with a picture where one failed.
 *
 * @param {string} name of that picture
 * @param {Partial<Parameters<typeof Session.open>[0]>} [options] of the session
 * @returns {{ told: { session: Session, workbench: Session["workbench"] }, step: (name: string, body: () => Promise<void>) => void }}
 *   what the steps share, there once they begin, and what adds a step: a later one stands on the earlier ones
 */
export function story(name, { settings = {}, ...options } = {}) {
  const told = { session: undefined, workbench: undefined };
  let failed;

  before(async () => {
    const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
    told.session = await Session.open({
      workspace: EXAMPLES,
      ...options,
      settings: { "robbdd.server.path": server, ...settings },
    });
    told.workbench = told.session.workbench;
  });

  after(async () => {
    await told.session?.close(failed === undefined ? undefined : `${name}-failed`);
  });

  function step(title, body) {
    test(title, async () => {
      assert.equal(failed, undefined, `the step before failed: ${failed}`);
      try {
        await body();
      } catch (error) {
        failed = title;
        throw error;
      }
    });
  }

  return { told, step };
}
