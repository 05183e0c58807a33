// The server executes one run at a time: a second one is refused, and the first one is still shown.
import assert from "node:assert/strict";
import { test } from "node:test";
import { LanguageClient } from "./languageclient.kit";
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

  say(run: string, message: object): void {
    client().listeners.get("robbdd/runMessage")?.({ run, uri: MODEL.toString(), message });
  }
}

async function twoRuns(): Promise<{ readonly runs: Runs; readonly first: string; readonly firstEnded: Promise<unknown> }> {
  openWindow();
  await command("robbdd.previewGherkin");
  await editor.controller.resolveHandler(undefined);
  const runs = new Runs();
  const { name: first, ended: firstEnded } = await runs.begin();
  runs.say(first, { type: "RunStarted", total: 1, simulator: "mujoco 4.0.0" });
  const second = await runs.begin();
  assert.notEqual(first, second.name);
  runs.answer(1, { problem: "a run is in progress: cancel it first", momentary: true });
  await second.ended;
  return { runs, first, firstEnded };
}

test("a refused second run leaves the first one's entry open, and its verdicts reach it", async () => {
  const { runs, first, firstEnded } = await twoRuns();
  assert.equal(editor.openRuns, 1);
  runs.say(first, { type: "ScenarioStarted", index: 0, name: "t:fetch -- 1", values: "part = cube1", variant: "t:fetch", variation: 1 });
  const judged = { verdict: "holds", robustness: null, unit: "", at: null, reason: "" };
  runs.say(first, { type: "ClauseJudged", index: 0, line: 7, ...words("held", 0), ...judged });
  runs.say(first, { type: "ScenarioFinished", index: 0, simulated: 9, wall: 0.5, stepping: 0.3 });
  await until(() => editor.passed.length > 0);
  runs.say(first, { type: "RunFinished", ok: true });
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
