import assert from "node:assert/strict";
import { test } from "node:test";
import { page } from "../src/panels/page";

const PARTS = { title: 'a "b" <c>', script: "res://x/graph.js", style: "res://x/graph.css", source: "res:", nonce: "n0nce" };

test("a page allows only its own script and style sheet", () => {
  const html = page(PARTS);
  const policy = /Content-Security-Policy" content="(?<policy>[^"]*)"/.exec(html)?.groups?.["policy"];
  assert.equal(policy, "default-src 'none'; script-src 'nonce-n0nce'; style-src res:");
  assert.deepEqual(html.match(/(?:src|href)="[^"]*"/g), ['href="res://x/graph.css"', 'src="res://x/graph.js"']);
  assert.ok(!html.includes("unsafe"));
});

test("a title cannot inject elements", () => {
  assert.ok(page(PARTS).includes("<title>a &quot;b&quot; &lt;c></title>"));
});
