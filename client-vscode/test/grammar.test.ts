import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { basename, extname, join } from "node:path";
import { test } from "node:test";
import { OnigScanner, OnigString, loadWASM } from "vscode-oniguruma";
import { INITIAL, Registry, type IRawGrammar } from "vscode-textmate";

// The tests run from client-vscode/, bundled below out/.
const SYNTAXES = join(process.cwd(), "out", "syntaxes");
const CATALOG = join(process.cwd(), "..", "server", "robbdd_tools", "catalog");

const FILES: Record<string, string> = {
  "source.robbdd.common": "common",
  "source.robbdd": "bdd",
  "source.robbdd.scene": "scene",
  "source.robbdd.scenex": "scenex",
  "source.robbdd.bddx": "bddx",
  "source.robbdd.study": "study",
  "text.gherkin.robbdd": "feature",
};

const wasm = readFileSync(createRequire(join(process.cwd(), "x.js")).resolve("vscode-oniguruma/release/onig.wasm"));
const registry = new Registry({
  onigLib: loadWASM(wasm).then(() => ({
    createOnigScanner: (patterns) => new OnigScanner(patterns),
    createOnigString: (text) => new OnigString(text),
  })),
  loadGrammar: (scope) => {
    const text = readFileSync(join(SYNTAXES, `${FILES[scope] ?? scope}.tmLanguage.json`), "utf8");
    return Promise.resolve(JSON.parse(text) as IRawGrammar);
  },
});

/** Tokens of a text as `text → innermost scope`, without white space and without tokens that have no scope. */
async function tokens(scope: string, text: string): Promise<string[]> {
  const grammar = await registry.loadGrammar(scope);
  assert.ok(grammar);
  let stack = INITIAL;
  const found: string[] = [];
  for (const line of text.split("\n")) {
    const result = grammar.tokenizeLine(line, stack);
    stack = result.ruleStack;
    for (const token of result.tokens) {
      const inner = token.scopes.at(-1);
      const part = line.slice(token.startIndex, token.endIndex).trim();
      if (part !== "" && inner !== undefined && inner !== scope) {
        found.push(`${part} → ${inner.replace(/\.robbdd$/, "")}`);
      }
    }
  }
  return found;
}

/** Fails unless every expected `text → scope` is among the tokens. */
async function expectTokens(scope: string, text: string, ...expected: string[]): Promise<void> {
  const found = await tokens(scope, text);
  for (const token of expected) {
    assert.ok(found.includes(token), `missing "${token}" among\n  ${found.join("\n  ")}`);
  }
}

test("the columns of a set in a scene have the colour of properties", async () => {
  await expectTokens(
    "source.robbdd.scene",
    "scene (ns=env) station { obj set <parts> with mass, light-colour ws set <places> }",
    "with → keyword.other",
    "mass, light-colour → variable.other.property",
    "ws set → storage.type.declaration",
  );
});

test("quantities, conditions and windows have their colours", async () => {
  const text = "c: holds(<r> moves slower than 0.25 m/s whenever <r> is nearer than 30cm to <b>, within 8 seconds after <e>)";
  await expectTokens(
    "source.robbdd",
    text,
    "m/s → keyword.other.unit",
    "cm → keyword.other.unit",
    "whenever → keyword.other.time",
    "within → keyword.other.time",
  );
});

test("a feature has its tags, headings, steps, names and times", async () => {
  const text = `@story=https:;;x.org
  Szenario: t:fetch -- 1
    Given "a:b" is located at "c \\" d" for 0.5 seconds after event "t:e"
      | name |`;
  assert.deepEqual(await tokens("text.gherkin.robbdd", text), [
    "@story=https:;;x.org → storage.type.annotation.tag",
    "Szenario → keyword.control.section",
    ": → punctuation.separator.label",
    "t:fetch -- 1 → entity.name.type.scenario",
    "Given → keyword.control.step",
    '"a:b" → string.quoted.double',
    '"c \\" d" → string.quoted.double',
    "for → keyword.other.time",
    "after event → keyword.other.time",
    '"t:e" → string.quoted.double',
    "name → variable.other.constant",
  ]);
});

test("a reference is split into its qualifier and its name", async () => {
  assert.deepEqual(await tokens("source.robbdd", "<places.tray_ws>"), [
    "< → punctuation.definition.reference.begin",
    "places. → variable.other.object",
    "tray_ws → variable.other.property",
    "> → punctuation.definition.reference.end",
  ]);
});

test("a keyword inside a name with hyphens is no keyword", async () => {
  const found = await tokens("source.robbdd", "Event (ns=t) evt-before-all");
  assert.deepEqual(found.at(-1), "evt-before-all → variable.other.constant");
});

test("the nodes of a behaviour tree have names", async () => {
  await expectTokens(
    "source.robbdd",
    "Behaviour Tree (ns=t) handling { sequence whole { selector grasp { node pick } } }",
    "Behaviour Tree → storage.type.declaration",
    "handling → entity.name.type.behaviour",
    "sequence → keyword.other",
    "whole → entity.name.type.behaviour",
    "selector → keyword.other",
    "grasp → entity.name.type.behaviour",
    "node → keyword.other",
    "pick → variable.other.property",
  );
});

test("a comment swallows keywords and quotes", async () => {
  assert.deepEqual(await tokens("source.robbdd", `// Then: "it's`), [`// Then: "it's → comment.line.double-slash`]);
});

test("an escaped quote does not end a template's text, where placeholders are highlighted", async () => {
  const found = await tokens("source.robbdd", String.raw`pred("a \"{r}\" b", r=<robot>)`);
  assert.ok(found.includes(String.raw`\" → constant.character.escape`));
  assert.ok(found.includes("{r} → constant.other.placeholder"));
  assert.ok(found.includes("r → variable.parameter"));
  assert.ok(found.includes("robot → variable.other.property"));
});

test("declarations of a .bdd file highlight their names", async () => {
  await expectTokens(
    "source.robbdd",
    [
      "ns t = 'https://example.org/t/'",
      "Task  (ns=t) fetch-task",
      "Scenario Template (ns=t) fetch {",
      "    duration: from <evt-start> until <evt-end>",
      "    set var goals",
      "User Story (ns=t) fetching {",
      "Scenario bench-to-tray {",
      "Scenario Variant old-form {",
    ].join("\n"),
    "ns → keyword.other.namespace",
    "Task → storage.type.declaration",
    "fetch-task → variable.other.constant",
    "fetch → entity.name.type.template",
    "duration → keyword.other.property",
    "from → keyword.other.time",
    "until → keyword.other.time",
    "set var → storage.type.variable",
    "goals → variable.parameter",
    "fetching → entity.name.type.story",
    "bench-to-tray → entity.name.type.variant",
    "old-form → entity.name.type.variant",
  );
});

test("clauses show their section, fluent, quantifier and time constraint", async () => {
  await expectTokens(
    "source.robbdd",
    [
      "Given:",
      "    at-bench: holds(<part> is located at <bench>, [0.5 seconds] before <evt-start>)",
      "When: event <evt-start> occurs",
      "    <robot> picks <part> and places at <bench>",
      "for all ( var x in <goals> ) {",
      "Then: ( not moved: holds(<robot> does not collide <x>, from <a> until <b>) or <c> )",
    ].join("\n"),
    "Given → keyword.control.section",
    "at-bench → entity.name.function.fluent",
    "holds → keyword.other.holds",
    "is located at → support.function.predicate",
    "0.5 → constant.numeric",
    "seconds → keyword.other.time",
    "occurs → support.function.event",
    "and places at → support.function.behaviour",
    "for all → keyword.control.quantifier",
    "not → keyword.operator.wordlike",
    "or → keyword.operator.wordlike",
  );
});

test("variations show their sets, tables and selections", async () => {
  await expectTokens(
    "source.robbdd",
    ["variation:", "    set var <t.goals>: select 2 combinations from <targets>", "|---|---|", "| obj set <parts> | -3 |"].join(
      "\n",
    ),
    "variation → keyword.control.section",
    "select → keyword.other.variation",
    "2 → constant.numeric",
    "|---|---| → punctuation.separator.table",
    "obj set → keyword.other.variation",
    "-3 → constant.numeric",
  );
});

test("a scene shows its sets and their members", async () => {
  await expectTokens(
    "source.robbdd.scene",
    "similar obj set (ns=env) washers { base name: washer  count: 3 }\nobj set (ns=env) parts { object bolt }\nscene (ns=env) s { obj set <parts> }",
    "similar obj set → storage.type.declaration",
    "washers → entity.name.type.set",
    "base name → keyword.other.property",
    "3 → constant.numeric",
    "bolt → variable.other.constant",
    "s → entity.name.type.scene",
    "obj set → storage.type.declaration",
  );
});

test("a word is a unit only after a number or a vector", async () => {
  await expectTokens(
    "source.robbdd.scenex",
    "xyz: (0, 1, 2) mm  mass: 1.5 kg\nmodel m as mjcf { sys path = 'a.xml' }",
    "mm → keyword.other.unit",
    "kg → keyword.other.unit",
    "m → entity.name.function.model",
    "mjcf → constant.language",
    "sys path → keyword.other.property",
  );
});

test("an execution shows its policies and limits", async () => {
  await expectTokens(
    "source.robbdd.bddx",
    "obs policy (ns=x) at-bench for <fetch.at-bench> horizon: 2.0 seconds {\n evaluator: linear distance { less-than: 0.05 m }\nScenario Exec (ns=x) run { variant: <s.v> }",
    "at-bench → entity.name.function.policy",
    "seconds → keyword.other.unit",
    "linear distance → support.function.evaluator",
    "less-than → keyword.other.property",
    "run → entity.name.type.execution",
    "variant → keyword.other.property",
  );
});

/** Words that the grammar gives no scope at all: each is one that a reader would expect in colour. */
async function plainWords(scope: string, text: string): Promise<string[]> {
  const grammar = await registry.loadGrammar(scope);
  assert.ok(grammar);
  let stack = INITIAL;
  const plain: string[] = [];
  for (const line of text.split("\n")) {
    const result = grammar.tokenizeLine(line, stack);
    stack = result.ruleStack;
    for (const token of result.tokens) {
      const part = line.slice(token.startIndex, token.endIndex);
      if (token.scopes.at(-1) === scope) {
        plain.push(...(part.match(/[\p{L}\p{N}_-]*\p{L}[\p{L}\p{N}_-]*/gu) ?? []));
      }
    }
  }
  return plain;
}

const SCOPES: Record<string, string> = {
  bdd: "source.robbdd",
  scene: "source.robbdd.scene",
  scenex: "source.robbdd.scenex",
  ktree: "source.robbdd.scenex",
  bddx: "source.robbdd.bddx",
  study: "source.robbdd.study",
};

for (const folder of [join(process.cwd(), "test", "samples"), join(process.cwd(), "..", "examples")]) {
  for (const file of readdirSync(folder, { recursive: true, encoding: "utf8" })) {
    const scope = SCOPES[extname(file).slice(1)];
    if (scope !== undefined) {
      test(`every word of ${basename(folder)}/${file} has a colour`, async () => {
        assert.deepEqual(await plainWords(scope, readFileSync(join(folder, file), "utf8")), []);
      });
    }
  }
}

for (const [kind, scope] of Object.entries(SCOPES)) {
  test(`every word of the snippets for .${kind} has a colour`, async () => {
    const file = join(process.cwd(), "test", "snippets", `${kind}.json`);
    const snippets = Object.values(JSON.parse(readFileSync(file, "utf8")) as Record<string, string[]>);
    assert.ok(snippets.length > 0);
    for (const lines of snippets) {
      assert.deepEqual(await plainWords(scope, lines.join("\n")), []);
    }
  });
}

/** Phrases such as `<object> is located at <workspace>` of one folder of the catalog. */
function phrasesOf(kind: "predicates" | "behaviours"): string[] {
  const folder = join(CATALOG, kind);
  const files = readdirSync(folder).filter((name) => name.endsWith(".py") && name !== "__init__.py");
  return files.map((name) => {
    const phrase = /^\s*phrase="([^"]+)"/m.exec(readFileSync(join(folder, name), "utf8"))?.[1];
    assert.ok(phrase !== undefined, `${kind}/${name} states no phrase`);
    return phrase;
  });
}

for (const kind of ["predicates", "behaviours"] as const) {
  const scope = kind === "predicates" ? "support.function.predicate" : "support.function.behaviour";
  for (const phrase of phrasesOf(kind)) {
    test(`the words of "${phrase}" are coloured as one of the ${kind}`, async () => {
      const text = phrase.replaceAll("$name", "speed").replace(/#\w+/, "5 m");
      const found = await tokens("source.robbdd", text);
      // What is neither a reference nor a name nor a quantity nor `= …` are the words of the phrase.
      const words = phrase.split(/<[^>]*>|[$#]\w+|=/).map((part) => part.trim());
      for (const word of words.filter((part) => part !== "")) {
        assert.ok(found.includes(`${word} → ${scope}`), `missing "${word}" among\n  ${found.join("\n  ")}`);
      }
    });
  }
}
