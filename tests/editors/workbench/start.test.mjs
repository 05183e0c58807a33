// What the extension costs: its size, no work without a model, and the time that its activation takes.
import assert from "node:assert/strict";
import { stat, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, VSIX, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";

const LARGEST = 2 * 1024 * 1024;
const NAME = "RobBDD Workbench";

/** @type {Session} */
let session;
let passed = false;

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({
    workspace: EXAMPLES,
    settings: {
      "robbdd.server.path": server,
      "window.autoDetectColorScheme": false,
      "workbench.colorTheme": "Default High Contrast",
    },
    prepare: (workspace) => writeFile(join(workspace, "notes.txt"), "Nothing of ours.\n"),
  });
});

after(async () => {
  await session?.close(passed ? undefined : "start-failed");
});

test("the extension is packed into less than 2 MB", async (context) => {
  const { size } = await stat(VSIX);
  context.diagnostic(`${(size / 1024).toFixed(0)} KB`);
  assert.ok(size < LARGEST, `${size} bytes`);
});

test("no server runs until a model is shown; the time that the activation took is told", async (context) => {
  const { workbench } = session;
  await workbench.openFile("notes.txt");
  // The folder has models, for which the Testing view is made ready; no more than that.
  await workbench.status.waitFor();
  assert.match(await workbench.status.getByRole("button").getAttribute("aria-label"), /server is stopped/);
  await workbench.openFile("pickplace/pickplace.bdd");
  await workbench.codeLens("Run").first().waitFor();
  const time = await activation(workbench);
  assert.notEqual(time, undefined);
  context.diagnostic(`activated in ${time} ms of the extension host`);
  await workbench.screenshot("running-extensions");
  passed = true;
});

test("a model can be read in high contrast", async () => {
  passed = false;
  const { workbench } = session;
  await workbench.openFile("pickplace/pickplace.bdd");
  await workbench.codeLens("Run").first().waitFor();
  await workbench.screenshot("high-contrast");
  const colours = [await workbench.colourOf("Scenario Template"), await workbench.colourOf("pick-place")];
  assert.equal(new Set(colours).size, 2, String(colours));
  passed = true;
});

test("a new line goes on with a table", async () => {
  passed = false;
  const { workbench } = session;
  await workbench.openFile("sorting/sorting.bdd");
  const last = (await session.text("sorting/sorting.bdd")).split("\n").findLastIndex((line) => line.includes("| obj set"));
  await workbench.goTo(last + 1, 1);
  await workbench.page.keyboard.press("End");
  await workbench.page.keyboard.press("Enter");
  await workbench.type("NEXT");
  await workbench.lines("| NEXT").first().waitFor();
  passed = true;
});

/** The ms that the extension host says it took to activate the extension; undefined when it is not active. */
async function activation(workbench) {
  await workbench.command("Developer: Show Running Extensions");
  const rows = workbench.page.locator(".runtime-extensions-editor .monaco-list-row");
  await rows.first().waitFor();
  const ours = rows.filter({ hasText: NAME });
  const text = (await ours.count()) > 0 ? await ours.first().textContent() : "";
  const time = /Activation:\s*(\d+)\s*ms/i.exec(text)?.[1];
  return time === undefined ? undefined : Number(time);
}
