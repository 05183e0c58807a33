// The editor's side of the test tree: its items, its runs, its addresses and places.
import * as vscode from "vscode";
import { withoutControls } from "../literal";
import type { RunMessage, RunNotification } from "../runs/messages";
import type { Sink } from "./follower";
import type { Factory } from "./items";
import type { Place } from "./listing";

export function factory(controller: vscode.TestController): Factory<vscode.TestItem> {
  return {
    create: (id, label, uri) => controller.createTestItem(id, label, vscode.Uri.parse(uri)),
    setPlace: (item, place) => {
      const here = place !== null && item.uri?.toString() === vscode.Uri.parse(place.uri).toString();
      item.range = here ? rangeOf(place) : undefined;
    },
    setProblem: (item, problem) => {
      item.error = problem;
    },
  };
}

/** The display of one run of the server; the editor's run may contain several. */
export function sinkOf(run: vscode.TestRun, onEnd: () => void = () => undefined): Sink<vscode.TestItem> {
  let ended = false;
  const open = (show: () => void) => {
    if (!ended) {
      show();
    }
  };
  return {
    started: (item) => {
      open(() => {
        run.started(item);
      });
    },
    passed: (item, duration) => {
      open(() => {
        run.passed(item, duration);
      });
    },
    failed: (item, { text }, place, duration) => {
      open(() => {
        // A comparison of values would be shown next to the clause instead of the reason.
        run.failed(item, located(new vscode.TestMessage(text), place), duration);
      });
    },
    errored: (item, { text }, place, duration) => {
      open(() => {
        run.errored(item, located(new vscode.TestMessage(text), place), duration);
      });
    },
    skipped: (item) => {
      open(() => {
        run.skipped(item);
      });
    },
    output: (line, item) => {
      open(() => {
        run.appendOutput(`${withoutControls(line)}\r\n`, undefined, item);
      });
    },
    end: () => {
      open(onEnd);
      ended = true;
    },
  };
}

/** An address as written by the editor: the server may escape other characters. */
export function normal(uri: string): string {
  return vscode.Uri.parse(uri).toString();
}

export function normalised(notification: RunNotification): RunNotification {
  const { message } = notification;
  const source = "source" in message ? message.source : undefined;
  return source
    ? { ...notification, message: { ...message, source: { ...source, uri: normal(source.uri) } } as RunMessage }
    : notification;
}

/** The display name of a file's address. */
export function titleOf(uri: string): string {
  return vscode.workspace.asRelativePath(vscode.Uri.parse(uri));
}

function located(message: vscode.TestMessage, place: Place | null): vscode.TestMessage {
  if (place !== null) {
    message.location = new vscode.Location(vscode.Uri.parse(place.uri), rangeOf(place));
  }
  return message;
}

function rangeOf({ range: { start, end } }: Place): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}
