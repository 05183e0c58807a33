// The server's answer to `robbdd/scene`: scene instances before anything moves. Metres, world frame; docs/schemas/scene.schema.json.
import type * as answers from "../../answers/scene";
import type { Immutable } from "../../immutable";
import type { PackedArray, Trace } from "../replay/answer";

export { isScenePicture } from "../../answers/validators.mjs";

export type ScenePicture = Immutable<answers.ScenePicture>;
export type DrawnScene = ScenePicture["scenes"][number];
export type SceneFault = DrawnScene["faults"][number];

/** Remark on a picture that is older than the text; empty if it is up to date. */
export function remark({ problem, scenes }: ScenePicture): string {
  if (problem === null) {
    return "";
  }
  return scenes.length > 0 ? `Out of date: ${problem}. This is the last scene without errors.` : `There is nothing to draw: ${problem}.`;
}

/** Notes on a scene: elements that are drawn at a sampled pose, or not at all. */
export function notes({ sampled, missing }: DrawnScene): string[] {
  return [
    ...(sampled.length > 0 ? [`At a sampled pose: ${sampled.join(", ")}.`] : []),
    ...(missing.length > 0 ? [`Not drawn, without a pose or a model that can be read: ${missing.join(", ")}.`] : []),
  ];
}

/** A scene as a recording without motion, as the stage draws it. */
export function still({ shapes, meshes, bodies, workspaces }: DrawnScene): Trace {
  const empty = (shape: readonly number[]): PackedArray => ({ type: "float32", shape, data: "" });
  return {
    run: 0,
    folder: "",
    scenario: {
      index: 0, name: "", values: "", story: "", variant: "", variation: 1, repetition: 1, seed: 0, verdict: "unknown", trace: false,
    },
    duration: 0,
    remark: "",
    shapes,
    meshes,
    bodies,
    workspaces,
    frames: { times: empty([0]), bodies: [], poses: empty([0, 0, 7]) },
    events: [],
    clauses: [],
  };
}
