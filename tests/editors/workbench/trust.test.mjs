// A workspace that is not trusted: edited and checked as any other, but nothing of it is run.
import assert from "node:assert/strict";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { story } from "./harness/story.mjs";

/** @type {import("./harness/session.mjs").Session} */
let session;

const step = story("trust", (opened) => {
  session = opened;
}, {
  trust: false,
  prepare: async (workspace) => {
    await mkdir(join(workspace, "pickplace/steps"));
    const steps = 'from pathlib import Path\nPath(__file__).with_name("imported").touch()\n';
    await writeFile(join(workspace, "pickplace/steps/pickplace_steps.py"), steps);
  },
});

step("an untrusted workspace is checked, and a run is refused with the way to trust it", async () => {
  const { workbench, workspace } = session;
  await workbench.openFile("pickplace/pickplace.bdd");
  await workbench.codeLens("Run").first().waitFor();
  await workbench.waitForNoError();
  await workbench.goTo(1, 1);
  await workbench.type("import 'no-such.scene' ");
  await workbench.waitForError();
  await workbench.command("File: Revert File");
  await workbench.waitForNoError();

  await workbench.codeLens("Run").first().click();
  const refusal = await workbench.notification("scenarios run code of this workspace");
  await workbench.screenshot("trust-refused");
  await assert.rejects(readFile(join(workspace, "pickplace/steps/imported")), { code: "ENOENT" });
  await refusal.getByRole("button", { name: "Manage Workspace Trust" }).click();
  await workbench.page.locator(".workspace-trust-editor").waitFor();
  await workbench.page.getByRole("button", { name: "Trust", exact: true }).first().click();

  await workbench.openFile("pickplace/pickplace.bdd");
  await workbench.statusText(/RobBDD/);
  await workbench.codeLens("Run").first().waitFor();
});
