// The extension without a language server: colours, and messages.
import assert from "node:assert/strict";
import { chmod, mkdir, readFile, writeFile } from "node:fs/promises";
import { delimiter, dirname, join } from "node:path";
import { afterEach, test } from "node:test";
import { SAMPLES } from "./harness/checkout.mjs";
import { eventually } from "./harness/patience.mjs";
import { Session } from "./harness/session.mjs";
import { SCHEMES } from "./harness/workbench.mjs";

/** A PATH with the tools the editor needs and, on a developer's machine too, no language server. */
const BARE_PATH = ["/usr/bin", "/bin", dirname(process.execPath)].join(delimiter);

/** @type {Session | undefined} */
let session;
let passed = false;

afterEach(async (context) => {
  await session?.close(passed ? undefined : context.name.replaceAll(/\W+/g, "-"));
  session = undefined;
  passed = false;
});

test("without a language server words have colours, and a message offers to install it and leads to the setting", async () => {
  session = await Session.open({ workspace: SAMPLES, searchPath: BARE_PATH });
  const { workbench } = session;
  await workbench.openFile("sorting.bdd");
  // It stays while it is pointed at.
  const message = await workbench.notification("It can be installed");
  for (const scheme of Object.keys(SCHEMES)) {
    await workbench.changeScheme(scheme);
    const words = ["Scenario Template", "sorting", "Given", "does not drop", "evt-begin", "0.5", '"machinist"', "carry"];
    await eventually(async () => {
      const colours = new Map();
      for (const word of words) {
        colours.set(word, await workbench.colourOf(word));
      }
      // Eight words of seven kinds: the template and the behaviour are both declared here, so they look alike.
      assert.equal(colours.get("sorting"), colours.get("carry"));
      assert.equal(new Set(colours.values()).size, 7, JSON.stringify([...colours]));
    });
    await workbench.screenshot(`colours-${scheme}`);
  }
  await workbench.statusText(/RobBDD/);
  await workbench.screenshot("server-missing");
  await message.getByRole("button", { name: "Open Setting" }).click();
  await workbench.page.locator(".settings-editor .setting-item-contents", { hasText: "Server: Path" }).waitFor();
  passed = true;
});

test("a server that ends at once is reported, with its last words in the log", async () => {
  session = await Session.open({
    workspace: SAMPLES,
    searchPath: BARE_PATH,
    prepare: (workspace) => bringServer(workspace, 'echo "ImportError: half an installation" >&2; exit 1'),
  });
  const { workbench } = session;
  await workbench.openFile("sorting.bdd");
  const message = await workbench.notification(".venv/bin/robbdd-lsp");
  assert.equal(await workbench.notifications.count(), 1, "it is said once");
  await message.getByRole("button", { name: "Show Log" }).click();
  const output = workbench.page.locator(".part.panel .view-lines");
  await output.filter({ hasText: /ImportError:\shalf\san\sinstallation/ }).waitFor();
  await workbench.screenshot("server-broken");
  // Nothing comes after it.
  await workbench.notifications.first().waitFor({ state: "detached" });
  passed = true;
});

test("an untrusted workspace cannot provide a server", async () => {
  const marker = (workspace) => join(workspace, "started");
  session = await Session.open({
    workspace: SAMPLES,
    searchPath: BARE_PATH,
    trust: false,
    prepare: async (workspace) => {
      const program = await bringServer(workspace, `touch "${marker(workspace)}"`);
      await mkdir(join(workspace, ".vscode"));
      await writeFile(join(workspace, ".vscode/settings.json"), JSON.stringify({ "robbdd.server.path": program }));
    },
  });
  const { workbench, workspace } = session;
  await workbench.openFile("sorting.bdd");
  await workbench.notification("The workspace is not trusted");
  await assert.rejects(readFile(marker(workspace)), { code: "ENOENT" });
  passed = true;
});

/** Put a program in the place of the language server of a workspace's own environment; return its path. */
async function bringServer(workspace, script) {
  const program = join(workspace, ".venv/bin/robbdd-lsp");
  await mkdir(dirname(program), { recursive: true });
  await writeFile(program, `#!/bin/sh\n${script}\n`);
  await chmod(program, 0o755);
  return program;
}
