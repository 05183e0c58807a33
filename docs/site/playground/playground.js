// The playground: an editor for the files of an example; next to it their findings, Gherkin and graph, and a recorded execution.
import { autocompletion } from "@codemirror/autocomplete";
import { setDiagnostics } from "@codemirror/lint";
import { EditorState, StateEffect, StateField } from "@codemirror/state";
import { Decoration, EditorView, hoverTooltip } from "@codemirror/view";
import { basicSetup } from "codemirror";

/** Milliseconds after the last key until SHACL, Gherkin and graph are made anew. */
const REST = 400;
const LEVELS = { error: "error", warning: "warning", information: "info", hint: "hint" };

const worker = new Worker("worker.js", { type: "module" });
const waiting = new Map();
let calls = 0;

worker.addEventListener("message", ({ data: { id, answer, error } }) => {
  const { resolve, reject } = waiting.get(id);
  waiting.delete(id);
  if (error === undefined) {
    resolve(answer);
  } else {
    reject(new Error(error));
  }
});

/** Call the language core. */
function ask(method, ...args) {
  calls += 1;
  const id = calls;
  return new Promise((resolve, reject) => {
    waiting.set(id, { resolve, reject });
    worker.postMessage({ id, method, args });
  });
}

const element = (id) => document.getElementById(id);
const texts = new Map();
/** The texts as the example has them. */
const opened = new Map();
let current;
let revision = 0;
let timer;
let found = { fast: [], shapes: [] };

const colour = StateEffect.define();
const colours = StateField.define({
  create: () => Decoration.none,
  update: (marks, change) =>
    change.effects.reduce((before, effect) => (effect.is(colour) ? effect.value : before), marks.map(change.changes)),
  provide: (field) => EditorView.decorations.from(field),
});

const view = new EditorView({ parent: element("editor"), state: stateOf("") });

// Those who scroll by the keyboard can do so without changing the text.
view.scrollDOM.tabIndex = 0;

function stateOf(text) {
  return EditorState.create({
    doc: text,
    extensions: [
      basicSetup,
      colours,
      EditorView.contentAttributes.of({ "aria-label": "Model" }),
      autocompletion({ override: [proposals] }),
      hoverTooltip(description),
      EditorView.updateListener.of((update) => update.docChanged && edited()),
    ],
  });
}

async function proposals(context) {
  const offered = await ask("complete", current, context.pos);
  if (offered.length === 0) {
    return null;
  }
  const [from] = offered[0].range;
  return {
    from,
    filter: true,
    options: offered.map(({ label, detail, text }, place) => ({ label, detail, apply: text, boost: -place })),
  };
}

async function description(_, place) {
  const about = await ask("hover", current, place);
  if (about === null) {
    return null;
  }
  return {
    pos: about.range[0],
    end: about.range[1],
    above: true,
    create: () => {
      const dom = document.createElement("div");
      dom.className = "description";
      dom.textContent = about.markdown.replaceAll(/\*\*|`{1,3}\w*/g, "");
      return { dom };
    },
  };
}

function edited() {
  texts.set(current, view.state.doc.toString());
  check();
}

/** Check the current file after a change: at once what is quick, after a rest everything else. */
async function check() {
  revision += 1;
  const own = revision;
  const length = view.state.doc.length;
  element("state").textContent = "checking…";
  await ask("change", current, texts.get(current));
  const { findings, words } = await ask("check", current);
  if (own !== revision) {
    return;
  }
  const marks = words
    .filter(([start, end]) => start < end && end <= length)
    .map(([start, end, concept]) => Decoration.mark({ class: `word-${concept}` }).range(start, end));
  view.dispatch({ effects: colour.of(Decoration.set(marks, true)) });
  found = { fast: findings, shapes: [] };
  show();
  clearTimeout(timer);
  timer = setTimeout(() => derive(own), REST);
}

/** Validate a model, and make what follows from one without errors. */
async function derive(own) {
  try {
    const shapes = await ask("validate", current);
    if (own !== revision) {
      return;
    }
    if (shapes.length > 0) {
      // Only then: setting diagnostics closes the description that is open over one of them.
      found = { ...found, shapes };
      show();
    }
    if ([...found.fast, ...shapes].some(({ severity }) => severity === "error")) {
      element("state").textContent = "Gherkin and graph are those before the errors";
      return;
    }
    const methods = current.endsWith(".bdd") ? { feature: "gherkin", graph: "graph" } : { graph: "graph" };
    for (const [method, id] of Object.entries(methods)) {
      const text = await ask(method, current);
      if (own !== revision) {
        return;
      }
      element(id).textContent = text;
    }
    if (current.endsWith(".bdd")) {
      const drawing = await ask("picture", current);
      if (own === revision) {
        element("picture").innerHTML = drawing;
      }
    }
  } catch (error) {
    element("state").textContent = error.message.split("\n").at(-2) ?? error.message;
  }
}

function show() {
  const all = [...found.fast, ...found.shapes];
  const diagnostics = all.map(({ range: [from, to], severity, code, message, fixes }) => ({
    from,
    to,
    severity: LEVELS[severity],
    source: code,
    message,
    actions: fixes.map(({ title, edits }) => ({
      name: title,
      apply: (editor) => editor.dispatch({ changes: edits.map(([start, end, insert]) => ({ from: start, to: end, insert })) }),
    })),
  }));
  view.dispatch(setDiagnostics(view.state, diagnostics));
  element("problems").replaceChildren(...all.map(row));
  element("count").textContent = String(all.length);
  element("state").textContent = "ready";
}

function row({ range: [from], severity, code, message }) {
  const button = document.createElement("button");
  button.className = severity;
  button.textContent = `${view.state.doc.lineAt(from).number}: ${message} [${code}]`;
  button.addEventListener("click", () => {
    view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
    view.focus();
  });
  const item = document.createElement("li");
  item.append(button);
  return item;
}

function choose(name) {
  current = name;
  view.setState(stateOf(texts.get(name)));
  for (const tab of element("files").children) {
    tab.setAttribute("aria-selected", String(tab.textContent === name));
  }
  check();
}

async function openExample(name) {
  texts.clear();
  opened.clear();
  for (const [file, text] of Object.entries(await ask("open", name))) {
    texts.set(file, text);
    opened.set(file, text);
  }
  const tabs = [...texts.keys()].map((file) => {
    const tab = document.createElement("button");
    tab.role = "tab";
    tab.textContent = file;
    tab.addEventListener("click", () => choose(file));
    return tab;
  });
  element("files").replaceChildren(...tabs);
  choose(tabs[0].textContent);
  replay();
}

const recorded = await fetch("recordings/index.json").then((answer) => answer.json());
/** The page that replays the current example, made when it is first shown. */
let player;
/** The recorded execution in it. */
let shown;
/** A place that the page of the replay only compares with none: the text may be edited until it is looked up. */
const SOMEWHERE = { uri: "", range: { start: { line: 0, character: 0 }, end: { line: 0, character: 0 } } };

/** Show the recorded execution of the current example, if that view is open. */
function replay() {
  player?.remove();
  player = undefined;
  const example = element("example").value;
  const known = recorded.includes(example);
  element("unrecorded").hidden = known;
  element("unrecorded").textContent = `No execution of ${example} is recorded here; those of ${recorded.join(", ")} are.`;
  if (known && !element("replay").hidden) {
    player = document.createElement("iframe");
    player.title = "Replay";
    player.src = "replay.html";
    element("replay").append(player);
  }
}

/** Answer the page of the replay as the editor does. */
addEventListener("message", async ({ data, source }) => {
  if (player === undefined || source !== player.contentWindow) {
    return;
  }
  const to = player.contentWindow;
  if (data.type === "ready") {
    const trace = await fetch(`recordings/${element("example").value}.json`).then((answer) => answer.json());
    const clauses = trace.clauses.map((clause) => ({ ...clause, source: fileOf(clause.name) === undefined ? null : SOMEWHERE }));
    shown = { ...trace, clauses };
    to.postMessage({ type: "trace", recording: { uri: "" }, trace: shown }, location.origin);
    if ([...texts].some(([file, text]) => text !== opened.get(file))) {
      to.postMessage({ type: "age", text: "The text has been edited since this execution was recorded." }, location.origin);
    }
  } else if (data.type === "open") {
    reveal(shown.clauses[data.clause].name);
  } else if (data.type === "picture") {
    const link = document.createElement("a");
    link.href = `data:image/png;base64,${data.data}`;
    link.download = "replay.png";
    link.click();
  } else if (data.type === "link") {
    to.postMessage({ type: "said", words: "Links to moments work in an editor." }, location.origin);
  }
});

/** The file that has a clause of a recorded execution now. */
function fileOf(name) {
  return [...texts.keys()].find((file) => texts.get(file).includes(`${name}: holds`));
}

/** Select a clause of a recorded execution in the text. */
function reveal(name) {
  const file = fileOf(name);
  if (file !== undefined) {
    choose(file);
    const anchor = texts.get(file).indexOf(`${name}: holds`);
    view.dispatch({ selection: { anchor, head: anchor + name.length }, scrollIntoView: true });
    view.focus();
  }
}

for (const tab of document.querySelectorAll("#views button")) {
  tab.addEventListener("click", () => {
    for (const other of document.querySelectorAll("#views button")) {
      other.setAttribute("aria-selected", String(other === tab));
      element(other.dataset.view).hidden = other !== tab;
    }
    if (tab.dataset.view === "replay" && player === undefined) {
      replay();
    }
  });
}

const examples = await ask("examples");
element("example").append(...examples.map((name) => new Option(name, name, name === "pickplace", name === "pickplace")));
element("example").addEventListener("change", ({ target }) => openExample(target.value));
await openExample("pickplace");
