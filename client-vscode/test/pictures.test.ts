// Icons in the interface: each exists in the font of the oldest editor that the extension runs in.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { nextPlace } from "../webviews/shared/roving";

const MAPPING = JSON.parse(readFileSync("node_modules/@vscode/codicons/src/template/mapping.json", "utf8")) as Readonly<Record<string, number>>;

test("every icon that a text or the manifest names is in the icon font", () => {
  const sources = readdirSync("src", { recursive: true, encoding: "utf8" }).filter((path) => path.endsWith(".ts"));
  const texts = ["package.json", ...sources.map((path) => join("src", path))].map((path) => readFileSync(path, "utf8"));
  const named = texts.flatMap((text) => [...text.matchAll(/\$\(([a-z][a-z-]*)(?:~spin)?\)/g)].map(([, name = ""]) => name));
  assert.ok(named.length > 20, "the pattern finds them");
  assert.deepEqual(named.filter((name) => !(name in MAPPING)), []);
});

test("the icon font is that of the oldest editor", () => {
  const { engines, devDependencies } = JSON.parse(readFileSync("package.json", "utf8")) as {
    readonly engines: Readonly<Record<string, string>>;
    readonly devDependencies: Readonly<Record<string, string>>;
  };
  // VS Code 1.91 has this one; a newer one has icons that it lacks.
  assert.deepEqual([engines["vscode"], devDependencies["@vscode/codicons"]], ["^1.91.0", "0.0.36"]);
});

test("arrow keys go round a toolbar, and leave other keys alone", () => {
  const press = (key: string, place: number, held = {}) => {
    return nextPlace({ key, ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, ...held }, place, 4);
  };
  assert.deepEqual([press("ArrowRight", 0), press("ArrowRight", 3), press("ArrowLeft", 0), press("ArrowLeft", 2)], [1, 0, 3, 1]);
  assert.deepEqual([press("Home", 2), press("End", 1)], [0, 3]);
  assert.deepEqual([press("ArrowDown", 0), press("Enter", 0), press("ArrowRight", 0, { shiftKey: true })], [undefined, undefined, undefined]);
  assert.equal(nextPlace({ key: "End", ctrlKey: false, metaKey: false, altKey: false, shiftKey: false }, 0, 0), undefined);
});
