// The example in a window of its own: it has to be without a problem, and runs of another story may leave some.
import { after } from "node:test";
import { SharedWindow } from "./harness/story.mjs";
import { example } from "./stories/example.mjs";

const window = new SharedWindow();

after(() => window.close());

example(window);
