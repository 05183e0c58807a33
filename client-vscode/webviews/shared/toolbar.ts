// Toolbars: one stop of the Tab key, and arrow keys between their controls.
import { element } from "./elements";
import { nextPlace } from "./roving";

const CONTROLS = "button, select, input";

/** A toolbar with a name. Selects in it are changed by the keys up and down. */
export function toolbar(label: string, ...content: readonly (Node | string)[]): HTMLElement {
  const bar = element("div", { role: "toolbar", "aria-label": label, class: "toolbar" }, ...content);
  const controls = () => [...bar.querySelectorAll<HTMLElement>(CONTROLS)].filter((one) => !one.matches(":disabled"));
  const stop = (at: Element | undefined) => {
    for (const control of bar.querySelectorAll<HTMLElement>(CONTROLS)) {
      control.tabIndex = control === at ? 0 : -1;
    }
  };
  bar.addEventListener("keydown", (event) => {
    const every = controls();
    const next = every[nextPlace(event, every.findIndex((one) => one === document.activeElement), every.length) ?? -1];
    if (next !== undefined) {
      next.focus();
      event.preventDefault();
      event.stopPropagation();
    }
  });
  bar.addEventListener("focusin", ({ target }) => {
    stop(target instanceof Element ? target : undefined);
  });
  // A disabled control cannot be the stop of the Tab key.
  const keepStop = () => {
    const every = controls();
    if (!every.some(({ tabIndex }) => tabIndex === 0)) {
      stop(every[0]);
    }
  };
  new MutationObserver(keepStop).observe(bar, { subtree: true, attributeFilter: ["disabled"] });
  stop(undefined);
  keepStop();
  return bar;
}
