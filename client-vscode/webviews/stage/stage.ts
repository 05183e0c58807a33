// The scene in 3D: shapes on bodies, workspaces as outlines, an orbiting camera. Knows nothing of time or traces: a page
// places the bodies, and may do so with those of a recording, of a paused execution, or of a scene that is edited.
import "./stage.css";
import { Box3, Group, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { type Trace, local } from "../../src/panels/replay/answer";
import { element } from "../shared/elements";
import { floats, integers } from "./arrays";
import type { Force } from "./force";
import { Labels } from "./labels";
import { Forces, frames } from "./marks";
import { lights, meshed, outline, placed, solid } from "./solids";

/** What is drawn: parts of docs/schemas/trace.schema.json. */
export type Drawing = Pick<Trace, "shapes" | "meshes" | "bodies" | "workspaces">;

/** Initial direction of the camera, in multiples of the size of the scene. */
const OUTLOOK = new Vector3(0.9, -1.1, 0.75);
/** Largest distance from which the camera begins to follow a body, m. */
const NEAR = 1.2;
const KEYS = "Arrow keys orbit, with Shift they move, plus and minus zoom.";

export class Stage {
  /** The element takes keys of its own, so screen readers have to pass them on. */
  readonly root = element("div", {
    class: "stage",
    tabindex: 0,
    role: "application",
    "aria-roledescription": "3D view",
    "aria-label": "Scene",
    "aria-description": KEYS,
  });
  private readonly renderer = new WebGLRenderer({ antialias: true, alpha: true });
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(40, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly bodies: readonly Group[];
  private readonly labels = new Labels();
  private readonly home: { readonly centre: Vector3; readonly distance: number };
  private readonly axes: readonly Group[];
  private readonly pressed: Forces;
  private readonly resized: ResizeObserver;
  /** The followed body, and where it was. */
  private followed: { readonly body: Group; readonly at: Vector3 } | undefined;
  private requested = false;

  /** `moved` is called when the camera moves. Raises an error where the window has no WebGL. */
  constructor(
    drawing: Drawing,
    private readonly moved: () => void,
  ) {
    this.bodies = drawing.bodies.map(({ position, orientation }) => placed(new Group(), position, orientation));
    this.scene.add(...this.bodies, ...lights());
    const geometries = drawing.meshes.map(({ vertices, faces }) => meshed(floats(vertices), integers(faces)));
    for (const shape of drawing.shapes) {
      this.bodies[shape.body]?.add(solid(shape, geometries));
    }
    this.addWorkspaces(drawing);
    this.axes = frames(this.nameBodies(drawing));
    this.scene.add(...this.axes.slice(0, 1));
    this.framed = false;
    this.pressed = new Forces(this.bodies, this.labels);
    this.scene.add(this.pressed.lines);
    this.home = this.measured(drawing);
    this.root.append(this.renderer.domElement, this.labels.root);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => {
      this.moved();
      this.draw();
    });
    this.root.addEventListener("keydown", (event) => {
      this.steer(event);
    });
    this.resized = new ResizeObserver(() => {
      this.resize();
    });
    this.resized.observe(this.root);
    this.look();
  }

  /** Place a body in the world: x, y, z (m), then w, x, y, z. Takes effect with the next `draw`. */
  place(body: number, [x = 0, y = 0, z = 0, w = 1, i = 0, j = 0, k = 0]: readonly number[]): void {
    this.bodies[body]?.position.set(x, y, z);
    this.bodies[body]?.quaternion.set(i, j, k, w);
  }

  /** Draw soon, with all bodies where they have been placed; repeated requests are combined. */
  draw(): void {
    if (!this.requested) {
      this.requested = true;
      requestAnimationFrame(() => {
        this.render();
      });
    }
  }

  /** Reset the camera to the whole scene. */
  look(): void {
    const { centre, distance } = this.home;
    this.camera.position.copy(OUTLOOK).setLength(distance).add(centre);
    this.controls.target.copy(centre);
    this.controls.update();
    this.draw();
  }

  /** Let the camera move with a body from now on, and turn it towards the body; nothing is followed without one. */
  follow(body: number | undefined): void {
    const group = this.bodies[body ?? -1];
    this.followed = group === undefined ? undefined : { body: group, at: group.getWorldPosition(new Vector3()) };
    if (this.followed !== undefined) {
      const away = this.camera.position.clone().sub(this.controls.target);
      this.controls.target.copy(this.followed.at);
      this.camera.position.copy(this.followed.at).add(away.clampLength(0, NEAR));
      this.controls.update();
    }
    this.draw();
  }

  /** Show these contact forces, and none before them. */
  press(forces: readonly Force[]): void {
    this.pressed.show(forces);
    this.draw();
  }

  /** Position of the camera and its target, m. */
  get view(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }

  set view([x = 0, y = 0, z = 0, tx = 0, ty = 0, tz = 0]: readonly number[]) {
    this.camera.position.set(x, y, z);
    this.controls.target.set(tx, ty, tz);
    this.controls.update();
    this.draw();
  }

  /** Show or hide the names of elements. */
  set named(shown: boolean) {
    this.root.classList.toggle("nameless", !shown);
    this.draw();
  }

  /** Show or hide the coordinate frames of the world, the elements and the tools. */
  set framed(shown: boolean) {
    for (const axes of this.axes) {
      axes.visible = shown;
    }
    this.root.classList.toggle("framed", shown);
    this.draw();
  }

  /** The scene as it is seen now, with its labels, over the colour of the page. */
  picture(): HTMLCanvasElement {
    const { width, height } = this.renderer.domElement;
    const picture = element("canvas", { width, height });
    const into = picture.getContext("2d");
    if (into !== null) {
      // The canvas keeps its contents until the end of this turn only.
      this.render();
      into.fillStyle = getComputedStyle(document.body).backgroundColor;
      into.fillRect(0, 0, width, height);
      into.drawImage(this.renderer.domElement, 0, 0);
      this.labels.paint(into, this.renderer.getPixelRatio());
    }
    return picture;
  }

  /** Free the graphics memory of a stage that is replaced by another one. */
  dispose(): void {
    this.resized.disconnect();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.root.remove();
  }

  private addWorkspaces({ workspaces }: Drawing): void {
    for (const { name, body, center, half, orientation } of workspaces) {
      const carrier = body === null ? new Group() : this.bodies[body];
      if (carrier === undefined) {
        continue;
      }
      if (body === null) {
        this.scene.add(carrier);
      }
      const edges = outline(center, half, orientation);
      carrier.add(edges);
      // At a corner: its middle is occupied by its contents.
      const corner = new Vector3(-half[0], -half[1], half[2]).applyQuaternion(edges.quaternion).add(edges.position);
      this.labels.add(local(name), carrier, corner.toArray(), "workspace");
    }
  }

  /**
   * Name the elements: a robot once instead of each link, a workspace's carrier by the workspace, tools with their
   * frames. Returns the bodies whose frames matter.
   */
  private nameBodies({ bodies, workspaces }: Drawing): Group[] {
    const carriers = new Set(workspaces.map(({ body }) => body));
    const robots = new Set<string>();
    const framed: Group[] = [];
    for (const [index, { name }] of bodies.entries()) {
      const [robot = name, link] = name.split("/");
      const group = this.bodies[index];
      if (group === undefined || name === "world") {
        continue;
      }
      if (link === "tool") {
        framed.push(group);
        this.labels.add(`${local(robot)} tool`, group, [0, 0, 0], "frame");
      } else if (!robots.has(robot)) {
        robots.add(robot);
        framed.push(group);
        if (!carriers.has(index)) {
          this.labels.add(local(robot), group, link === undefined ? [0, 0, 0.04] : [0, 0, 0], "thing");
        }
      }
    }
    return framed;
  }

  /** The centre and extent of everything but infinite ground. */
  private measured({ shapes }: Drawing): { centre: Vector3; distance: number } {
    const box = new Box3();
    this.scene.updateMatrixWorld(true);
    for (const shape of shapes) {
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

  private render(): void {
    this.requested = false;
    this.pursue();
    this.renderer.render(this.scene, this.camera);
    this.labels.arrange(this.camera, this.root.clientWidth, this.root.clientHeight);
  }

  /** Move the camera as far as the followed body has moved. */
  private pursue(): void {
    if (this.followed === undefined) {
      return;
    }
    const at = this.followed.body.getWorldPosition(new Vector3());
    const step = at.clone().sub(this.followed.at);
    this.followed.at.copy(at);
    if (step.lengthSq() > 0) {
      this.camera.position.add(step);
      this.controls.target.add(step);
      this.controls.update();
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
    this.draw();
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
