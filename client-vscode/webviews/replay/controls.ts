// The controls of a replay: what they do is decided by the page.
import { button, element, iconButton } from "../shared/elements";
import { icon } from "../shared/icons";
import { toolbar } from "../shared/toolbar";
import { type Clock, SPEEDS } from "./clock";
import type { Followed } from "./followed";

export interface Wishes {
  readonly play: () => void;
  readonly speed: (factor: number) => void;
  readonly seek: (time: number) => void;
  readonly violation: () => void;
  readonly home: () => void;
  readonly toggle: (what: Toggle) => void;
  readonly follow: (body: number | undefined) => void;
  readonly picture: () => void;
  readonly link: () => void;
}

/** What the scene shows on demand. */
export type Toggle = "named" | "framed" | "pressed";

const NOTHING = "";

export class Controls {
  private readonly play: HTMLButtonElement;
  private readonly violation: HTMLButtonElement;
  private readonly slider = element("input", { type: "range", min: 0, step: 0.01, "aria-label": "Time", class: "slider" });
  /** No live region: it changes with every frame. */
  private readonly readout = element("span", { class: "readout" });
  private readonly followed = element("select", { title: "Follow with the camera (F)", "aria-label": "Follow with the camera" });
  private readonly toggles: Readonly<Record<Toggle, HTMLButtonElement>>;
  private readonly ofScene: readonly (HTMLButtonElement | HTMLSelectElement)[];
  readonly root: HTMLElement;

  constructor(wishes: Wishes) {
    this.play = iconButton("play", "Play or pause (Space)", wishes.play);
    const violation = "Jump to the violation of the selected clause, else of the first one (V)";
    this.violation = button("To the violation", violation, wishes.violation);
    const home = iconButton("home", "Show the whole scene (H)", wishes.home);
    const picture = iconButton("camera", "Copy a picture of the moment (C)", wishes.picture);
    const link = iconButton("link", "Copy a link to the moment (L)", wishes.link);
    const toggled = (name: Toggle, drawing: "names" | "frames" | "forces", title: string) => {
      return iconButton(drawing, title, () => {
        wishes.toggle(name);
      });
    };
    this.toggles = {
      named: toggled("named", "names", "Names in the scene (N)"),
      framed: toggled("framed", "frames", "Coordinate frames: x red, y green, z blue (A)"),
      pressed: toggled("pressed", "forces", "Contact forces (O)"),
    };
    this.followed.addEventListener("change", () => {
      wishes.follow(this.followed.value === NOTHING ? undefined : Number(this.followed.value));
    });
    this.slider.addEventListener("input", () => {
      wishes.seek(Number(this.slider.value));
    });
    const scene = element("span", { class: "group" }, home, ...Object.values(this.toggles), this.followed);
    const bar = toolbar("Replay", this.play, speeds(wishes), this.violation, scene, element("span", { class: "group" }, picture, link));
    this.root = element("header", {}, bar, element("div", { class: "time" }, this.readout, this.slider));
    this.ofScene = [home, ...Object.values(this.toggles), this.followed, picture];
  }

  /** Offer what can be followed; `words` is what is followed now. */
  offer(bodies: readonly Followed[], words: string | undefined): void {
    const choices = bodies.map(({ body, words: text }) => element("option", { value: body }, `Follow ${text}`));
    this.followed.replaceChildren(element("option", { value: NOTHING }, "Free camera"), ...choices);
    this.follow(bodies.find((one) => one.words === words)?.body);
  }

  follow(body: number | undefined): void {
    this.followed.value = String(body ?? NOTHING);
  }

  /** Show whether something is shown; a `problem` says why it cannot be. */
  mark(what: Toggle, shown: boolean, problem?: string): void {
    const toggle = this.toggles[what];
    toggle.setAttribute("aria-pressed", String(shown));
    if (problem !== undefined) {
      toggle.disabled = true;
      toggle.title = problem;
    }
  }

  /** There is no scene in this window. */
  withoutScene(): void {
    for (const control of this.ofScene) {
      control.disabled = true;
    }
  }

  set violated(known: boolean) {
    this.violation.disabled = !known;
  }

  show({ time, duration, playing }: Clock): void {
    this.slider.max = String(duration);
    this.slider.value = String(time);
    this.readout.textContent = `${time.toFixed(2)} / ${duration.toFixed(2)} s`;
    if (!playing) {
      // While it plays, a focused slider would be read without an end.
      this.slider.setAttribute("aria-valuetext", `${time.toFixed(2)} of ${duration.toFixed(2)} seconds`);
    }
    const drawing = playing ? "pause" : "play";
    if (this.play.querySelector(`[data-icon="${drawing}"]`) === null) {
      this.play.replaceChildren(icon(drawing));
    }
  }
}

function speeds({ speed }: Wishes): HTMLSelectElement {
  const made = element("select", { title: "Speed", "aria-label": "Speed" }, ...SPEEDS.map((factor) => element("option", { value: factor }, `${factor} ×`)));
  made.value = "1";
  made.addEventListener("change", () => {
    speed(Number(made.value));
  });
  return made;
}
