// A window with the extension in it, without an editor and without a server.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterEach } from "node:test";
import type { ExtensionContext } from "vscode";
import { activate, deactivate } from "../src/extension";
import { LanguageClient } from "./languageclient.kit";
import { FILE } from "./testing.kit";
import { Uri, editor } from "./vscode.kit";

export const MODEL = Uri.parse(FILE);
let storage = "";
/** What new terminals append to the variables of their environment. */
export const terminal = new Map<string, string>();
/** What the extension remembers of the workspace, as long as the test. */
const memory = new Map<string, unknown>();

afterEach(async () => {
  memory.clear();
  terminal.clear();
  await deactivate();
  rmSync(storage, { recursive: true, force: true });
});

/** Open a window; returns the folder of the extension's own files. */
export function openWindow({ trusted = true }: { readonly trusted?: boolean } = {}): string {
  editor.reset(trusted);
  LanguageClient.reset();
  storage = mkdtempSync(join(tmpdir(), "robbdd-window-"));
  editor.settings = { "server.path": process.execPath };
  const context = {
    workspaceState: {
      get: (key: string) => memory.get(key),
      update: (key: string, value: unknown) => Promise.resolve(void memory.set(key, value)),
    },
    globalStorageUri: Uri.file(join(storage, "storage")),
    extension: { id: "robbdd.robbdd-workbench", packageJSON: { version: "1.0" } },
    extensionUri: Uri.file("/extension"),
    asAbsolutePath: (path: string) => join("/extension", path),
    subscriptions: [],
    environmentVariableCollection: {
      append: (name: string, value: string) => void terminal.set(name, value),
      delete: (name: string) => void terminal.delete(name),
    },
  };
  activate(context as unknown as ExtensionContext);
  return join(storage, "storage");
}

/** Execute a command of the palette or a menu for the model. */
export async function command(name: string, target: unknown = MODEL): Promise<void> {
  const handler = editor.commands.get(name);
  assert.ok(handler, `there is no command ${name}`);
  await handler(target);
}

/** The client of the server that runs now. */
export function client(): LanguageClient {
  const latest = LanguageClient.made.at(-1);
  assert.ok(latest, "no server was started");
  return latest;
}

/** Let everything go on until something is so; a test that waits for ever is ended by the runner. */
export async function until(isSo: () => boolean): Promise<void> {
  while (!isSo()) {
    await new Promise((resolve) => setImmediate(resolve));
  }
}
