// The extension stays small: the replay includes a 3D library.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { test } from "node:test";
import { VSIX, required } from "./harness/checkout.mjs";

const LARGEST = 2_000_000;

test("the VSIX has less than two megabytes", () => {
  const { size } = statSync(required(VSIX, "run npm run package in client-vscode"));
  assert.ok(size < LARGEST, `${size} bytes`);
});
