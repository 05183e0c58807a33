// The replay page: the scene, the controls, the timeline; all show the same time.
import "./replay.css";
import { type Trace, ageOf, firstClause, titleOf } from "../../src/panels/replay/answer";
import type { FromReplay, Recording, ReplayState, ToReplay } from "../../src/panels/replay/messages";
import { announcer, element } from "../shared/elements";
import { connect } from "../shared/host";
import { Stage } from "../stage/stage";
import { Clock } from "./clock";
import { Controls, type Toggle } from "./controls";
import { type Followed, followable } from "./followed";
import { Motion } from "./motion";
import { captioned, copied, encoded } from "./picture";
import { Pressed } from "./pressed";
import { type Timeline, marginWords, timeline } from "./timeline";

const STEP = 0.05;
const LEAP = 0.5;
/** ms */
const BRIEFLY = 4000;
const NO_FORCES = "This execution has no recorded contact forces.";

/** What is shown of a trace. */
interface Shown {
  readonly trace: Trace;
  readonly recording: Recording;
  readonly motion: Motion;
  readonly forces: Pressed;
  readonly line: Timeline;
  readonly bodies: readonly Followed[];
}

const host = connect<FromReplay, ReplayState>((message) => {
  receive(message as ToReplay);
});
const status = element("div", { role: "status" });
const title = element("span", { class: "title" });
const said = element("span", { class: "said" });
const place = element("main", { class: "place" });
const spoken = announcer();
const clock = new Clock(0, update);
const controls = new Controls({
  play: () => {
    clock.toggle();
  },
  speed: (factor) => {
    clock.speed = factor;
  },
  seek: scrub,
  violation: toViolation,
  home: look,
  toggle,
  follow,
  picture: () => void takePicture(),
  link: () => {
    host.post({ type: "link", time: clock.time, clause: chosen });
  },
});

let shown: Shown | undefined;
let stage: Stage | undefined;
let chosen = -1;
let followed: number | undefined;
const visible: Record<Toggle, boolean> = { named: host.kept?.named ?? true, framed: host.kept?.framed ?? false, pressed: host.kept?.pressed ?? false };
/** Time of the last drawn frame during playback, ms. */
let last: number | undefined;

document.body.append(controls.root, element("div", { class: "heading" }, title, said), status, place, spoken.root);
new ResizeObserver(() => {
  shown?.line.draw(chosen);
  shown?.line.mark(clock.time);
}).observe(document.body);

function receive(message: ToReplay): void {
  switch (message.type) {
    case "age":
      tell(message.text);
      break;
    case "clause":
      choose(firstClause(shown?.trace.clauses ?? [], message.clause));
      toViolation();
      break;
    case "time":
      scrub(message.time);
      break;
    case "said":
      tellBriefly(message.words);
      break;
    case "trace":
      begin(message);
  }
}

function tell(problem: string): void {
  status.textContent = problem;
  status.classList.toggle("problem", problem !== "");
}

/** Say something next to the title for some seconds. */
function tellBriefly(words: string): void {
  spoken.say(words);
  said.textContent = words;
  setTimeout(() => {
    said.textContent = "";
  }, BRIEFLY);
}

/** Show a trace: at the requested time, else in the page's kept state, else at the most relevant clause. */
function begin({ trace, recording, clause, time }: ToReplay & { readonly type: "trace" }): void {
  const kept = host.kept;
  clock.duration = trace.duration;
  title.textContent = [titleOf(trace.scenario), trace.scenario.values].filter(Boolean).join(" · ");
  title.title = title.textContent;
  tell(ageOf(trace.clauses));
  const line = timeline(trace, { seek: scrub, choose, open });
  shown = { trace, recording, line, motion: new Motion(trace), forces: new Pressed(trace), bodies: followable(trace) };
  place.replaceChildren(scene(shown), line.root);
  const restored = kept?.clause !== undefined && kept.time !== undefined && clause === undefined;
  choose(restored ? (kept.clause ?? -1) : typeof clause === "number" ? clause : firstClause(trace.clauses, clause));
  clock.seek(time ?? (restored ? kept.time : violated()) ?? 0);
  if (stage !== undefined && restored && kept.camera !== undefined) {
    stage.view = kept.camera;
  }
  controls.offer(shown.bodies, kept?.follow);
  follow(shown.bodies.find(({ words }) => words === kept?.follow)?.body, restored);
}

/** The scene, or a message why there is none. */
function scene({ trace, forces }: Shown): HTMLElement {
  stage?.dispose();
  try {
    stage = new Stage(trace, keep);
    stage.named = visible.named;
    stage.framed = visible.framed;
    controls.mark("named", visible.named);
    controls.mark("framed", visible.framed);
    controls.mark("pressed", visible.pressed && forces.any, forces.any ? undefined : NO_FORCES);
    return stage.root;
  } catch (error) {
    console.warn(error);
    controls.withoutScene();
    const reason = "This window cannot draw in 3D (WebGL is missing or disabled). The timeline works.";
    return element("p", { class: "nothing" }, reason);
  }
}

function update(): void {
  if (shown !== undefined && stage !== undefined) {
    shown.motion.at(clock.time, (body, pose) => stage?.place(body, pose));
    stage.press(visible.pressed ? shown.forces.at(clock.time) : []);
  }
  shown?.line.mark(clock.time);
  controls.show(clock);
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
  shown?.line.draw(chosen);
  shown?.line.mark(clock.time);
  controls.violated = violated() !== undefined;
  keep();
}

function open(clause: number): void {
  host.post({ type: "open", clause });
}

/** The instant of the violation of the selected clause, else of the first violated one, s. */
function violated(): number | undefined {
  const clauses = shown?.trace.clauses ?? [];
  const found = [clauses[chosen], ...clauses].find((clause) => clause?.verdict === "violated" && clause.at !== null);
  return found?.at ?? undefined;
}

function toViolation(): void {
  const time = violated();
  if (time !== undefined) {
    scrub(time);
    spoken.say(`${time.toFixed(2)} seconds`);
  }
}

/** Show the whole scene; nothing is followed then. */
function look(): void {
  follow(undefined);
  stage?.look();
}

/** Follow a body; `inPlace` leaves the camera where it is. */
function follow(body: number | undefined, inPlace = false): void {
  followed = body;
  const view = stage?.view;
  stage?.follow(body);
  if (inPlace && stage !== undefined && view !== undefined) {
    stage.view = view;
  }
  controls.follow(body);
  keep();
}

/** Follow the first tool, or nothing if something is followed. */
function followTool(): void {
  follow(followed === undefined ? shown?.bodies[0]?.body : undefined);
}

function toggle(what: Toggle): void {
  if (stage === undefined || (what === "pressed" && shown?.forces.any !== true)) {
    return;
  }
  visible[what] = !visible[what];
  controls.mark(what, visible[what]);
  stage.named = visible.named;
  stage.framed = visible.framed;
  update();
}

/** Copy the scene with its title, the time and the selected clause; let the user save it where that is not possible. */
async function takePicture(): Promise<void> {
  if (stage === undefined || shown === undefined) {
    return;
  }
  const clause = shown.trace.clauses[chosen];
  const moment = `${title.textContent} · ${clock.time.toFixed(2)} s of run ${shown.trace.run}`;
  const words = [moment, ...(clause === undefined ? [] : [`${clause.sentence}: ${marginWords(clause)}`])];
  const picture = captioned(stage.picture(), words, window.devicePixelRatio);
  if (await copied(picture)) {
    tellBriefly("Picture copied.");
  } else {
    host.post({ type: "picture", data: encoded(picture) });
  }
}

function keep(): void {
  if (shown !== undefined) {
    const words = shown.bodies.find(({ body }) => body === followed)?.words;
    const camera = stage === undefined ? {} : { camera: stage.view };
    host.keep({ recording: shown.recording, time: clock.time, clause: chosen, ...visible, ...(words === undefined ? {} : { follow: words }), ...camera });
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
  h: look,
  f: followTool,
  n: () => {
    toggle("named");
  },
  a: () => {
    toggle("framed");
  },
  o: () => {
    toggle("pressed");
  },
  c: () => void takePicture(),
  l: () => {
    host.post({ type: "link", time: clock.time, clause: chosen });
  },
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
