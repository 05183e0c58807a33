// Shapes and lights of a scene as objects of three.js.
import {
  AmbientLight,
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  DirectionalLight,
  EdgesGeometry,
  type Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  PlaneGeometry,
  SphereGeometry,
} from "three";
import type { Shape, Triple, Turn } from "../../src/panels/replay/answer";

/** Half edge of an infinite plane, m. */
const ENDLESS = 4;
const OUTLINE = 0x3d8bd4;

export function lights(): (AmbientLight | DirectionalLight)[] {
  const sun = new DirectionalLight(0xffffff, 2);
  sun.position.set(1.5, -2, 4);
  const fill = new DirectionalLight(0xffffff, 0.6);
  fill.position.set(-2, 1.5, 1);
  return [new AmbientLight(0xffffff, 1.1), sun, fill];
}

export function solid(shape: Shape, meshes: readonly BufferGeometry[]): Mesh {
  const [red, green, blue, opacity] = shape.color;
  const material = new MeshLambertMaterial({
    color: new Color().setRGB(red, green, blue, "srgb"),
    transparent: opacity < 1,
    opacity,
  });
  return placed(new Mesh(geometry(shape, meshes), material), shape.position, shape.orientation);
}

/** The edges of a box with these half edges, m, rotated about its centre. */
export function outline(centre: Triple, [x, y, z]: Triple, turn?: Turn): LineSegments {
  const edges = new EdgesGeometry(new BoxGeometry(2 * x, 2 * y, 2 * z));
  return placed(new LineSegments(edges, new LineBasicMaterial({ color: OUTLINE, transparent: true, opacity: 0.8 })), centre, turn);
}

/** Place something in the frame of its parent. */
export function placed<Thing extends Group | Mesh | LineSegments>(thing: Thing, at: Triple, turn: Turn = [1, 0, 0, 0]): Thing {
  const [w, x, y, z] = turn;
  thing.position.set(...at);
  thing.quaternion.set(x, y, z, w);
  return thing;
}

export function meshed(vertices: Float32Array, faces: Uint32Array): BufferGeometry {
  const made = new BufferGeometry();
  made.setAttribute("position", new BufferAttribute(vertices, 3));
  made.setIndex(new BufferAttribute(faces, 1));
  // Each triangle has its own corners, so that edges of machine parts stay sharp.
  const flat = made.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

function geometry({ kind, size: [a, b, c], mesh }: Shape, meshes: readonly BufferGeometry[]): BufferGeometry {
  switch (kind) {
    case "box":
      return new BoxGeometry(2 * a, 2 * b, 2 * c);
    case "sphere":
      return new SphereGeometry(a, 32, 20);
    case "ellipsoid":
      return new SphereGeometry(1, 32, 20).scale(a, b, c);
    // Cylinders of three are along y, ours along z.
    case "cylinder":
      return new CylinderGeometry(a, a, 2 * b, 32).rotateX(Math.PI / 2);
    case "capsule":
      return new CapsuleGeometry(a, 2 * b, 8, 24).rotateX(Math.PI / 2);
    case "plane":
      return new PlaneGeometry(2 * (a || ENDLESS), 2 * (b || ENDLESS));
    case "mesh":
      return meshes[mesh ?? -1] ?? new BufferGeometry();
  }
}
