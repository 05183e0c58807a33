// The extension stays small: a replay brings a library for three dimensions along.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { test } from "node:test";
import { VSIX, required } from "./harness/checkout.mjs";

const LARGEST = 2_000_000;

test("the VSIX has less than two megabytes", () => {
  const { size } = statSync(required(VSIX, "run npm run package in client-vscode"));
  assert.ok(size < LARGEST, `${size} bytes`);
});
