// Time limits of tests: far longer than a slow machine needs, since early results end the wait.
import { setTimeout as sleep } from "node:timers/promises";

/** What an answer of the window may take, ms. */
export const PATIENCE = 3 * 60_000;
/** What executing scenarios, or installing a server, may take, ms. */
export const LONG = 10 * 60_000;
/** What one of several tries may take, ms, where the window may have missed what was done. */
export const TRY = 10_000;

/** Between two looks, ms. */
const PAUSE = 100;

/**
 * Check something until it holds: what is shown settles when it does, and a look may come in between.
 *
 * @template T
 * @param {() => T | Promise<T>} check throws, by an assertion for instance, while it does not hold
 * @param {number} [patience] ms
 * @returns {Promise<T>} what the check returns; rejects with its last error
 */
export async function eventually(check, patience = PATIENCE) {
  const deadline = Date.now() + patience;
  for (;;) {
    try {
      return await check();
    } catch (error) {
      if (Date.now() > deadline) {
        throw error;
      }
    }
    await sleep(PAUSE);
  }
}

/** How long something took, ms. */
export async function timed(task) {
  const begun = performance.now();
  await task();
  return performance.now() - begun;
}
