// The run monitor keeps up with long runs: it counts as results arrive and shows them now and then.
import assert from "node:assert/strict";
import { mock, test } from "node:test";
import type { RunProgress } from "../src/presentation";
import type { RunMessage } from "../src/runs/messages";
import { RunMonitor } from "../src/runs/monitor";
import { message } from "./messages.kit";

const URI = "file:///cell/fetch.bdd";

function scenario(index: number): RunMessage[] {
  return [
    message("ScenarioStarted", { index }),
    message("ScenarioFinished", { index }),
  ];
}

test("the status is updated at the start and the end of a run, and at intervals in between", () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  const shown: RunProgress[][] = [];
  const monitor = new RunMonitor((runs) => shown.push([...runs]));
  const say = (said: RunMessage): void => {
    monitor.accept({ run: "1", uri: URI, message: said });
  };
  say({ type: "RunStarted", total: 8000, simulator: "mujoco 4.0.0" });
  assert.deepEqual(shown, [[{ finished: 0, total: 8000 }]]);
  for (let index = 0; index < 5000; index += 1) {
    scenario(index).forEach(say);
  }
  assert.equal(shown.length, 1, "no update for each message");
  mock.timers.tick(100);
  assert.deepEqual(shown.at(-1), [{ finished: 5000, total: 8000 }]);
  scenario(5000).forEach(say);
  say({ type: "RunFinished", ok: false });
  assert.deepEqual(shown.at(-1), [], "the end is shown at once");
  const { length } = shown;
  mock.timers.tick(1000);
  assert.equal(shown.length, length);
  monitor.dispose();
  mock.timers.reset();
});

test("a scenario that is executed again counts once, with its last outcome", () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  let summary = "";
  const monitor = new RunMonitor((_, words) => (summary = words));
  const judged = (verdict: "holds" | "violated"): RunMessage => message("ClauseJudged", { verdict });
  const [started, finished] = scenario(0);
  assert.ok(started && finished);
  const messages = [started, judged("violated"), finished, started, judged("holds"), finished];
  for (const message of [{ type: "RunStarted", total: 1, simulator: "" } as RunMessage, ...messages]) {
    monitor.accept({ run: "1", uri: URI, message });
  }
  monitor.accept({ run: "1", uri: URI, message: { type: "RunFinished", ok: true } });
  assert.match(summary, /: 1 of 1 scenario passed\.$/);
  monitor.dispose();
  mock.timers.reset();
});
