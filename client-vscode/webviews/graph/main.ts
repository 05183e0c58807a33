// The graph page: a picture with pan and zoom, whose nodes link to their text.
import "./graph.css";
import type { FromGraph, GraphState, ToGraph } from "../../src/panels/graph/messages";
import { drawn, element, iconButton } from "../shared/elements";
import { connect } from "../shared/host";
import { toolbar } from "../shared/toolbar";
import { Canvas } from "./canvas";
import { type Viewport, centred, fitted, panned, revealed, zoomed } from "./viewport";

const STEP = 60;
const ZOOM = 1.25;
/** Minimum initial scale: the text of nodes has the size of the editor's interface then, and a smaller one is not readable. */
const READABLE = 1;

const host = connect<FromGraph, GraphState>((message) => {
  receive(message as ToGraph);
});
const status = element("div", { role: "status" });
const percent = element("span", { class: "percent", "aria-live": "off" });
const canvas = new Canvas((iri) => {
  host.post({ type: "open", iri });
});
let view: Viewport = host.kept?.view ?? { x: 0, y: 0, scale: 1 };
let uri = host.kept?.uri ?? "";
/** The shown subject; undefined at first. */
let subject = host.kept?.subject;
/** The picture is new, and the node at the cursor has not been shown in it. */
let fresh = false;

document.body.append(
  element(
    "header",
    {},
    toolbar(
      "Picture",
      iconButton("whole", "Show the whole picture (0)", fit),
      iconButton("smaller", "Smaller (−, Ctrl+wheel)", () => {
        zoom(1 / ZOOM);
      }),
      percent,
      iconButton("larger", "Larger (+, Ctrl+wheel)", () => {
        zoom(ZOOM);
      }),
    ),
    legend(),
  ),
  status,
  canvas.root,
);

function receive(message: ToGraph): void {
  if (message.type === "highlight") {
    canvas.highlight(message.iri);
    if (message.move) {
      bringIntoView(message.iri, fresh);
    }
    fresh &&= !message.move;
    return;
  }
  uri = message.uri;
  status.textContent = message.remark;
  status.classList.toggle("problem", message.outdated);
  canvas.show(message.svg);
  const other = subject !== message.subject;
  subject = message.subject;
  fresh ||= other;
  move(other ? fitted(canvas.picture, canvas.size, READABLE) : view);
}

/** Pan to a node: as little as needed or, in a picture that is still unmoved, until it is in the middle. */
function bringIntoView(iri: string | null, toMiddle = false): void {
  const box = iri === null ? undefined : canvas.boxOf(iri);
  if (box !== undefined) {
    move(toMiddle ? centred(view, box, canvas.size) : revealed(view, box, canvas.size));
  }
}

function fit(): void {
  move(fitted(canvas.picture, canvas.size));
}

function zoom(factor: number, x = canvas.size.width / 2, y = canvas.size.height / 2): void {
  move(zoomed(view, factor, x, y));
}

function move(to: Viewport): void {
  view = to;
  canvas.place(view);
  percent.textContent = `${Math.round(view.scale * 100)} %`;
  if (subject !== undefined) {
    host.keep({ uri, subject, view });
  }
}

const KEYS: Readonly<Record<string, () => void>> = {
  ArrowLeft: () => {
    move(panned(view, STEP, 0));
  },
  ArrowRight: () => {
    move(panned(view, -STEP, 0));
  },
  ArrowUp: () => {
    move(panned(view, 0, STEP));
  },
  ArrowDown: () => {
    move(panned(view, 0, -STEP));
  },
  "+": () => {
    zoom(ZOOM);
  },
  "=": () => {
    zoom(ZOOM);
  },
  "-": () => {
    zoom(1 / ZOOM);
  },
  "0": fit,
};

canvas.root.addEventListener("keydown", (event) => {
  const action = event.ctrlKey || event.metaKey || event.altKey ? undefined : KEYS[event.key];
  if (action !== undefined) {
    action();
    event.preventDefault();
  }
});
canvas.root.addEventListener(
  "wheel",
  (event) => {
    event.preventDefault();
    if (event.ctrlKey || event.metaKey) {
      zoom(Math.exp(-event.deltaY / 300), event.offsetX, event.offsetY);
    } else {
      move(event.shiftKey ? panned(view, -event.deltaY, 0) : panned(view, -event.deltaX, -event.deltaY));
    }
  },
  { passive: false },
);
canvas.root.addEventListener("pointermove", (event) => {
  if (canvas.root.hasPointerCapture(event.pointerId)) {
    move(panned(view, event.movementX, event.movementY));
  }
});
canvas.root.addEventListener("focusin", ({ target }) => {
  const iri = target instanceof Element ? target.getAttribute("data-iri") : null;
  bringIntoView(iri);
});

/** The legend of colours, without shapes: these are in the picture. */
function legend(): HTMLElement {
  const words = {
    story: "User story",
    variant: "Variant",
    template: "Template",
    given: "Given",
    when: "When",
    then: "Then",
    event: "Event",
    node: "Tree node",
  };
  const entries = Object.entries(words).map(([concept, word]) =>
    element(
      "li",
      {},
      drawn(
        "svg",
        { width: 14, height: 12, "aria-hidden": "true", "data-concept": concept },
        drawn("rect", { x: 1, y: 1, width: 12, height: 10, "stroke-width": 1.5 }),
      ),
      word,
    ),
  );
  return element("ul", { class: "legend", "aria-label": "Colours" }, ...entries);
}
