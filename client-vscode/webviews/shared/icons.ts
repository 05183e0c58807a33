// Icons of VS Code in pages: drawings, since a page has no icon font. A name that VS Code lacks fails the build.
import arrowDown from "@vscode/codicons/src/icons/arrow-down.svg";
import arrowUp from "@vscode/codicons/src/icons/arrow-up.svg";
import camera from "@vscode/codicons/src/icons/device-camera.svg";
import frames from "@vscode/codicons/src/icons/move.svg";
import forces from "@vscode/codicons/src/icons/magnet.svg";
import home from "@vscode/codicons/src/icons/home.svg";
import larger from "@vscode/codicons/src/icons/zoom-in.svg";
import link from "@vscode/codicons/src/icons/link.svg";
import names from "@vscode/codicons/src/icons/tag.svg";
import pause from "@vscode/codicons/src/icons/debug-pause.svg";
import play from "@vscode/codicons/src/icons/play.svg";
import smaller from "@vscode/codicons/src/icons/zoom-out.svg";
import source from "@vscode/codicons/src/icons/go-to-file.svg";
import whole from "@vscode/codicons/src/icons/screen-full.svg";

const ICONS = { arrowDown, arrowUp, camera, forces, frames, home, larger, link, names, pause, play, smaller, source, whole } as const;

export type Icon = keyof typeof ICONS;

/** An icon in the colour of the text around it; the button that has it needs a name. */
export function icon(name: Icon): Element {
  const drawing = new DOMParser().parseFromString(ICONS[name], "image/svg+xml").documentElement;
  const made = document.importNode(drawing, true);
  made.setAttribute("class", "icon");
  made.setAttribute("data-icon", name);
  made.setAttribute("aria-hidden", "true");
  return made;
}
