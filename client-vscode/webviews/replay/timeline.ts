// The timeline: events, the window of each clause in the colour of its verdict, the margin of the selected one.
import { type Clause, type Trace, local } from "../../src/panels/replay/answer";
import { signed } from "../../src/quantity";
import { drawn, element, iconButton } from "../shared/elements";
import { marginPlot } from "./plot";
import { type Scale, lanes, scale, ticks } from "./scale";

const ROW = 24;
const LANE = 15;
const AXIS = 20;
const PLOT = 120;
const EDGE = 14;
/** Mean width of a letter of a label, px. */
const LETTER = 6.2;
const EDITED = "This is the judged clause; the model has changed since.";
const SIGNS = { holds: "✔", violated: "✗", unknown: "?" } as const;

export interface Timeline {
  readonly root: HTMLElement;
  /** Draw everything for the current width. */
  readonly draw: (chosen: number) => void;
  /** Move the time marker, s. */
  readonly mark: (time: number) => void;
}

export interface Actions {
  readonly seek: (time: number) => void;
  readonly choose: (clause: number) => void;
  readonly open: (clause: number) => void;
}

export function timeline({ duration, events, clauses }: Trace, actions: Actions): Timeline {
  const labels = element("div", { class: "labels" });
  const tracks = drawn("svg", { class: "tracks", "aria-hidden": "true" });
  const root = element("section", { class: "timeline", "aria-label": "Time line" }, labels, tracks);
  const playhead = drawn("line", { class: "playhead" });
  let along: Scale = scale(0, duration, 0, 1);

  const draw = (chosen: number) => {
    const width = Math.max(120, tracks.clientWidth);
    along = scale(0, duration, EDGE, width - EDGE);
    const named = events.map(({ name, time }) => ({ name: local(name), time, start: along(time) + 3 }));
    const placed = named.map(({ name, start }) => {
      const length = name.length * LETTER + 6;
      // A label at the end of the line is drawn before its event.
      return { start: Math.min(start, width - length), width: length };
    });
    const lane = lanes(placed);
    const head = AXIS + LANE * (Math.max(0, ...lane) + 1);
    const high = head + clauses.length * ROW + PLOT + EDGE;
    tracks.setAttribute("height", String(high));
    playhead.setAttribute("y1", String(AXIS - 5));
    playhead.setAttribute("y2", String(high));
    tracks.replaceChildren(
      ...axis(along, duration, width),
      ...named.map(({ time }, index) => drawn("line", { class: "event", x1: along(time), x2: along(time), y1: AXIS + LANE * (lane[index] ?? 0), y2: high })),
      // Draw below all lines, which would otherwise cross the names of other events.
      ...named.map(({ name }, index) => drawn("text", { class: "event", x: placed[index]?.start ?? 0, y: AXIS + LANE * ((lane[index] ?? 0) + 1) - 4 }, name)),
      ...clauses.map((clause, index) => windows(clause, along, head + index * ROW, index === chosen, width)),
      ...marginPlot(clauses[chosen], along, { top: head + clauses.length * ROW + 6, height: PLOT, width }),
      playhead,
    );
    const rows = clauses.map((clause, index) => row(clause, index, index === chosen, actions));
    const held = buttonsOf(labels).findIndex((one) => one === document.activeElement);
    labels.replaceChildren(element("div", { class: "space" }, ""), ...rows, caption(clauses[chosen]));
    // Keep the keyboard focus.
    buttonsOf(labels)[held]?.focus({ preventScroll: true });
    labels.style.setProperty("--head", `${head}px`);
  };

  labels.addEventListener("keydown", (event) => {
    const names = [...labels.querySelectorAll<HTMLElement>(".name")];
    const at = names.findIndex((one) => one === document.activeElement);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (at >= 0 && step !== undefined) {
      names[at + step]?.focus();
      event.preventDefault();
    }
  });
  dragged(tracks, (x) => {
    actions.seek(along.back(x));
  });
  return {
    root,
    draw,
    mark: (time) => {
      playhead.setAttribute("x1", String(along(time)));
      playhead.setAttribute("x2", String(along(time)));
    },
  };
}

function buttonsOf(list: HTMLElement): HTMLButtonElement[] {
  return [...list.querySelectorAll("button")];
}

function axis(along: Scale, duration: number, width: number): SVGElement[] {
  return ticks(0, duration, width / 80).flatMap((time) => [
    drawn("line", { class: "tick", x1: along(time), x2: along(time), y1: AXIS - 5, y2: AXIS }),
    drawn("text", { class: "time", x: along(time), y: AXIS - 8, "text-anchor": "middle" }, `${time} s`),
  ]);
}

/** The windows of a clause: a bar, or a diamond for a single instant; a cross marks the violation. */
function windows(clause: Clause, along: Scale, top: number, chosen: boolean, width: number): SVGElement {
  const middle = top + ROW / 2;
  const group = drawn("g", { class: `clause ${clause.verdict}${chosen ? " chosen" : ""}` });
  group.append(drawn("rect", { class: "ground", x: 0, y: top, width, height: ROW }));
  for (const { start, end } of clause.parts) {
    if (start === null || end === null) {
      continue;
    }
    const [from, to] = [along(start), along(end)];
    group.append(
      to - from < 6
        ? drawn("path", { class: "window", d: `M${from} ${middle - 7}l7 7l-7 7l-7 -7z` })
        : drawn("rect", { class: "window", x: from, y: middle - 6, width: to - from, height: 12, rx: 2 }),
    );
  }
  if (clause.verdict === "violated" && clause.at !== null) {
    const x = along(clause.at);
    group.append(drawn("path", { class: "violation", d: `M${x - 4} ${middle - 4}l8 8m0 -8l-8 8` }));
  }
  return group;
}

function row(clause: Clause, index: number, chosen: boolean, { choose, open }: Actions): HTMLElement {
  const { verdict, name, role, sentence, reason, vacuous } = clause;
  const title = [`${role}: ${sentence}`, marginWords(clause), reason, vacuous].filter((text) => text !== "").join("\n");
  const label = element("button", { type: "button", class: "name", title, "aria-pressed": String(chosen) });
  label.append(element("span", { class: `sign ${verdict}`, role: "img", "aria-label": verdict }, SIGNS[verdict]), shown(name, sentence));
  label.addEventListener("click", () => {
    choose(index);
  });
  const source = iconButton("source", `Go to the text of ${name}`, () => {
    open(index);
  });
  source.disabled = clause.source === null;
  const classes = ["row", ...(chosen ? ["chosen"] : []), ...(clause.stale === true ? ["stale"] : [])];
  return element("div", { class: classes.join(" ") }, label, source);
}

/** A behaviour has a generated name: show its sentence instead. */
function shown(name: string, sentence: string): HTMLElement {
  return element("span", { class: "text" }, /\.(?:given|when|then)\b/.test(name) ? sentence : name);
}

function caption(clause: Clause | undefined): HTMLElement {
  if (clause === undefined) {
    return element("div", { class: "caption" });
  }
  const details = [marginWords(clause), clause.reason, clause.vacuous, clause.stale === true ? EDITED : ""].filter((text) => text !== "");
  const list = details.map((text) => element("p", {}, text));
  return element("div", { class: "caption" }, element("p", { class: "sentence" }, clause.sentence), ...list);
}

/** "violated by −36.1 mm at 6.94 s" */
export function marginWords({ verdict, robustness, unit, at }: Clause): string {
  const by = robustness === null || unit === "" ? "" : ` by ${signed(robustness, unit)}`;
  return `${verdict}${by}${at === null ? "" : ` at ${at.toFixed(2)} s`}`;
}

/** Call `move` with the position of the pointer along an element while pressed or dragged. */
function dragged(target: SVGElement, move: (x: number) => void): void {
  const follow = (event: PointerEvent) => {
    if (target.hasPointerCapture(event.pointerId)) {
      move(event.clientX - target.getBoundingClientRect().left);
    }
  };
  target.addEventListener("pointerdown", (event) => {
    target.setPointerCapture(event.pointerId);
    follow(event);
  });
  target.addEventListener("pointermove", follow);
}
