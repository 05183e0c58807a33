// The page of a scene: its elements in 3D, and under them its faults and notes.
import "./scene.css";
import { type DrawnScene, notes, still } from "../../src/panels/scene/answer";
import type { FromScene, SceneState, ToScene } from "../../src/panels/scene/messages";
import { Stage } from "../stage/stage";
import { button, element, iconButton } from "../shared/elements";
import { connect } from "../shared/host";
import { toolbar } from "../shared/toolbar";

const host = connect<FromScene, SceneState>((message) => {
  receive(message as ToScene);
});
const choice = element("select", { title: "Scene instance", "aria-label": "Scene instance" });
const home = iconButton("home", "Show the whole scene", () => stage?.look());
const names = iconButton("names", "Show or hide the names in the scene", toggleNames);
const status = element("div", { role: "status" });
const place = element("div", { class: "place" });
const faults = element("ul", { class: "faults", "aria-label": "Faults and notes" });

let stage: Stage | undefined;
let last: ToScene | undefined;
let named = true;
/** The IRI of the scene that is shown, and its camera once it was moved. */
let shown = "";
let camera: readonly number[] | undefined;

names.setAttribute("aria-pressed", "true");
choice.addEventListener("change", () => {
  camera = undefined;
  draw();
});
document.body.append(
  element("header", {}, toolbar("Scene", choice, element("span", { class: "space" }), home, names)),
  status,
  place,
  faults,
);

function receive(message: ToScene): void {
  const kept = host.kept;
  if (last === undefined && kept?.uri === message.uri) {
    shown = kept.scene ?? "";
    camera = kept.camera;
  }
  const isSame = last !== undefined && JSON.stringify(last.scenes) === JSON.stringify(message.scenes);
  last = message;
  status.textContent = message.remark;
  status.classList.toggle("problem", message.remark !== "");
  choice.replaceChildren(...message.scenes.map(({ iri, name }) => element("option", { value: iri }, name)));
  choice.value = message.scenes.some(({ iri }) => iri === shown) ? shown : (message.scenes[0]?.iri ?? "");
  choice.hidden = message.scenes.length < 2;
  if (!isSame) {
    draw();
  }
}

function draw(): void {
  const number = last?.scenes.findIndex(({ iri }) => iri === choice.value) ?? -1;
  const scene = last?.scenes[number];
  stage?.dispose();
  stage = undefined;
  home.disabled = names.disabled = scene === undefined;
  place.replaceChildren(...(scene === undefined ? [] : [stageOf(scene)]));
  faults.replaceChildren(...(scene === undefined ? [] : remarks(scene, number)));
}

function stageOf(scene: DrawnScene): HTMLElement {
  shown = scene.iri;
  try {
    stage = new Stage(still(scene), keep);
  } catch (error) {
    console.warn(error);
    home.disabled = names.disabled = true;
    return element("p", { class: "nothing" }, "This window cannot draw in 3D (WebGL is missing or disabled).");
  }
  stage.root.setAttribute("aria-label", `Scene ${scene.name}: ${scene.bodies.map(({ name }) => name).join(", ")}`);
  stage.named = named;
  if (camera !== undefined) {
    stage.view = camera;
  }
  keep();
  return stage.root;
}

function remarks(scene: DrawnScene, number: number): HTMLElement[] {
  const found = scene.faults.map(({ reason, source }, fault) => {
    const text = button(`⚠ ${reason}`, `${reason} (show the text)`, () => {
      host.post({ type: "open", scene: number, fault });
    });
    text.disabled = source === null;
    return element("li", { class: "problem" }, text);
  });
  return [...found, ...notes(scene).map((note) => element("li", {}, note))];
}

function keep(): void {
  // The stage calls this before its constructor has ended.
  if (stage !== undefined && last !== undefined) {
    camera = stage.view;
    host.keep({ uri: last.uri, scene: shown, camera });
  }
}

function toggleNames(): void {
  named = !named;
  names.setAttribute("aria-pressed", String(named));
  if (stage !== undefined) {
    stage.named = named;
  }
}
