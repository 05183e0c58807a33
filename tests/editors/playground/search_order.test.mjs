// The order of search results on the site: guides before reference, pages on the project last.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";
import { runInNewContext } from "node:vm";
import { ROOT } from "../workbench/harness/checkout.mjs";

const SIDEBAR = {
  "How to": ["robots", "logs", "changelog"],
  Reference: ["files"],
  Examples: ["examples/ownrobot"],
  Project: ["ARCHITECTURE"],
};

function page() {
  const captions = Object.entries(SIDEBAR).map(([title, pages]) => ({
    textContent: title,
    nextElementSibling: { querySelectorAll: () => pages.map((name) => ({ getAttribute: () => `${name}.html` })) },
  }));
  return { querySelectorAll: () => captions };
}

test("of pages with equal scores, guides are first and pages on the project last", async () => {
  const context = { document: page() };
  runInNewContext(await readFile(join(ROOT, "docs/site/search_order.js"), "utf8"), context);
  const score = (name) => context.Scorer.score([name, "", "", null, 5, `${name}.md`]);
  const names = ["ARCHITECTURE", "examples/ownrobot", "files", "changelog", "logs", "robots"];
  const order = names.toSorted((one, other) => score(other) - score(one));
  assert.deepEqual(order.slice(0, 2), ["robots", "logs"]);
  assert.equal(order.at(-1), "ARCHITECTURE");
  assert.ok(score("files") > score("examples/ownrobot"));
  assert.ok(score("changelog") < score("files"));
});
