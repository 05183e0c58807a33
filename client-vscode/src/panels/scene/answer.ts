// The server's answer to `robbdd/scene`: scene instances before anything moves. Metres, world frame; docs/schemas/scene.schema.json.
import { type Location, isLocation } from "../../places";
import { isRecord } from "../../values";
import type { PackedArray, Trace } from "../replay/answer";

export interface SceneFault {
  readonly kind: string;
  readonly reason: string;
  readonly source: Location | null;
}

export interface DrawnScene extends Pick<Trace, "shapes" | "meshes" | "bodies" | "workspaces"> {
  readonly iri: string;
  readonly name: string;
  /** Elements at sampled poses. */
  readonly sampled: readonly string[];
  /** Elements that are not drawn. */
  readonly missing: readonly string[];
  readonly faults: readonly SceneFault[];
}

export interface ScenePicture {
  readonly uri: string;
  /** Why the scenes are older than the text or missing; null if they are up to date. */
  readonly problem: string | null;
  readonly scenes: readonly DrawnScene[];
}

const LISTS = ["shapes", "meshes", "bodies", "workspaces", "sampled", "missing", "faults"];

/** Whether an answer has the form of this version: its parts, but not every number. */
export function isScenePicture(value: unknown): value is ScenePicture {
  return (
    isRecord(value) &&
    typeof value["uri"] === "string" &&
    (value["problem"] === null || typeof value["problem"] === "string") &&
    Array.isArray(value["scenes"]) &&
    value["scenes"].every(isScene)
  );
}

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
    scenario: { index: 0, name: "", values: "", variant: "", variation: 0, repetition: 1, verdict: "unknown" },
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

function isScene(value: unknown): value is DrawnScene {
  return (
    isRecord(value) &&
    typeof value["iri"] === "string" &&
    typeof value["name"] === "string" &&
    LISTS.every((name) => Array.isArray(value[name])) &&
    (value["faults"] as unknown[]).every(isFault)
  );
}

function isFault(value: unknown): value is SceneFault {
  return isRecord(value) && typeof value["reason"] === "string" && (value["source"] === null || isLocation(value["source"]));
}
