// Studies are executed by the command line of the server in use, as a task.
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { LanguageClient } from "./languageclient.kit";
import { Uri, editor, endTask } from "./vscode.kit";
import { command, openWindow, until } from "./window.kit";

const STUDY = Uri.file("/models/heights of bins.study");

async function begin(trusted: boolean): Promise<void> {
  openWindow({ trusted });
  editor.settings = { ...editor.settings, "server.environment": { ROS_DOMAIN_ID: "7" } };
  await command("robbdd.restartServer");
}

for (const [name, action] of [["runStudy", "run"], ["resumeStudy", "resume"], ["showStudyResults", "show"]] as const) {
  test(`robbdd.${name} gives the study to the command line`, async () => {
    await begin(true);
    await command(`robbdd.${name}`, { uri: STUDY.toString() });
    const [task] = editor.tasks;
    assert.ok(task);
    const { process: program, args, options } = task.execution;
    assert.deepEqual([program, args], [join(dirname(process.execPath), "robbdd"), ["study", action, "/models/heights of bins.study"]]);
    assert.deepEqual([options.cwd, options.env["ROS_DOMAIN_ID"]], ["/models", "7"]);
    assert.equal(editor.tasks.length, 1);
  });
}

test("a menu names the file itself", async () => {
  await begin(true);
  await command("robbdd.runStudy", STUDY);
  assert.deepEqual(editor.tasks.map(({ execution }) => execution.args[2]), ["/models/heights of bins.study"]);
});

test("without trust a study is not executed, but its results are shown", async () => {
  await begin(false);
  await command("robbdd.runStudy", STUDY);
  await command("robbdd.resumeStudy", STUDY);
  assert.deepEqual(editor.tasks, []);
  assert.match(editor.problems.join(), /studies run code of this workspace/);
  await command("robbdd.showStudyResults", STUDY);
  assert.equal(editor.tasks.length, 1);
});

test("nothing is executed while an edited file cannot be saved", async () => {
  await begin(true);
  editor.saves = false;
  await command("robbdd.runStudy", STUDY);
  assert.deepEqual(editor.tasks, []);
});

const clause = (verdict: string, robustness: number) => ({ iri: "at-goal", name: "at-goal", verdict, robustness, unit: "m" });
const execution = (number: number, verdict: string, robustness: number) => {
  return { number, variant: "v", name: "s", values: { robot: "panda" }, verdict, clauses: [clause(verdict, robustness)] };
};
/** A study that the command line has begun: two of four executions. */
const RESULTS = {
  name: "heights",
  total: 4,
  running: false,
  counts: { holds: 1, violated: 1, unknown: 0 },
  executions: [execution(3, "holds", 0.01), execution(7, "violated", -0.02)],
};

/** Show the study, and request the replay of its second execution; `recorded` is whether there is one. */
async function replayed(recorded: () => boolean): Promise<unknown[]> {
  const asked: unknown[] = [];
  LanguageClient.answers.set("robbdd/study", () => RESULTS);
  LanguageClient.answers.set("robbdd/trace", (params: unknown) => {
    asked.push(params);
    return recorded() ? TRACE : undefined;
  });
  await command("robbdd.showStudy", { uri: STUDY.toString() });
  const [panel] = editor.panels;
  assert.ok(panel);
  panel.fromPage.fire({ type: "ready" });
  const [message] = panel.posted as { title: string; studied: unknown; results: { scenarios: unknown[] } }[];
  assert.equal(message?.title, "Study heights: 1 hold, 1 violated (2 of 4 executed)");
  assert.deepEqual([message.studied, message.results.scenarios.length], [{ uri: STUDY.toString() }, 2]);
  panel.fromPage.fire({ type: "replay", index: 1, clause: "at-goal" });
  return asked;
}

const LISTS = { shapes: [], meshes: [], bodies: [], workspaces: [], events: [], clauses: [] };
const NONE = { type: "float32", shape: [], data: "" };
const SCENARIO = { index: 0, name: "s", values: "", story: "", variant: "v", variation: 1, seed: 0, verdict: "violated", repetition: 1, trace: true };
const TRACE = { run: 1, folder: "file:///run", duration: 0, remark: "", scenario: SCENARIO, frames: { times: NONE, poses: NONE, bodies: [] }, ...LISTS };

test("the executions of a study of the command line are shown, and a recorded one is replayed", async () => {
  await begin(true);
  const asked = await replayed(() => true);
  await until(() => editor.panels.length === 2);
  assert.deepEqual(asked.at(-1), { uri: STUDY.toString(), number: 7 });
  assert.deepEqual(editor.tasks, []);
});

for (const [code, opens, told] of [[0, true, /^$/], [1, true, /other verdicts or margins/], [2, false, /^$/]] as const) {
  test(`an execution without a recording is executed again; exit code ${code}`, async () => {
    await begin(true);
    let recorded = false;
    const asked = await replayed(() => recorded);
    await until(() => editor.tasks.length === 1);
    const [task] = editor.tasks;
    assert.ok(task);
    assert.deepEqual(task.execution.args, ["study", "replay", "/models/heights of bins.study", "7"]);
    assert.deepEqual([asked.length, editor.panels.length], [1, 1]);
    recorded = true;
    endTask(task, code);
    if (opens) {
      await until(() => editor.panels.length === 2);
    } else {
      await new Promise((resolve) => setImmediate(resolve));
    }
    assert.equal(editor.panels.length, opens ? 2 : 1);
    assert.match(editor.problems.join(), told);
  });
}

test("without trust no execution is executed again", async () => {
  await begin(false);
  await replayed(() => false);
  await until(() => editor.problems.length > 0);
  assert.match(editor.problems.join(), /studies run code of this workspace/);
  assert.deepEqual(editor.tasks, []);
});
