// Links to moments of replays: written here, opened by somebody else.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Trace } from "../src/panels/replay/answer";
import { isExecution, linkTo, momentIn, momentOf } from "../src/panels/replay/link";
import { LanguageClient } from "./languageclient.kit";
import { Uri, type WebviewPanel, editor, workspace } from "./vscode.kit";
import { command, openWindow, until } from "./window.kit";

const MOMENT = {
  model: "cells/pick & place/cell 100%.bdd",
  run: 3,
  index: 17,
  time: 4.25,
  clause: "at-goal",
  variant: "https://example.org/criteria/part-to-bin#a+b",
  variation: 5,
  repetition: 2,
  seed: 12,
};
const SCENARIO = {
  index: 17, name: "crit:part-to-bin -- 5", values: "", story: "https://example.org/tidy", verdict: "violated", variant: MOMENT.variant, variation: 5,
  repetition: 2, seed: 12, trace: true,
} as const;
const ARRAY = { type: "float32", shape: [], data: "" } as const;
const CLAUSE = {
  iri: "https://example.org/at-goal", name: "at-goal", role: "then", sentence: "", verdict: "violated", robustness: null, unit: "", at: null,
  worst_at: null, reason: "", vacuous: "", source: null, parts: [],
} as const;
const TRACE: Trace = {
  run: 3,
  folder: "file:///lab/.robbdd/runs/3",
  scenario: SCENARIO,
  duration: 6,
  remark: "",
  frames: { times: ARRAY, poses: ARRAY, bodies: [] },
  ...{ shapes: [], meshes: [], bodies: [], workspaces: [], events: [], clauses: [CLAUSE] },
};
const LINK = linkTo(MOMENT, "vscode", "robbdd.robbdd-workbench");
/** Where the folder of the person who opens the link is. */
const ELSEWHERE = Uri.parse("file:///home/other/checkout");

test("a link names the moment, whether or not the editor has decoded it", () => {
  assert.match(LINK, /^vscode:\/\/robbdd\.robbdd-workbench\/replay\?[\w.~%=&:/-]+$/);
  assert.deepEqual(momentIn(LINK), MOMENT);
  assert.deepEqual(momentIn(decodeURIComponent(LINK)), MOMENT);
  assert.deepEqual(momentIn(`  ${LINK.replace("vscode:", "code-oss:")}\n`), MOMENT);
});

test("what is no link to a replay, or leads out of the folder, is none", () => {
  const others = [
    "",
    "https://example.org/",
    LINK.replace("/replay", "/run"),
    LINK.replace("seed=12", "seed=-1"),
    LINK.replace("run=3", "run=latest"),
    LINK.replace("&seed=12", ""),
    LINK.replace("time=4.25", "time=NaN"),
    LINK.replace("time=4.25", "time=-1"),
  ];
  const paths = ["../secret.bdd", "/etc/cell.bdd", "a/../../b.bdd", "C:/cell.bdd", "a\\b.bdd", "cell.txt", "a//b.bdd", ""];
  const leading = paths.map((model) => linkTo({ ...MOMENT, model }, "vscode", "robbdd.robbdd-workbench"));
  for (const link of [...others, ...leading]) {
    assert.equal(momentIn(link), undefined, link);
  }
});

test("an execution is known by what it is, not by the number of its run", () => {
  assert.ok(isExecution(SCENARIO, { ...MOMENT, run: 9, index: 0 }));
  for (const other of [{ seed: 13 }, { variation: 6 }, { repetition: 1 }, { variant: "https://example.org/other" }]) {
    assert.ok(!isExecution({ ...SCENARIO, ...other }, MOMENT), JSON.stringify(other));
  }
});

test("a moment is within its trace, and only of a stored execution", () => {
  assert.deepEqual(momentOf(TRACE, MOMENT.model, 4.2504, 0), { ...MOMENT, time: 4.25 });
  assert.equal(momentOf(TRACE, MOMENT.model, 99, 0)?.time, 6);
  assert.equal(momentOf(TRACE, MOMENT.model, -1, 7)?.clause, "");
  assert.equal(momentOf({ ...TRACE, run: 0 }, MOMENT.model, 1, 0), undefined);
});

/** A window with a folder, in whose store are these executions, by run. */
function otherWindow(...stored: readonly Trace[]): void {
  openWindow();
  workspace.workspaceFolders = [{ uri: ELSEWHERE }];
  LanguageClient.answers.set("robbdd/trace", (params) => {
    const { run, seed } = params as { readonly run?: number; readonly seed?: number };
    assert.equal(seed, undefined, "the server does not choose by seed");
    return stored.find((trace) => run === undefined || trace.run === run) ?? null;
  });
}

/** Open a link as the system does; returns the replay, once there is one. */
async function opened(link: string): Promise<WebviewPanel | undefined> {
  await editor.uriHandler?.handleUri({ toString: () => decodeURIComponent(link) });
  return editor.panels[0];
}

async function firstMessage(panel: WebviewPanel | undefined): Promise<unknown> {
  panel?.fromPage.fire({ type: "ready" });
  await until(() => (panel?.posted.length ?? 1) > 0);
  return panel?.posted[0];
}

test("anybody who has the run sees the same moment", async () => {
  otherWindow(TRACE);
  const panel = await opened(LINK);
  assert.equal(panel?.title, "Replay part-to-bin 5 (run 3)");
  const { recording, clause, time } = (await firstMessage(panel)) as Readonly<Record<string, unknown>>;
  assert.deepEqual([clause, time], ["at-goal", 4.25]);
  assert.match(JSON.stringify(recording), /file:\/\/\/home\/other\/checkout\/.*"run":3,"index":17/);
  assert.deepEqual([editor.problems, editor.messages], [[], []]);
});

test("where the number is another run's, the same execution of another run is shown, and that is said", async () => {
  otherWindow({ ...TRACE, scenario: { ...SCENARIO, seed: 99 } }, TRACE);
  LanguageClient.answers.set("robbdd/trace", (params) => {
    return "run" in (params as object) ? { ...TRACE, scenario: { ...SCENARIO, seed: 99 } } : { ...TRACE, run: 8 };
  });
  assert.equal((await opened(LINK))?.title, "Replay part-to-bin 5 (run 8)");
  assert.deepEqual(editor.messages, ["Run 3 is not stored here; run 8 has the same scenario with the same seed."]);
});

test("an execution that is not stored here is never replaced by another one", async () => {
  otherWindow({ ...TRACE, scenario: { ...SCENARIO, seed: 99 } });
  assert.equal(await opened(LINK), undefined);
  assert.match(editor.problems.join(), /seed 12\) that no run stored here has/);
});

test("a link to a model of no open folder says what to open", async () => {
  otherWindow(TRACE);
  editor.missing.add(Uri.joinPath(ELSEWHERE, MOMENT.model).toString());
  assert.equal(await opened(LINK), undefined);
  assert.match(editor.problems.join(), /Open the folder of that project/);
});

test("a link is pasted into a box, which refuses everything else", async () => {
  otherWindow(TRACE);
  editor.typed.push("https://example.org/", LINK);
  await command("robbdd.openReplayLink", undefined);
  assert.deepEqual(editor.problems.splice(0), ["This is no link to a replay."]);
  await command("robbdd.openReplayLink", undefined);
  assert.equal(editor.panels.length, 1);
});

test("the page's wish for a link fills the clipboard, for a model of an open folder", async () => {
  otherWindow(TRACE);
  const panel = await opened(LINK);
  await firstMessage(panel);
  panel?.fromPage.fire({ type: "link", time: 1.5, clause: 0 });
  await until(() => panel?.posted.length === 2);
  assert.deepEqual(panel?.posted[1], { type: "said", words: "Link copied." });
  assert.equal(momentIn(editor.clipboard)?.time, 1.5);
  workspace.workspaceFolders = [];
  editor.clipboard = "";
  panel.fromPage.fire({ type: "link", time: 1.5, clause: 0 });
  await until(() => panel.posted.length === 3);
  assert.match(JSON.stringify(panel.posted[2]), /in none of the open folders/);
  assert.equal(editor.clipboard, "");
});

test("a picture that the page may not copy is saved", async () => {
  otherWindow(TRACE);
  const panel = await opened(LINK);
  panel?.fromPage.fire({ type: "picture", data: Buffer.from("png").toString("base64") });
  const target = Uri.joinPath(ELSEWHERE, "part-to-bin-5.png").toString();
  await until(() => editor.files.has(target));
  assert.equal(Buffer.from(editor.files.get(target) ?? "", "base64").toString(), "png");
});
