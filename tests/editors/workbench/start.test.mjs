// What the extension brings by itself: its size, and what Enter does.
import assert from "node:assert/strict";
import { stat } from "node:fs/promises";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, VSIX, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";

const LARGEST = 2 * 1024 * 1024;

/** @type {Session} */
let session;
let passed = false;

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({
    workspace: EXAMPLES,
    settings: { "robbdd.server.path": server },
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

test("a new line goes on with a table", async () => {
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
