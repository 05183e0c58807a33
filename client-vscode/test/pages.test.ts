// The pages of all panels, as the extension creates them from names in users' files.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { LanguageClient } from "./languageclient.kit";
import { Uri, WebviewPanel, editor } from "./vscode.kit";
import { command, openWindow } from "./window.kit";

const HOSTILE = `"><script src="https://evil.example/x.js"></script><img src=x onerror=alert(1)><base href="https://evil.example/"> 'nonce-guessed'; script-src *`;
const MODEL = Uri.joinPath(Uri.parse("file:///cell"), `${HOSTILE.replaceAll("/", ":")}.bdd`);
const CLAUSE = { uri: MODEL.toString(), clause: HOSTILE };
const PAGES: Readonly<Record<string, string>> = {
  "robbdd.compareRuns": "comparison",
  "robbdd.showGraph": "graph",
  "robbdd.showHistory": "history",
  "robbdd.showReplay": "replay",
  "robbdd.showScene": "scene",
  "robbdd.showStudy": "study",
};
const POLICY = /^default-src 'none'; script-src 'nonce-(?<nonce>[\w-]{22,})'; style-src https:\/\/\*\.pages\.example$/;

/** Answer the requests of all panels with two runs of one scenario, of such names. */
function answer(): void {
  const array = { type: "float32", shape: [], data: "" };
  const frames = { times: array, poses: array, bodies: [] };
  const lists = { shapes: [], meshes: [], bodies: [], workspaces: [], events: [], clauses: [] };
  const scenario = { index: 0, name: HOSTILE, values: HOSTILE, story: HOSTILE, variant: HOSTILE, variation: 1, seed: 0, verdict: "holds", repetition: 1, trace: true };
  const folder = "file:///cell/run";
  const counts = { holds: 1, violated: 0, unknown: 0, complete: true, state: "finished", finished: 1, total: 1, problem: null };
  const stored = { run: 1, folder, path: HOSTILE, model: HOSTILE, seed: 0, ...counts, scenarios: [scenario] };
  const judged = { holds: 1, violated: 0, unknown: 0 };
  const history = { clause: HOSTILE, name: HOSTILE, runs: [{ ...stored, began: "", judged, margin: 1, unit: HOSTILE, worst: 0, stale: false }] };
  const runs = [stored, { ...stored, run: 2 }];
  const comparison = { before: stored, after: stored, inputs: [HOSTILE], clauses: [], same: 1, flipped: 0, changes: [] };
  LanguageClient.answers.set("robbdd/runs", () => ({ store: folder, runs }));
  LanguageClient.answers.set("robbdd/history", () => history);
  LanguageClient.answers.set("robbdd/compare", () => comparison);
  const scene = { iri: HOSTILE, name: HOSTILE, ...lists, sampled: [HOSTILE], missing: [HOSTILE], faults: [{ kind: "pose", reason: HOSTILE, source: null }] };
  LanguageClient.answers.set("robbdd/scene", () => ({ uri: MODEL.toString(), problem: HOSTILE, scenes: [scene] }));
  LanguageClient.answers.set("robbdd/trace", () => ({ run: 1, folder, duration: 0, remark: "", scenario, frames, ...lists }));
  editor.files.set(`${folder}/results.json`, JSON.stringify({ seed: 0, model: HOSTILE, complete: true, scenarios: [] }));
}

/** The page that a command opens. */
async function opened(name: string): Promise<WebviewPanel> {
  openWindow();
  answer();
  editor.choices.push("Run 1");
  await command(name, name === "robbdd.showHistory" ? CLAUSE : MODEL);
  const [panel, ...others] = editor.panels;
  assert.ok(panel && others.length === 0, `${name} opened ${editor.panels.length} panels`);
  return panel;
}

const attribute = (text: string) => text.replaceAll("&quot;", '"').replaceAll("&lt;", "<").replaceAll("&amp;", "&");

/** The nonce of a page, which has to let in its own script and style sheet and nothing else. */
function nonceOf({ webview: { html, options } }: WebviewPanel, script: string): string {
  const policies = [...html.matchAll(/http-equiv="Content-Security-Policy" content="([^"]*)"/g)].map(([, one = ""]) => attribute(one));
  const nonce = POLICY.exec(policies.join("\n"))?.groups?.["nonce"];
  assert.ok(nonce, policies.join("\n"));
  const elements = [...html.matchAll(/<(?!\/|!)[^>]*>/g)].map(([one]) => one);
  assert.deepEqual(elements, [
    '<html lang="en">',
    "<head>",
    '<meta charset="UTF-8">',
    elements[3],
    '<meta name="viewport" content="width=device-width, initial-scale=1">',
    `<link rel="stylesheet" href="https://pages.example/extension/out/webviews/${script}.css">`,
    "<title>",
    "<body>",
    `<script nonce="${nonce}" src="https://pages.example/extension/out/webviews/${script}.js">`,
  ]);
  const folder = Uri.parse("file:///extension/out/webviews");
  assert.deepEqual(options, { enableScripts: true, localResourceRoots: [folder] });
  return nonce;
}

test("every page allows its own script by a unique nonce, whatever names it shows", async () => {
  const nonces: string[] = [];
  for (const [name, script] of [...Object.entries(PAGES), ...Object.entries(PAGES)]) {
    nonces.push(nonceOf(await opened(name), script));
  }
  assert.equal(new Set(nonces).size, nonces.length);
});

test("a page restored in another window has its own nonce, too", async () => {
  const state = { uri: MODEL.toString(), recording: { uri: MODEL.toString() }, studied: { uri: MODEL.toString(), run: 1 }, choice: CLAUSE, pair: { uri: MODEL.toString(), before: 1, after: 2 } };
  const nonces: string[] = [];
  for (const script of [...Object.values(PAGES), ...Object.values(PAGES)]) {
    openWindow();
    answer();
    await command("robbdd.cancelRun");
    const panel = new WebviewPanel(HOSTILE);
    await editor.serializers.get(`robbdd.${script}`)?.deserializeWebviewPanel(panel, state);
    nonces.push(nonceOf(panel, script));
  }
  assert.equal(new Set(nonces).size, nonces.length);
});

test("these are all pages, and one module creates them", () => {
  const sources = readdirSync("src", { recursive: true, encoding: "utf8" }).filter((path) => path.endsWith(".ts"));
  const text = Object.fromEntries(sources.map((path) => [path.replaceAll("\\", "/"), readFileSync(join("src", path), "utf8")]));
  const having = (pattern: RegExp) => Object.keys(text).filter((path) => pattern.test(text[path] ?? "")).sort();
  assert.deepEqual(having(/\.html = /), ["panels/panel.ts"]);
  assert.deepEqual(having(/new Panel\b/), [...Object.values(PAGES).map((script) => `panels/${script}/view.ts`), "panels/replay/paused.ts"].sort());
});
