// The playground: an editor for the files of an example; beside it their findings, their Gherkin and their graph.
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
    found = { ...found, shapes };
    show();
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
  for (const [file, text] of Object.entries(await ask("open", name))) {
    texts.set(file, text);
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
}

for (const tab of document.querySelectorAll("#views button")) {
  tab.addEventListener("click", () => {
    for (const other of document.querySelectorAll("#views button")) {
      other.setAttribute("aria-selected", String(other === tab));
      element(other.dataset.view).hidden = other !== tab;
    }
  });
}

const examples = await ask("examples");
element("example").append(...examples.map((name) => new Option(name, name, name === "pickplace", name === "pickplace")));
element("example").addEventListener("change", ({ target }) => openExample(target.value));
await openExample("pickplace");
