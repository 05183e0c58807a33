import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

interface Entry {
  readonly command: string;
  readonly when?: string;
}

interface Command extends Entry {
  readonly category: string;
  readonly title: string;
}

interface Colour {
  readonly id: string;
  readonly defaults: Readonly<Record<string, string>>;
}

interface Manifest {
  readonly contributes: {
    readonly colors: readonly Colour[];
    readonly commands: readonly Command[];
    readonly menus: Readonly<Record<string, readonly Entry[]>>;
  };
}

const { contributes } = JSON.parse(text("package.json")) as Manifest;
const palette = new Map(contributes.menus["commandPalette"]?.map(({ command, when }) => [command, when]));

test("the palette groups all commands, and each does something", () => {
  assert.deepEqual(new Set(contributes.commands.map(({ category }) => category)), new Set(["RobBDD"]));
  const handled = [...text("src/commands.ts").matchAll(/^ {4}"(robbdd\.\w+)":/gm)].map(([, name]) => name);
  const declared = contributes.commands.map(({ command }) => command);
  // What a click on the status item opens is of no use elsewhere.
  assert.deepEqual([...declared, "robbdd.statusActions"].sort(), handled.sort());
});

test("every menu leads to a command", () => {
  const declared = new Set(contributes.commands.map(({ command }) => command));
  const used = Object.values(contributes.menus).flatMap((entries) => entries.map(({ command }) => command));
  assert.deepEqual(used.filter((command) => !declared.has(command)), []);
});

test("commands on a file or the workspace are offered only where there is one", () => {
  for (const { command, title } of contributes.commands.filter((one) => /File|Gherkin|Graph|Replay|Study/.test(one.title))) {
    const executions = title.includes("This File") ? " || editorLangId == robbdd-bddx" : "";
    const study = ["Run Study", "Resume Study", "Show Results of Study"].includes(title) ? "-study" : "";
    const both = title === "Show Study…" ? " || editorLangId == robbdd-study" : "";
    assert.ok([`editorLangId == robbdd${study}${executions}${both}`, "false"].includes(palette.get(command) ?? ""), title);
  }
  assert.equal(palette.get("robbdd.importResults"), "workspaceFolderCount > 0");
  assert.equal(palette.get("robbdd.openModel"), "workspaceFolderCount > 0");
});

test("the readme lists every command of the palette", () => {
  const told = [...text("README.md").matchAll(/^\| RobBDD: (.*?) \|/gm)].map(([, title]) => title);
  const offered = contributes.commands.filter(({ command }) => palette.get(command) !== "false");
  assert.deepEqual(told.sort(), offered.map(({ title }) => title).sort());
});

test("each look of a verdict has a colour, which every kind of theme gives it", () => {
  const looks = ["holds", "violated", "unknown", "stale"];
  assert.deepEqual(contributes.colors.map(({ id }) => id), looks.map((look) => `robbdd.${look}Foreground`));
  for (const { id, defaults } of contributes.colors) {
    assert.deepEqual(Object.keys(defaults).sort(), ["dark", "highContrast", "highContrastLight", "light"], id);
    assert.ok(Object.values(defaults).every((colour) => !colour.startsWith("#")), `${id} has a colour of its own`);
  }
});

function text(path: string): string {
  return readFileSync(join(process.cwd(), path), "utf8");
}

test("the pages in the package have no links to files that are not in it", () => {
  for (const page of ["README.md", "CHANGELOG.md"]) {
    assert.deepEqual([...text(page).matchAll(/\]\(\.\.[^)]*\)/g)].map(String), [], page);
  }
});
