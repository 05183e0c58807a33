import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { withoutControls, withoutIcons, withoutLinks } from "../src/literal";
import { labelOf } from "../src/testing/facts";
import type { ListedTest } from "../src/testing/listing";

const SOURCE = join(__dirname, "..", "..", "src");

/** What the editor makes of a label, by its own expression for icons (src/vs/base/browser/ui/iconLabel/iconLabels.ts). */
function drawn(label: string): { readonly text: string; readonly icons: number } {
  let icons = 0;
  const text = label.replace(/(\\)?\$\(([A-Za-z0-9-]+(?:~[A-Za-z]+)?)\)/g, (_, escaped: string | undefined, name: string) => {
    icons += escaped === undefined ? 1 : 0;
    return escaped === undefined ? "" : `$(${name})`;
  });
  return { text, icons };
}

for (const text of ["$(bug) it", "$(sync~spin)", "\\$(bug)", "a $(b) $(c)", "$(not an icon) costs $5", "$$(bug)", ""]) {
  test(`a label shows the letters of ${JSON.stringify(text)} and no icon`, () => {
    assert.deepEqual(drawn(withoutIcons(text)), { text, icons: 0 });
  });
}

test("a notification has no link of a user", () => {
  // The editor's expression for links in notifications (src/vs/base/common/linkedText.ts).
  const link = /\[([^\]]+)\]\(((?:https?:\/\/|command:|file:)[^)\s]+)(?: (["'])(.+?)(\3))?\)/i;
  const text = "no scenario [click here](command:workbench.action.terminal.new)";
  assert.match(text, link);
  assert.doesNotMatch(withoutLinks(text), link);
  assert.equal(withoutLinks(text).replaceAll("\u200b", ""), text);
});

test("a line of a run does not act on the terminal that shows it", () => {
  assert.equal(withoutControls("\u001b]8;;https://e.org\u0007go\u001b[2J\tend\r"), "\\x1b]8;;https://e.org\\x07go\\x1b[2J\tend\\x0d");
  assert.equal(withoutControls("one\ntwo\r\nthree"), "one\r\ntwo\r\nthree");
});

test("a test's label shows the user's words as they are", () => {
  const listed = { name: "$(bug) holds", role: "then" } as ListedTest;
  assert.deepEqual(drawn(labelOf(listed)), { text: "Then $(bug) holds", icons: 0 });
});

test("messages to the user go through the module that takes links out of them", () => {
  const files = readdirSync(SOURCE, { recursive: true, encoding: "utf-8" }).filter((name) => name.endsWith(".ts"));
  const own = files.filter((name) => {
    const text = readFileSync(join(SOURCE, name), "utf-8");
    const calls = text.match(/show(?:Information|Warning|Error)Message\((?!message, (?:modal|begin))/g) ?? [];
    return calls.length > 0;
  });
  assert.deepEqual(own, ["notices.ts"]);
});

test("entries of choices that name what users wrote show no icons of theirs", () => {
  for (const name of ["models.ts", "panels/replay/choice.ts", "runs/chooser.ts"]) {
    const text = readFileSync(join(SOURCE, name), "utf-8");
    const entries = text.match(/(?:label|description|detail): [^"\s][^,}\n]*/g) ?? [];
    const raw = entries.filter((entry) => !/withoutIcons|: string|SIGNS|Run \$\{run\.run/.test(entry));
    assert.deepEqual(raw, [], name);
  }
});
