// Marks on demand: coordinate frames of bodies, and contact forces between them.
import { AxesHelper, BufferAttribute, BufferGeometry, Color, Group, LineBasicMaterial, LineSegments, Vector3 } from "three";
import type { Force } from "./force";
import type { Label, Labels } from "./labels";

/** Length of the axes of a body's frame and of the world's, m. */
const AXES = 0.12;
const WORLD_AXES = 0.3;
/** Of x, y and z, as everywhere in robotics. */
const COLOURS = [new Color(0xe5322d), new Color(0x2da44e), new Color(0x2f6feb)] as const;
const PRESSED = 0xf0883e;

/** Axes (x red, y green, z blue) of bodies, drawn over all shapes. */
export function frames(bodies: readonly Group[]): Group[] {
  const made = bodies.map((body) => {
    const axes = new Group();
    axes.add(arrows(AXES));
    body.add(axes);
    return axes;
  });
  const world = new Group();
  world.add(arrows(WORLD_AXES));
  return [world, ...made];
}

function arrows(length: number): AxesHelper {
  const axes = new AxesHelper(length).setColors(...COLOURS);
  const materials = Array.isArray(axes.material) ? axes.material : [axes.material];
  for (const material of materials) {
    material.depthTest = false;
  }
  axes.renderOrder = 1;
  return axes;
}

/** Forces as lines between the bodies in contact, each with its words at the middle. */
export class Forces {
  readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: PRESSED, depthTest: false, linewidth: 2 }));
  private labels: readonly Label[] = [];

  constructor(
    private readonly bodies: readonly Group[],
    private readonly names: Labels,
  ) {
    this.lines.renderOrder = 1;
    this.lines.frustumCulled = false;
  }

  show(forces: readonly Force[]): void {
    for (const label of this.labels) {
      this.names.remove(label);
    }
    const ends = forces.map(({ between }) => between.map((body) => this.place(body)));
    this.lines.geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends.flat().flatMap((end) => end.toArray())), 3));
    this.labels = forces.map(({ words }, index) => {
      const [one = new Vector3(), other = new Vector3()] = ends[index] ?? [];
      const { x, y, z } = one.clone().add(other).multiplyScalar(0.5);
      return this.names.add(words, undefined, [x, y, z], "force");
    });
  }

  private place(body: number): Vector3 {
    return this.bodies[body]?.getWorldPosition(new Vector3()) ?? new Vector3();
  }
}
