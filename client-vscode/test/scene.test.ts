// The scene of a `.scenex`: one request at a time, the newest text at the end, notes and places of faults.
import assert from "node:assert/strict";
import { test } from "node:test";
import { type DrawnScene, isScenePicture, notes, remark, still } from "../src/panels/scene/answer";

const SCENE: DrawnScene = {
  iri: "https://example.org/cell",
  name: "cell",
  shapes: [],
  meshes: [],
  bodies: [{ name: "table", position: [0.5, 0, 0.1], orientation: [1, 0, 0, 0] }],
  workspaces: [],
  sampled: ["cube0"],
  missing: ["five"],
  faults: [{ kind: "overlap", reason: "'bin' and 'table' overlap by 3 mm", source: null }],
};
const PICTURE = { uri: "file:///cell.scenex", problem: null, scenes: [SCENE] };

test("only answers with all parts are accepted", () => {
  assert.ok(isScenePicture(PICTURE));
  assert.ok(isScenePicture({ ...PICTURE, problem: "line 3: no", scenes: [] }));
  for (const part of ["uri", "problem", "scenes"]) {
    assert.ok(!isScenePicture({ ...PICTURE, [part]: undefined }), part);
  }
  for (const part of Object.keys(SCENE)) {
    assert.ok(!isScenePicture({ ...PICTURE, scenes: [{ ...SCENE, [part]: undefined }] }), part);
  }
  assert.ok(!isScenePicture({ ...PICTURE, scenes: [{ ...SCENE, faults: [{ reason: "x", source: "here" }] }] }));
});

test("an outdated scene has a reason", () => {
  assert.equal(remark(PICTURE), "");
  assert.equal(remark({ ...PICTURE, problem: "line 3: no" }), "Out of date: line 3: no. This is the last scene without errors.");
  assert.equal(remark({ ...PICTURE, problem: "line 3: no", scenes: [] }), "There is nothing to draw: line 3: no.");
});

test("sampled and missing elements are named", () => {
  assert.deepEqual(notes(SCENE), ["At a sampled pose: cube0.", "Not drawn, without a pose or a model that can be read: five."]);
  assert.deepEqual(notes({ ...SCENE, sampled: [], missing: [] }), []);
});

test("a scene is a recording without motion", () => {
  const { bodies, frames, duration } = still(SCENE);
  assert.deepEqual([bodies, frames.bodies, duration], [SCENE.bodies, [], 0]);
});
