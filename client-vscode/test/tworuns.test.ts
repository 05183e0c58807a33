// The server executes one run at a time: a second one is refused, and the first one is still shown.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { RunMessage } from "../src/runs/messages";
import { LanguageClient } from "./languageclient.kit";
import { message } from "./messages.kit";
import { words } from "./testing.kit";
import { editor } from "./vscode.kit";
import { MODEL, client, command, openWindow, until } from "./window.kit";

interface Asked {
  readonly uri: string;
  readonly token: string;
}

/** A server whose runs end when the test says so. */
class Runs {
  readonly asked: Asked[] = [];
  private readonly answers: ((answer: unknown) => void)[] = [];

  constructor() {
    LanguageClient.answers.set("workspace/executeCommand", ({ arguments: [target] }: { arguments: [Asked] }) => {
      this.asked.push(target);
      return new Promise((resolve) => this.answers.push(resolve));
    });
  }

  /** Begin a run, as a code lens does. */
  async begin(): Promise<{ readonly name: string; readonly ended: Promise<unknown> }> {
    const count = this.asked.length;
    const ended = client().options.middleware.executeCommand("robbdd.run", [{ uri: MODEL.toString() }]);
    await until(() => this.asked.length > count);
    return { name: this.asked[count]?.token ?? "", ended };
  }

  answer(run: number, answer: object): void {
    this.answers[run]?.(answer);
  }

  say(run: string, said: RunMessage): void {
    client().listeners.get("robbdd/runMessage")?.({ run, uri: MODEL.toString(), message: said });
  }
}

async function twoRuns(): Promise<{ readonly runs: Runs; readonly first: string; readonly firstEnded: Promise<unknown> }> {
  openWindow();
  await command("robbdd.previewGherkin");
  await editor.controller.resolveHandler(undefined);
  const runs = new Runs();
  const { name: first, ended: firstEnded } = await runs.begin();
  runs.say(first, message("RunStarted"));
  const second = await runs.begin();
  assert.notEqual(first, second.name);
  runs.answer(1, { problem: "a run is in progress: cancel it first", momentary: true });
  await second.ended;
  return { runs, first, firstEnded };
}

test("a refused second run leaves the first one's entry open, and its verdicts reach it", async () => {
  const { runs, first, firstEnded } = await twoRuns();
  assert.equal(editor.openRuns, 1);
  runs.say(first, message("ScenarioStarted", { values: "part = cube1" }));
  runs.say(first, message("ClauseJudged", words("held", 0)));
  runs.say(first, message("ScenarioFinished"));
  await until(() => editor.passed.length > 0);
  runs.say(first, message("RunFinished"));
  runs.answer(0, { run: first, total: 1, holds: 1, violated: 0, unknown: 0, cancelled: false });
  await firstEnded;
  await until(() => editor.openRuns === 0);
});

test("a run that the server answers without a last message is ended", async () => {
  const { runs, first, firstEnded } = await twoRuns();
  runs.answer(0, { run: first, problem: "the disk is full" });
  await firstEnded;
  await until(() => editor.openRuns === 0);
});
