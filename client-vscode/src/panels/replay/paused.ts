// The scene of a paused simulation in 3D. It follows each pause of the debugged execution.
import * as vscode from "vscode";
import { TYPE } from "../../debugging";
import { complain, inform } from "../../notices";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { type Trace, isTrace, local } from "./answer";
import type { ToReplay } from "./messages";

const VIEW = "robbdd.pausedScene";
const SCENE = "robbdd/scene";

export class PausedScene implements vscode.Disposable {
  private panel: Panel<ToReplay> | undefined;
  private trace: Trace | undefined;
  private readonly tracker: vscode.Disposable;

  constructor(private readonly extension: vscode.Uri) {
    this.tracker = vscode.debug.registerDebugAdapterTrackerFactory(TYPE, {
      createDebugAdapterTracker: (session) => ({
        onDidSendMessage: (message: unknown) => {
          if (this.panel !== undefined && isRecord(message) && message["event"] === "stopped" && isOurs(session)) {
            void this.follow(session);
          }
        },
      }),
    });
  }

  /** Show the scene of the session that the user debugs. */
  async open(): Promise<void> {
    const session = vscode.debug.activeDebugSession;
    if (session === undefined || !isOurs(session)) {
      inform("No simulation is paused: debug a scenario, with a breakpoint on one of its clauses.");
      return;
    }
    await this.follow(session);
  }

  dispose(): void {
    this.tracker.dispose();
    this.panel?.dispose();
  }

  private async follow(session: vscode.DebugSession): Promise<void> {
    let answer: unknown;
    try {
      answer = await session.customRequest(SCENE);
    } catch (error) {
      complain(`RobBDD: ${error instanceof Error ? error.message : String(error)}`);
      return;
    }
    if (isTrace(answer)) {
      this.trace = answer;
      this.panel ??= this.create(titleOf(answer));
      // The next session may debug another scenario.
      this.panel.view.title = titleOf(answer);
      this.send();
    }
  }

  private create(title: string): Panel<ToReplay> {
    const view = beside(VIEW, title);
    view.onDidDispose(() => {
      this.panel = undefined;
    });
    return new Panel<ToReplay>(view, this.extension, "replay", () => {
      this.send();
    }, () => undefined);
  }

  private send(): void {
    if (this.trace !== undefined) {
      const { folder, duration: time, paused_at: clause } = this.trace;
      const selected = clause === undefined || clause === null ? {} : { clause };
      this.panel?.post({ type: "trace", recording: { uri: folder }, trace: this.trace, time, ...selected });
    }
  }
}

function titleOf({ scenario }: Trace): string {
  return `Paused ${local(scenario.name)}`;
}

/** Whether a session debugs clauses, not Python code. */
function isOurs({ type, configuration }: vscode.DebugSession): boolean {
  return type === TYPE && configuration.request === "launch";
}
