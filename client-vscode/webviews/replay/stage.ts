// The scene in 3D: shapes on bodies, workspaces as outlines, an orbiting camera.
import {
  AmbientLight,
  Box3,
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  DirectionalLight,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SphereGeometry,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { type Shape, type Trace, type Triple, type Turn, local } from "../../src/panels/replay/answer";
import { element } from "../shared/elements";
import { floats, integers } from "./arrays";
import { Motion } from "./motion";
import { apart } from "./tags";

/** Half edge of an infinite plane, m. */
const ENDLESS = 4;
const WORKSPACE = 0x3d8bd4;
/** Initial direction of the camera, in multiples of the size of the scene. */
const OUTLOOK = new Vector3(0.9, -1.1, 0.75);

export class Stage {
  readonly root = element("div", { class: "stage", tabindex: 0, role: "img", "aria-label": "Recorded scene" });
  private readonly renderer = new WebGLRenderer({ antialias: true, alpha: true });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(40, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly bodies: readonly Group[];
  private readonly motion: Motion;
  private readonly labels: { readonly text: HTMLElement; readonly on: Group; readonly at: Vector3 }[] = [];
  private readonly home: { readonly centre: Vector3; readonly distance: number };
  private requested = false;

  /** Raises an error where the window has no WebGL. */
  constructor(
    trace: Trace,
    private readonly moved: () => void,
  ) {
    this.motion = new Motion(trace);
    this.bodies = trace.bodies.map(({ position, orientation }) => placed(new Group(), position, orientation));
    this.scene.add(...this.bodies, ...lights());
    const geometries = trace.meshes.map(({ vertices, faces }) => meshed(floats(vertices), integers(faces)));
    for (const shape of trace.shapes) {
      this.bodies[shape.body]?.add(solid(shape, geometries));
    }
    this.addWorkspaces(trace);
    this.addNames(trace);
    this.home = this.measured(trace);
    this.root.append(this.renderer.domElement);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => {
      this.moved();
      this.request();
    });
    this.root.addEventListener("keydown", (event) => {
      this.steer(event);
    });
    new ResizeObserver(() => {
      this.resize();
    }).observe(this.root);
    this.look();
  }

  /** Show a time, s. */
  show(time: number): void {
    this.motion.at(time, (body, [x = 0, y = 0, z = 0, w = 1, i = 0, j = 0, k = 0]) => {
      const group = this.bodies[body];
      group?.position.set(x, y, z);
      group?.quaternion.set(i, j, k, w);
    });
    this.request();
  }

  /** Reset the camera to the whole scene. */
  look(): void {
    const { centre, distance } = this.home;
    this.camera.position.copy(OUTLOOK).setLength(distance).add(centre);
    this.controls.target.copy(centre);
    this.controls.update();
    this.request();
  }

  /** Release the graphics memory. */
  dispose(): void {
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  /** Position of the camera and its target, m. */
  get view(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }

  set view([x = 0, y = 0, z = 0, tx = 0, ty = 0, tz = 0]: readonly number[]) {
    this.camera.position.set(x, y, z);
    this.controls.target.set(tx, ty, tz);
    this.controls.update();
    this.request();
  }

  /** Show or hide the names of elements. */
  set named(shown: boolean) {
    this.root.classList.toggle("nameless", !shown);
  }

  private addWorkspaces({ workspaces }: Trace): void {
    for (const { name, body, center, half } of workspaces) {
      const carrier = body === null ? new Group() : this.bodies[body];
      if (carrier === undefined) {
        continue;
      }
      if (body === null) {
        this.scene.add(carrier);
      }
      const edges = new EdgesGeometry(new BoxGeometry(...doubled(half)));
      const box = new LineSegments(edges, new LineBasicMaterial({ color: WORKSPACE, transparent: true, opacity: 0.8 }));
      carrier.add(placed(box, center));
      // At a corner: its middle is occupied by its contents.
      this.label(local(name), carrier, [center[0] - half[0], center[1] - half[1], center[2] + half[2]], "workspace");
    }
  }

  /** Name the elements; a robot once instead of each link, and a workspace's carrier by the workspace. */
  private addNames({ bodies, workspaces }: Trace): void {
    const carriers = new Set(workspaces.map(({ body }) => body));
    const robots = new Set<string>();
    for (const [index, { name }] of bodies.entries()) {
      const [robot = name, link] = name.split("/");
      const group = this.bodies[index];
      if (name === "world" || carriers.has(index) || robots.has(robot) || group === undefined) {
        continue;
      }
      robots.add(robot);
      this.label(local(robot), group, link === undefined ? [0, 0, 0.04] : [0, 0, 0], "thing");
    }
  }

  private label(name: string, on: Group, at: Triple, kind: string): void {
    const text = element("span", { class: `label ${kind}` }, name);
    this.labels.push({ text, on, at: new Vector3(...at) });
    this.root.append(text);
  }

  /** The centre and extent of everything but infinite ground. */
  private measured(trace: Trace): { centre: Vector3; distance: number } {
    const box = new Box3();
    this.scene.updateMatrixWorld(true);
    for (const shape of trace.shapes) {
      if (shape.kind !== "plane") {
        box.expandByPoint(this.bodies[shape.body]?.localToWorld(new Vector3(...shape.position)) ?? new Vector3());
      }
    }
    const centre = box.isEmpty() ? new Vector3() : box.getCenter(new Vector3());
    const reach = box.isEmpty() ? 1 : box.getSize(new Vector3()).length();
    return { centre, distance: Math.max(0.5, reach * 1.3) };
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.root;
    if (clientWidth > 0 && clientHeight > 0) {
      this.renderer.setPixelRatio(window.devicePixelRatio);
      this.renderer.setSize(clientWidth, clientHeight);
      this.camera.aspect = clientWidth / clientHeight;
      this.camera.updateProjectionMatrix();
      this.render();
    }
  }

  /** Draw soon; combine repeated requests. */
  private request(): void {
    if (!this.requested) {
      this.requested = true;
      requestAnimationFrame(() => {
        this.render();
      });
    }
  }

  private render(): void {
    this.requested = false;
    this.renderer.render(this.scene, this.camera);
    const { clientWidth, clientHeight } = this.root;
    const seen = this.labels.flatMap(({ text, on, at }) => {
      const place = on.localToWorld(at.clone()).project(this.camera);
      text.hidden = place.z > 1;
      const [x, y] = [((place.x + 1) / 2) * clientWidth, ((1 - place.y) / 2) * clientHeight];
      return text.hidden ? [] : [{ text, x, y, width: text.offsetWidth, height: text.offsetHeight }];
    });
    const edges = apart(seen);
    for (const [index, { text, x }] of seen.entries()) {
      text.style.left = `${x}px`;
      text.style.top = `${edges[index]}px`;
    }
  }

  /** Camera control by keys: arrows orbit, with Shift pan, + and − zoom. */
  private steer(event: KeyboardEvent): void {
    const turn = TURNS[event.key];
    if (turn === undefined || event.ctrlKey || event.metaKey || event.altKey) {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
    const away = this.camera.position.clone().sub(this.controls.target);
    const side = new Vector3(-away.y, away.x, 0).normalize();
    const [round, up, nearer] = turn;
    if (event.shiftKey && nearer === 1) {
      const step = side.multiplyScalar(round).add(new Vector3(0, 0, up)).multiplyScalar(away.length());
      this.camera.position.add(step);
      this.controls.target.add(step);
    } else {
      away.applyAxisAngle(new Vector3(0, 0, 1), round).applyAxisAngle(side, -up).multiplyScalar(nearer);
      this.camera.position.copy(this.controls.target).add(away);
    }
    this.controls.update();
    this.request();
  }
}

/** Key → rotation around the vertical and upwards (rad), change of distance. */
const TURNS: Readonly<Record<string, readonly [number, number, number]>> = {
  ArrowLeft: [-0.1, 0, 1],
  ArrowRight: [0.1, 0, 1],
  ArrowUp: [0, 0.1, 1],
  ArrowDown: [0, -0.1, 1],
  "+": [0, 0, 1 / 1.2],
  "=": [0, 0, 1 / 1.2],
  "-": [0, 0, 1.2],
};

function lights(): (AmbientLight | DirectionalLight)[] {
  const sun = new DirectionalLight(0xffffff, 2);
  sun.position.set(1.5, -2, 4);
  const fill = new DirectionalLight(0xffffff, 0.6);
  fill.position.set(-2, 1.5, 1);
  return [new AmbientLight(0xffffff, 1.1), sun, fill];
}

function solid(shape: Shape, meshes: readonly BufferGeometry[]): Mesh {
  const [red, green, blue, opacity] = shape.color;
  const material = new MeshLambertMaterial({
    color: new Color().setRGB(red, green, blue, "srgb"),
    transparent: opacity < 1,
    opacity,
  });
  return placed(new Mesh(geometry(shape, meshes), material), shape.position, shape.orientation);
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

function meshed(vertices: Float32Array, faces: Uint32Array): BufferGeometry {
  const made = new BufferGeometry();
  made.setAttribute("position", new BufferAttribute(vertices, 3));
  made.setIndex(new BufferAttribute(faces, 1));
  // Each triangle has its own corners, so that edges of machine parts stay sharp.
  const flat = made.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

function placed<Thing extends Group | Mesh | LineSegments>(thing: Thing, at: Triple, turn: Turn = [1, 0, 0, 0]): Thing {
  const [w, x, y, z] = turn;
  thing.position.set(...at);
  thing.quaternion.set(x, y, z, w);
  return thing;
}

function doubled([x, y, z]: Triple): [number, number, number] {
  return [2 * x, 2 * y, 2 * z];
}
