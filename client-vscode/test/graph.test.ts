import assert from "node:assert/strict";
import { test } from "node:test";
import { type GraphPicture, isGraphPicture, remark } from "../src/panels/graph/answer";
import { LARGEST, centred, fitted, panned, revealed, zoomed } from "../webviews/graph/viewport";

const WINDOW = { width: 800, height: 600 };
const NODE = { iri: "i", concept: "story", name: "sort", source: null } as const;
const PICTURE: GraphPicture = {
  uri: "file:///m.bdd",
  svg: "<svg/>",
  problem: null,
  nodes: [NODE],
  places: [],
  shown: 1,
  total: 1,
  root: null,
};

test("a picture is fitted into the middle of its window and not enlarged", () => {
  assert.deepEqual(fitted({ width: 400, height: 100 }, WINDOW), { x: 200, y: 250, scale: 1 });
  const wide = fitted({ width: 7680, height: 100 }, WINDOW);
  assert.equal(wide.scale, 0.1);
  assert.equal(wide.x, 16);
  assert.equal(fitted({ width: 7680, height: 100 }, WINDOW, 0.5).scale, 0.5);
});

test("zooming keeps the point under the pointer, within limits", () => {
  const view = { x: 30, y: -20, scale: 0.5 };
  const larger = zoomed(view, 2, 130, 80);
  assert.deepEqual(larger, { x: -70, y: -120, scale: 1 });
  // The point of the picture under the pointer, before and after.
  assert.equal((130 - view.x) / view.scale, (130 - larger.x) / larger.scale);
  assert.equal(zoomed(view, 1000, 0, 0).scale, LARGEST);
});

test("a node in view moves nothing, one outside comes in by the shortest way", () => {
  const view = { x: 0, y: 0, scale: 1 };
  assert.deepEqual(revealed(view, { x: 100, y: 100, width: 200, height: 50 }, WINDOW), view);
  assert.deepEqual(revealed(view, { x: 700, y: -50, width: 200, height: 50 }, WINDOW), { x: -116, y: 66, scale: 1 });
  const shifted = panned(view, 5, 7);
  assert.deepEqual(revealed(shifted, { x: 0, y: 50, width: 2000, height: 10 }, WINDOW), { x: 16, y: 7, scale: 1 });
});

test("a node is shown in the middle at the size of the view, a large one from its start", () => {
  const view = { x: 5, y: 7, scale: 2 };
  assert.deepEqual(centred(view, { x: 100, y: 50, width: 100, height: 20 }, WINDOW), { x: 100, y: 180, scale: 2 });
  assert.deepEqual(centred(view, { x: 100, y: 50, width: 500, height: 20 }, WINDOW), { x: -184, y: 180, scale: 2 });
});

test("a picture that does not show the whole current model has a remark", () => {
  assert.equal(remark(PICTURE), "");
  assert.match(remark({ ...PICTURE, problem: "line 3: oh" }), /^Out of date.*line 3: oh.*the last picture without errors/);
  assert.match(remark({ ...PICTURE, svg: "", problem: "line 3: oh" }), /nothing to draw yet/);
  assert.match(remark({ ...PICTURE, shown: 0, total: 0 }), /no story/);
  assert.match(remark({ ...PICTURE, shown: 600, total: 4000, root: NODE }), /^600 of 4000 nodes around sort/);
});

test("an answer of another version is told apart", () => {
  assert.ok(isGraphPicture(PICTURE));
  assert.ok(isGraphPicture({ ...PICTURE, root: NODE }));
  for (const other of [undefined, {}, { ...PICTURE, svg: 1 }, { ...PICTURE, nodes: [{}] }, { ...PICTURE, places: [{}] }]) {
    assert.ok(!isGraphPicture(other));
  }
});
