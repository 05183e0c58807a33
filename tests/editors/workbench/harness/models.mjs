// Models derived from the examples for stories; runs of the command line before a story.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdir, writeFile } from "node:fs/promises";
import { basename, dirname, join } from "node:path";
import { promisify } from "node:util";
import { LANGUAGE_SERVER } from "./checkout.mjs";

/** Steps of a user's own, under which the ball of the pick-and-place example is on its way for ever. */
const ENDLESS = `import time

from behave import when


@when('"{agent}" picks "env:ball0" and places it at "{workspace}"')
def wait(context, agent, workspace):
    while True:
        time.sleep(1)
`;

/** Write a model of the pick-and-place example whose run judges the cube, and then lasts until it is cancelled. */
export async function writeEndless(path, text) {
  const steps = join(dirname(path), "steps");
  await mkdir(steps, { recursive: true });
  await writeFile(path, text);
  await writeFile(join(steps, basename(path).replace(".bdd", "_steps.py")), ENDLESS);
}

/** The pick-and-place example in another namespace, with another story and scenario name. */
export function renamed(text, namespace, story, scenario) {
  return text
    .replace("https://example.org/robbdd/criteria/", `https://example.org/robbdd/${namespace}/`)
    .replace("tidy-bench", story)
    .replace("part-to-bin", scenario);
}

/** Execute the scenarios of a model that have these values, and keep the run; its summary is expected to read so. */
export function execute(path, values, expected) {
  return command(["run", path, "--where", values], expected);
}

/** Execute a study; its summary is expected to read so. */
export function study(path, expected) {
  return command(["study", "run", path], expected);
}

async function command(args, expected) {
  const robbdd = join(dirname(LANGUAGE_SERVER), "robbdd");
  // It ends with 1 where something is violated.
  const { stdout } = await promisify(execFile)(robbdd, args).catch((error) => error);
  assert.match(stdout, expected);
}
