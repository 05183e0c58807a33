// Create elements of a page.
import { type Icon, icon } from "./icons";

type Attributes = Readonly<Record<string, string | number>>;

/** Create an element with attributes and children. */
export function element<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...content: readonly (Node | string)[]
): HTMLElementTagNameMap[Name] {
  const made = document.createElement(name);
  fill(made, attributes, content);
  return made;
}

/** Create an SVG element. */
export function drawn<Name extends keyof SVGElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...content: readonly (Node | string)[]
): SVGElementTagNameMap[Name] {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  fill(made, attributes, content);
  return made;
}

/** Create a button; its title names its keyboard shortcut, if any. Who speaks to the computer says what is written on it. */
export function button(label: string, title: string, press: () => void): HTMLButtonElement {
  const name = title.toLowerCase().includes(label.toLowerCase()) ? title : `${label}: ${title}`;
  const made = element("button", { type: "button", title, "aria-label": name }, label);
  made.addEventListener("click", press);
  return made;
}

/** Create a button with an icon, whose title is its name. */
export function iconButton(name: Icon, title: string, press: () => void): HTMLButtonElement {
  const made = button("", title, press);
  made.append(icon(name));
  return made;
}

/** Create a region whose changes a screen reader says, without being seen. */
export function announcer(): { readonly root: HTMLElement; readonly say: (words: string) => void } {
  const root = element("div", { class: "spoken", "aria-live": "polite" });
  return {
    root,
    say: (words) => {
      root.textContent = words;
    },
  };
}

function fill(made: Element, attributes: Attributes, content: readonly (Node | string)[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    made.setAttribute(name, String(value));
  }
  made.append(...content);
}
