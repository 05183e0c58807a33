// Studies are executed by the command line of the server in use, as a task.
import assert from "node:assert/strict";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { Uri, editor } from "./vscode.kit";
import { command, openWindow } from "./window.kit";

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
