// Report where the pictures of a run are: they are rendered after its end.
import { dirname } from "node:path";
import * as vscode from "vscode";
import { inform } from "../notices";
import { outcomeOf, picturesOf, recordedIn } from "../testing/answers";
import { isRecord } from "../values";

/** Whether a command of the server renders pictures of violations. */
export function makesPictures(command: string, argument: unknown): boolean {
  return command === "robbdd.record" || (isRecord(argument) && argument["record"] === true);
}

/** The last output of a run with pictures: paths, which the editor turns into links. */
export function recordingWords(answer: unknown): string[] {
  const path = (uri: string) => vscode.Uri.parse(uri).fsPath;
  const folder = recordedIn(answer);
  const pictures = picturesOf(answer).map((picture) => `    picture of a violation: ${path(picture)}`);
  // With violations and without pictures, the server has reported why they could not be rendered.
  const nothing = outcomeOf(answer)?.violated === 0 ? ". There was no violation to render." : "";
  return folder === undefined ? pictures : [`● Recording, can be replayed: ${path(folder)}${nothing}`, ...pictures];
}

/** Tell the user of a run that was not started in the Testing view, whose output nobody may look at. */
export function tellPictures(answer: unknown): void {
  const [first, ...others] = picturesOf(answer);
  if (first !== undefined) {
    const count = others.length + 1;
    const folder = dirname(vscode.Uri.parse(first).fsPath);
    inform(`RobBDD: ${count} picture${count === 1 ? "" : "s"} of violations in ${folder}`, {
      "Show First Picture": () => void vscode.commands.executeCommand("vscode.open", vscode.Uri.parse(first)),
    });
  } else if (outcomeOf(answer)?.violated === 0) {
    inform("RobBDD: No scenario was violated, so there is no picture.");
  }
}
