// Messages between the extension and the page of a scene.
import type { DrawnScene } from "./answer";

export interface ToScene {
  readonly type: "scenes";
  readonly uri: string;
  readonly scenes: readonly DrawnScene[];
  /** Why the scenes are older than the text; empty if they are not. */
  readonly remark: string;
}

/** In addition to `{ type: "ready" }`: the numbers of a scene and of its fault whose text is requested. */
export interface FromScene {
  readonly type: "open";
  readonly scene: number;
  readonly fault: number;
}

/** State that a page keeps over reloads. */
export interface SceneState {
  readonly uri: string;
  readonly scene: string;
  readonly camera?: readonly number[];
}
