// Where the pictures of a run are: reported when they are there, however the run was started.
import assert from "node:assert/strict";
import { test } from "node:test";
import { makesPictures, recordingWords } from "../src/runs/recording";
import { LanguageClient } from "./languageclient.kit";
import { editor } from "./vscode.kit";
import { command, openWindow } from "./window.kit";

const answer = (violated: number, pictures: readonly string[]) => {
  const counts = { total: 2, holds: 2 - violated, violated, unknown: 0, cancelled: false, failed: null };
  return { run: "1", ...counts, stored: { run: 4, folder: "file:///cell/4" }, pictures };
};
const PICTURES = ["file:///cell/4/pictures/a.png", "file:///cell/4/pictures/b.png"];

for (const [given, expected] of [
  [answer(1, PICTURES), ["RobBDD: 2 pictures of violations in /cell/4/pictures"]],
  [answer(0, []), ["RobBDD: No scenario was violated, so there is no picture."]],
  // The server has reported why it could not render them.
  [answer(1, []), []],
  [{ problem: "a run is in progress", momentary: true }, []],
] as const) {
  test(`a recorded run of the palette ends with: ${expected.join("") || "nothing"}`, async () => {
    openWindow();
    LanguageClient.answers.set("workspace/executeCommand", () => given);
    await command("robbdd.recordFile");
    assert.deepEqual(editor.messages, expected);
  });
}

test("a run without pictures tells nothing of them", async () => {
  openWindow();
  LanguageClient.answers.set("workspace/executeCommand", () => answer(0, []));
  await command("robbdd.runFile");
  assert.deepEqual(editor.messages, []);
  assert.deepEqual([makesPictures("robbdd.run", { record: true }), makesPictures("robbdd.run", {})], [true, false]);
});

test("the output names the folder of the recording and each picture", () => {
  assert.deepEqual(recordingWords(answer(1, PICTURES)), [
    "● Recording, can be replayed: /cell/4",
    "    picture of a violation: /cell/4/pictures/a.png",
    "    picture of a violation: /cell/4/pictures/b.png",
  ]);
  assert.deepEqual(recordingWords(answer(0, [])), ["● Recording, can be replayed: /cell/4. There was no violation to render."]);
  assert.deepEqual(recordingWords(answer(1, [])), ["● Recording, can be replayed: /cell/4"]);
  assert.deepEqual(recordingWords({ problem: "no" }), []);
});
