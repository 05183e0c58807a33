// Models that stories need beside the examples, made of them.
import assert from "node:assert/strict";

const REPETITIONS = 10;

/** The example with its first scenario repeated under other names: long enough to be cancelled while it runs. */
export function lengthened(text) {
  const block = /^ {8}Scenario (?<name>[\w-]+) \{\n[^]*?^ {8}\}\n/m.exec(text);
  assert.ok(block !== null, "the example has no scenario of the expected layout");
  const { name } = block.groups;
  const copies = Array.from({ length: REPETITIONS }, (_, index) => block[0].replace(name, `${name}-${index}`));
  return text.replace(block[0], copies.join(""));
}

/** The pick-and-place example in a namespace of its own, its story and its scenario under other names. */
export function renamed(text, namespace, story, scenario) {
  return text
    .replace("https://example.org/robbdd/criteria/", `https://example.org/robbdd/${namespace}/`)
    .replace("tidy-bench", story)
    .replace("part-to-bin", scenario);
}
