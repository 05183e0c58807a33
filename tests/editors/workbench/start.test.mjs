// How the extension begins: it starts no server before a model is shown; and what Enter does.
import assert from "node:assert/strict";
import { chmod, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { LANGUAGE_SERVER } from "./harness/checkout.mjs";
import { story } from "./harness/story.mjs";

const STARTED = "started.txt";

/** @type {import("./harness/session.mjs").Session} */
let session;

const step = story("start", (opened) => {
  session = opened;
}, {
  settings: { "robbdd.server.path": "${workspaceFolder}/server.sh" },
  prepare: async (workspace) => {
    // Tells of each start of the server.
    const program = join(workspace, "server.sh");
    await writeFile(program, `#!/bin/sh\necho started >> "${join(workspace, STARTED)}"\nexec "${LANGUAGE_SERVER}" "$@"\n`);
    await chmod(program, 0o755);
  },
});

step("in a folder with models the extension is active, and starts no server before one is shown", async (context) => {
  const { workbench, workspace } = session;
  context.diagnostic(`activation: ${await activationTime(workbench)} ms`);
  await workbench.screenshot("start-quiet");
  assert.equal(await workbench.status.count(), 0);
  await assert.rejects(readFile(join(workspace, STARTED)), { code: "ENOENT" });

  await workbench.openFile("sorting/sorting.bdd");
  await workbench.codeLens("Run").first().waitFor({ state: "attached" });
  await workbench.statusText(/RobBDD/);
  assert.equal(await readFile(join(workspace, STARTED), "utf8"), "started\n");
});

step("a new line continues a table", async () => {
  const { workbench } = session;
  await workbench.openFile("sorting/sorting.bdd");
  const last = (await session.text("sorting/sorting.bdd")).split("\n").findLastIndex((line) => line.includes("| obj set"));
  await workbench.goTo(last + 1, 1);
  await workbench.page.keyboard.press("End");
  await workbench.page.keyboard.press("Enter");
  await workbench.type("NEXT");
  await workbench.lines("| NEXT").first().waitFor();
});

/** What the editor says that loading and activating the extension took of the extension host, in milliseconds. */
async function activationTime(workbench) {
  await workbench.command("Developer: Show Running Extensions");
  const entry = workbench.page.locator(".runtime-extensions-editor .extension", { hasText: "RobBDD Workbench" });
  const told = entry.locator(".activation-time").filter({ hasText: /\d+ms/ });
  await told.waitFor();
  return Number(/(\d+)ms/.exec(await told.textContent())[1]);
}
