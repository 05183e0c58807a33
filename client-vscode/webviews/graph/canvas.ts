// The server's picture in the page: shapes in the theme's colours, nodes with focus and click.
import { drawn } from "../shared/elements";
import type { Box, Size, Viewport } from "./viewport";

/** Maximum movement of the pointer during a click, pixels. */
const STILL = 4;

export class Canvas {
  readonly root = drawn("svg", { class: "canvas", tabindex: 0, role: "group", "aria-label": "Graph of the model" });
  private readonly scene = drawn("g");
  private nodes = new Map<string, SVGGElement>();
  private highlighted: string | null = null;
  /** The size of the picture without its legend; the page has its own. */
  picture: Size = { width: 1, height: 1 };

  constructor(private readonly open: (iri: string) => void) {
    this.root.append(this.scene);
    let pressed: { readonly x: number; readonly y: number } | undefined;
    this.root.addEventListener("pointerdown", (event) => {
      if (event.button === 0) {
        pressed = { x: event.clientX, y: event.clientY };
        this.root.setPointerCapture(event.pointerId);
      }
    });
    this.root.addEventListener("pointerup", (event) => {
      const still = pressed !== undefined && Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) <= STILL;
      pressed = undefined;
      if (still) {
        // A captured pointer sends all events to the root, so find the element under it.
        this.press(document.elementFromPoint(event.clientX, event.clientY));
      }
    });
    this.root.addEventListener("keydown", (event) => {
      if (event.key === "Enter" || event.key === " ") {
        this.press(event.target);
        event.preventDefault();
      }
    });
  }

  /** The size of the window. */
  get size(): Size {
    return { width: this.root.clientWidth, height: this.root.clientHeight };
  }

  /** Replace the picture; the focused node keeps the focus if it still exists. */
  show(svg: string): void {
    const focused = document.activeElement?.getAttribute("data-iri");
    const picture = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
    for (const part of picture.querySelectorAll(":scope > style, :scope > rect, :scope > .legend")) {
      part.remove();
    }
    this.scene.replaceChildren(...[...picture.children].map((part) => document.importNode(part, true)));
    const found = [...this.scene.querySelectorAll<SVGGElement>("[data-iri]")];
    this.nodes = new Map(found.map((node) => [node.getAttribute("data-iri") ?? "", node]));
    for (const node of found) {
      node.setAttribute("tabindex", "0");
      // Its name is what can be read in it.
      node.setAttribute("role", "link");
    }
    const box = this.scene.getBBox();
    this.picture = { width: Math.max(1, box.x + box.width), height: Math.max(1, box.y + box.height) };
    this.highlight(this.highlighted);
    if (focused !== null && focused !== undefined) {
      this.nodes.get(focused)?.focus({ preventScroll: true });
    }
  }

  place({ x, y, scale }: Viewport): void {
    this.scene.setAttribute("transform", `translate(${x} ${y}) scale(${scale})`);
  }

  /** Highlight a node and its links. */
  highlight(iri: string | null): void {
    this.highlighted = iri;
    for (const marked of this.scene.querySelectorAll(".current")) {
      marked.classList.remove("current");
    }
    if (iri !== null) {
      this.nodes.get(iri)?.classList.add("current");
      for (const link of this.scene.querySelectorAll("path.link")) {
        if (link.getAttribute("data-from") === iri || link.getAttribute("data-to") === iri) {
          link.classList.add("current");
        }
      }
    }
  }

  /** The box of a node in the picture; undefined if it is not shown. */
  boxOf(iri: string): Box | undefined {
    return this.nodes.get(iri)?.getBBox();
  }

  private press(target: EventTarget | null): void {
    const iri = target instanceof Element ? target.closest("[data-iri]")?.getAttribute("data-iri") : undefined;
    if (iri !== null && iri !== undefined) {
      this.open(iri);
    }
  }
}
