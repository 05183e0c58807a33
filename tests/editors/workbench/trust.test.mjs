// A workspace that is not trusted: edited and checked as any other, but nothing of it is run.
import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { EXAMPLES, LANGUAGE_SERVER, required } from "./harness/checkout.mjs";
import { Session } from "./harness/session.mjs";

/** @type {Session} */
let session;
let passed = false;

before(async () => {
  const server = required(LANGUAGE_SERVER, "install robbdd-tools, or name its robbdd-lsp in ROBBDD_LSP");
  session = await Session.open({
    workspace: EXAMPLES,
    trust: false,
    settings: { "robbdd.server.path": server },
    prepare: async (workspace) => {
      await mkdir(join(workspace, "pickplace/steps"));
      const steps = 'from pathlib import Path\nPath(__file__).with_name("imported").touch()\n';
      await writeFile(join(workspace, "pickplace/steps/pickplace_steps.py"), steps);
    },
  });
});

after(async () => {
  await session?.close(passed ? undefined : "trust-failed");
});

test("an untrusted workspace is checked, and a run is refused with the way to trust it", async () => {
  const { workbench, workspace } = session;
  await workbench.openFile("pickplace/pickplace.bdd");
  await workbench.codeLens("Run").first().waitFor();
  assert.equal(await workbench.errors.count(), 0);
  await workbench.goTo(1, 1);
  await workbench.type("import 'no-such.scene' ");
  await workbench.waitForError();
  await workbench.command("File: Revert File");
  await workbench.waitForNoError();

  await workbench.codeLens("Run").first().click();
  const refusal = await workbench.notification("scenarios run code of this workspace");
  await workbench.screenshot("trust-refused");
  await assert.rejects(readFile(join(workspace, "pickplace/steps/imported")), { code: "ENOENT" });
  await refusal.hover();
  await refusal.getByRole("button", { name: "Manage Workspace Trust" }).click();
  await workbench.page.locator(".workspace-trust-editor").waitFor();
  await workbench.page.getByRole("button", { name: "Trust", exact: true }).first().click();

  await workbench.openFile("pickplace/pickplace.bdd");
  await workbench.statusText(/RobBDD/);
  await workbench.codeLens("Run").first().waitFor();
  passed = true;
});
