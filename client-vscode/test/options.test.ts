// Run with Options…: the user's options reach the server, and are remembered.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { argumentsOf, numberProblem, optionsIn, summaryOf, typedNumber, withOption } from "../src/runs/options";
import { LanguageClient } from "./languageclient.kit";
import { CancellationTokenSource, Uri, editor, workspace } from "./vscode.kit";
import { MODEL, command, openWindow } from "./window.kit";

interface Asked {
  readonly command: string;
  readonly arguments: readonly [Record<string, unknown>];
}

const asked: Record<string, unknown>[] = [];
/** The runs whose extent was asked for. */
const estimated: Record<string, unknown>[] = [];
let extent: Readonly<Record<string, unknown>> = {};

beforeEach(() => {
  asked.length = 0;
  estimated.length = 0;
  extent = { executions: 4, seconds: 3, measured: 8, words: "4 executions, about 3 s" };
});

function open(): void {
  openWindow();
  workspace.workspaceFolders = ["file:///cell", "file:///other"].map((uri) => ({ uri: Uri.parse(uri) }));
  LanguageClient.answers.set("workspace/executeCommand", ({ command, arguments: [{ token, ...target }] }: Asked) => {
    if (command === "robbdd.estimate") {
      estimated.push(target);
      return extent;
    }
    assert.equal(typeof token, "string");
    asked.push(target);
    return {};
  });
}

/** What the first entry of the list says that was shown `back` lists ago. */
const offered = (back = 1) => editor.lists.at(-back)?.[0]?.description;

async function run(target: Uri, choices: readonly string[], typed: readonly string[] = []): Promise<void> {
  editor.choices.push(...choices);
  editor.typed.push(...typed);
  await command("robbdd.runWithOptions", target);
}

test("options are sent as they are set, and remembered for their workspace folder", async () => {
  open();
  await run(MODEL, ["Repetitions", "Seed", "Values", "Run"], ["3", "-4", "robot=panda"]);
  const options = { repeat: 3, seed: -4, where: "robot=panda" };
  assert.deepEqual(asked, [{ uri: MODEL.toString(), ...options }]);
  await run(MODEL, ["Run"]);
  assert.equal(offered(), "where robot=panda, 3 executions each, seed -4");
  assert.deepEqual(asked[1], asked[0]);
  const other = Uri.parse("file:///other/m.bdd");
  await run(other, ["Run"]);
  assert.deepEqual(asked[2], { uri: other.toString() });
  await run(MODEL, ["Reset", "Run"]);
  assert.deepEqual(asked[3], { uri: MODEL.toString() });
});

test("the extent of the run is shown with the options, or why there would be none", async () => {
  open();
  const shown = () => editor.titles.at(-1)?.replace(/^Run with Options: /, "");
  await run(MODEL, ["Repetitions"], ["3"]);
  assert.deepEqual(estimated, [{ uri: MODEL.toString() }, { uri: MODEL.toString(), repeat: 3 }]);
  assert.equal(shown(), "4 executions, about 3 s");
  extent = { problem: "no scenario fits the selection" };
  await run(MODEL, []);
  assert.equal(shown(), "no scenario fits the selection");
});

test("pictures of violations are an option of every run", async () => {
  open();
  await run(MODEL, ["Pictures", "Run"]);
  assert.equal(offered(), "with pictures");
  assert.deepEqual(asked, [{ uri: MODEL.toString(), record: true }]);
  await run(MODEL, ["Pictures", "Run"]);
  assert.deepEqual(asked.at(-1), { uri: MODEL.toString() });
});

test("only one of the amounts is sent", async () => {
  open();
  await run(MODEL, ["Scenarios", "The first …", "Run"], ["5"]);
  await run(MODEL, ["Scenarios", "All combinations of 2 variables", "Run"]);
  await run(MODEL, ["Scenarios", "All scenarios", "Run"]);
  const uri = MODEL.toString();
  assert.deepEqual(asked, [{ uri, first: 5 }, { uri, pairwise: 2 }, { uri }]);
});

test("cancelling runs nothing, and refused or cancelled input changes nothing", async () => {
  open();
  await run(MODEL, ["Repetitions", "Processes"], ["0"]);
  assert.deepEqual(editor.problems, ["A whole number above 0, or nothing."]);
  assert.deepEqual(asked, []);
  await run(MODEL, ["Run"]);
  assert.deepEqual(asked, [{ uri: MODEL.toString() }]);
});

test("the Testing view runs the selected tests with options", async () => {
  open();
  await editor.controller.resolveHandler(undefined);
  editor.choices.push("Processes", "Run");
  editor.typed.push("2");
  await editor.profiles.get("Run with Options…")?.({}, new CancellationTokenSource().token);
  assert.deepEqual(asked, [{ uri: MODEL.toString(), only: [{ variant: "t:fetch" }, { variant: "t:sort" }], jobs: 2 }]);
});

test("catalog behaviours instead of implementations are sent by name, and typing errors are refused", async () => {
  open();
  await run(MODEL, ["Behaviours", "Run"], ["pick-server=pick-place, exec:other = place"]);
  assert.deepEqual(asked, [{ uri: MODEL.toString(), bhv: { "pick-server": "pick-place", "exec:other": "place" } }]);
  await run(MODEL, ["Behaviours"], ["pick-server"]);
  assert.deepEqual(editor.problems, ["NAME=BEHAVIOUR, such as my-server=pick-place, separated by commas."]);
  await run(MODEL, ["Run"]);
  assert.equal(offered(), "with pick-server=pick-place, exec:other = place");
});

test("the valid part of remembered options is used", () => {
  assert.deepEqual(optionsIn(undefined), {});
  assert.deepEqual(optionsIn({ repeat: 0, jobs: "2", seed: 1.5, where: "", amount: { kind: "pairwise", number: 4 } }), {});
  assert.deepEqual(argumentsOf(optionsIn({ seed: 0, amount: { kind: "sample", number: 7 } })), { seed: 0, sample: 7 });
  assert.deepEqual(withOption({ seed: 1, repeat: 2 }, "repeat", undefined), { seed: 1 });
  assert.equal(summaryOf({}), "all as in the model");
});

test("a .scenex is sent by its path, and left out once it is cleared", async () => {
  open();
  await run(MODEL, ["Executable Scene", "Run"], [" cell.scenex "]);
  assert.deepEqual(asked, [{ uri: MODEL.toString(), scenex: "cell.scenex" }]);
  await run(MODEL, ["Executable Scene", "Run"], [""]);
  assert.deepEqual(asked.at(-1), { uri: MODEL.toString() });
});

test("a number is typed whole, in its range, or left out", () => {
  assert.equal(numberProblem("0"), "A whole number above 0, or nothing.");
  assert.equal(numberProblem("two", Number.MIN_SAFE_INTEGER), "A whole number, or nothing.");
  assert.deepEqual(["", " ", "12"].map((text) => numberProblem(text)), [undefined, undefined, undefined]);
  assert.deepEqual([typedNumber(" "), typedNumber("12")], [undefined, 12]);
});
