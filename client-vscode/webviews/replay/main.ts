// The replay page: the scene, the controls, the timeline; all show the same time.
import "./replay.css";
import { type Trace, ageOf, firstClause } from "../../src/panels/replay/answer";
import type { FromReplay, Recording, ReplayState, ToReplay } from "../../src/panels/replay/messages";
import { button, element } from "../shared/elements";
import { connect } from "../shared/host";
import { Clock, SPEEDS } from "./clock";
import { Stage } from "./stage";
import { type Timeline, timeline } from "./timeline";

const STEP = 0.05;
const LEAP = 0.5;

const host = connect<FromReplay, ReplayState>((message) => {
  receive(message as ToReplay);
});
const status = element("div", { role: "status" });
const title = element("span", { class: "title" });
const readout = element("output", { class: "readout" });
const place = element("div", { class: "place" });
const clock = new Clock(0, update);
const play = button("▶", "Play or pause (Space)", () => {
  clock.toggle();
});
const violation = button("To the violation", "Jump to the violation of the selected clause, else of the first one (V)", toViolation);
const home = button("⌂", "Show the whole scene (H)", () => stage?.look());
const names = button("Aa", "Show or hide the names in the scene (N)", toggleNames);
const slider = element("input", { type: "range", min: 0, step: 0.01, "aria-label": "Time", class: "slider" });
const speed = element("select", { title: "Speed", "aria-label": "Speed" });

let stage: Stage | undefined;
let line: Timeline | undefined;
let trace: Trace | undefined;
let recording: Recording | undefined;
let chosen = -1;
let named = true;
/** Time of the last drawn frame during playback, ms. */
let last: number | undefined;

speed.append(...SPEEDS.map((factor) => element("option", { value: factor }, `${factor} ×`)));
speed.value = "1";
speed.addEventListener("change", () => {
  clock.speed = Number(speed.value);
});
slider.addEventListener("input", () => {
  clock.pause();
  clock.seek(Number(slider.value));
});
names.setAttribute("aria-pressed", "true");
document.body.append(
  element("header", { role: "toolbar", "aria-label": "Replay" }, play, speed, violation, readout, slider, home, names),
  element("div", { class: "heading" }, title),
  status,
  place,
);
new ResizeObserver(() => {
  line?.draw(chosen);
  line?.mark(clock.time);
}).observe(document.body);

function receive(message: ToReplay): void {
  if (message.type === "age") {
    tell(message.text);
  } else if (message.type === "clause") {
    choose(firstClause(trace?.clauses ?? [], message.clause));
    toViolation();
  } else {
    begin(message.trace, message.recording, message.clause, message.time);
  }
}

function tell(problem: string): void {
  status.textContent = problem;
  status.classList.toggle("problem", problem !== "");
}

/** Show a trace: in the page's kept state, else at the most relevant clause. */
function begin(shown: Trace, of: Recording, clause: string | undefined, time: number | undefined): void {
  const kept = host.kept;
  stage?.dispose();
  trace = shown;
  recording = of;
  clock.duration = shown.duration;
  slider.max = String(shown.duration);
  title.textContent = [shown.scenario.name.replace(/^[^:]*:/, ""), shown.scenario.values].filter(Boolean).join(" · ");
  title.title = title.textContent;
  tell(ageOf(shown.clauses));
  line = timeline(shown, { seek: scrub, choose, open });
  place.replaceChildren(scene(shown), line.root);
  if (kept?.clause !== undefined && kept.time !== undefined && clause === undefined) {
    choose(kept.clause);
    clock.seek(time ?? kept.time);
    if (kept.camera !== undefined && stage !== undefined) {
      stage.view = kept.camera;
    }
    return;
  }
  choose(firstClause(shown.clauses, clause));
  clock.seek(time ?? violated() ?? 0);
}

/** The scene, or a message why there is none. */
function scene(shown: Trace): HTMLElement {
  try {
    stage = new Stage(shown, keep);
    stage.named = named;
    return stage.root;
  } catch (error) {
    console.warn(error);
    home.disabled = names.disabled = true;
    const reason = "This window cannot draw in 3D (WebGL is missing or disabled). The timeline works.";
    return element("p", { class: "nothing" }, reason);
  }
}

function update(): void {
  stage?.show(clock.time);
  line?.mark(clock.time);
  slider.value = String(clock.time);
  readout.textContent = `${clock.time.toFixed(2)} / ${clock.duration.toFixed(2)} s`;
  play.textContent = clock.playing ? "⏸" : "▶";
  if (clock.playing) {
    requestAnimationFrame(tick);
  } else {
    last = undefined;
    keep();
  }
}

/** The clock advances once for each animation frame, however often one was requested. */
function tick(now: number): void {
  if (now !== last) {
    const elapsed = last === undefined ? 0 : (now - last) / 1000;
    last = now;
    clock.advance(elapsed);
  }
}

function scrub(time: number): void {
  clock.pause();
  clock.seek(time);
}

function choose(clause: number): void {
  chosen = clause;
  line?.draw(chosen);
  line?.mark(clock.time);
  violation.disabled = violated() === undefined;
  keep();
}

function open(clause: number): void {
  host.post({ type: "open", clause });
}

/** The instant of the violation of the selected clause, else of the first violated one, s. */
function violated(): number | undefined {
  const clauses = trace?.clauses ?? [];
  const found = [clauses[chosen], ...clauses].find((clause) => clause?.verdict === "violated" && clause.at !== null);
  return found?.at ?? undefined;
}

function toViolation(): void {
  const time = violated();
  if (time !== undefined) {
    scrub(time);
  }
}

function toggleNames(): void {
  named = !named;
  names.setAttribute("aria-pressed", String(named));
  if (stage !== undefined) {
    stage.named = named;
  }
}

function keep(): void {
  if (recording !== undefined) {
    const camera = stage === undefined ? {} : { camera: stage.view };
    host.keep({ recording, time: clock.time, clause: chosen, ...camera });
  }
}

const KEYS: Readonly<Record<string, (event: KeyboardEvent) => void>> = {
  " ": () => {
    clock.toggle();
  },
  ArrowLeft: ({ shiftKey }) => {
    scrub(clock.time - (shiftKey ? LEAP : STEP));
  },
  ArrowRight: ({ shiftKey }) => {
    scrub(clock.time + (shiftKey ? LEAP : STEP));
  },
  Home: () => {
    scrub(0);
  },
  End: () => {
    scrub(clock.duration);
  },
  v: toViolation,
  h: () => stage?.look(),
  n: toggleNames,
};

document.addEventListener("keydown", (event) => {
  const own = event.target instanceof HTMLSelectElement;
  const pressed = event.target instanceof HTMLButtonElement && event.key === " ";
  const action = own || pressed || event.ctrlKey || event.metaKey || event.altKey ? undefined : KEYS[event.key];
  if (action !== undefined) {
    action(event);
    event.preventDefault();
  }
});
