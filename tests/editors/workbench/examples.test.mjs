// The examples in one window: each story begins with no editor open and with the examples as they are.
import { after, describe } from "node:test";
import { SharedWindow } from "./harness/story.mjs";
import { editing } from "./stories/editing.mjs";
import { edits } from "./stories/edits.mjs";
import { graph } from "./stories/graph.mjs";
import { preview } from "./stories/preview.mjs";
import { running } from "./stories/running.mjs";
import { verdicts } from "./stories/verdicts.mjs";

const window = new SharedWindow();

after(() => window.close());

for (const story of [preview, graph, editing, edits, verdicts, running]) {
  describe(story.name, () => story(window));
}
