// Names in a scene: elements of the page over the picture, moved so that none covers another.
import { type Camera, type Group, Vector3 } from "three";
import type { Triple } from "../../src/panels/replay/answer";
import { element } from "../shared/elements";
import { apart } from "./tags";

/** `thing` and `workspace` are names, `frame` is shown with coordinate frames only, `force` with forces only. */
export type LabelKind = "thing" | "workspace" | "frame" | "force";

export interface Label {
  readonly text: HTMLElement;
  readonly on: Group | undefined;
  readonly at: Vector3;
}

export class Labels {
  /** Screen readers read the list of elements elsewhere: positions in a picture mean nothing to them. */
  readonly root = element("div", { class: "names", "aria-hidden": "true" });
  private readonly labels = new Set<Label>();

  /** Name a place in the frame of a body; without a body, in the world (m). */
  add(name: string, on: Group | undefined, at: Triple, kind: LabelKind): Label {
    const label = { text: element("span", { class: `label ${kind}` }, name), on, at: new Vector3(...at) };
    this.labels.add(label);
    this.root.append(label.text);
    return label;
  }

  remove(label: Label): void {
    this.labels.delete(label);
    label.text.remove();
  }

  /** Move all labels to where a camera sees their places, in a window of this size (px). */
  arrange(camera: Camera, width: number, height: number): void {
    const seen = [...this.labels].flatMap(({ text, on, at }) => {
      const place = (on?.localToWorld(at.clone()) ?? at.clone()).project(camera);
      text.hidden = place.z > 1;
      const [x, y] = [((place.x + 1) / 2) * width, ((1 - place.y) / 2) * height];
      return text.hidden ? [] : [{ text, x, y, width: text.offsetWidth, height: text.offsetHeight }];
    });
    const edges = apart(seen);
    for (const [index, { text, x }] of seen.entries()) {
      text.style.left = `${x}px`;
      text.style.top = `${edges[index]}px`;
    }
  }

  /** Draw the visible labels into a picture of the window that has `ratio` pixels per px. */
  paint(into: CanvasRenderingContext2D, ratio: number): void {
    const origin = this.root.getBoundingClientRect();
    into.textAlign = "center";
    into.textBaseline = "middle";
    for (const { text } of this.labels) {
      const { left, top, width, height } = text.getBoundingClientRect();
      const style = getComputedStyle(text);
      if (width > 0) {
        const [x, y] = [(left - origin.left) * ratio, (top - origin.top) * ratio];
        into.fillStyle = style.backgroundColor;
        into.fillRect(x, y, width * ratio, height * ratio);
        into.fillStyle = style.color;
        into.font = `${Number.parseFloat(style.fontSize) * ratio}px ${style.fontFamily}`;
        into.fillText(text.textContent, x + (width * ratio) / 2, y + (height * ratio) / 2);
      }
    }
  }
}
