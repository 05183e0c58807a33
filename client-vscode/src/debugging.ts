// Connect the editor's debugger to a run that waits for one. Its process answers the Debug Adapter Protocol by itself.
import * as vscode from "vscode";
import { complain } from "./notices";
import type { RunMonitor } from "./runs/monitor";

const TYPE = "robbdd";
const HOST = "127.0.0.1";

export class Debugging implements vscode.Disposable {
  private readonly parts: readonly vscode.Disposable[];

  /** `cancel` ends the run if no debugger can be connected. */
  constructor(runs: RunMonitor, cancel: () => unknown) {
    this.parts = [
      vscode.debug.registerDebugAdapterDescriptorFactory(TYPE, {
        createDebugAdapterDescriptor: ({ configuration: { port } }) =>
          typeof port === "number" ? new vscode.DebugAdapterServer(port, HOST) : undefined,
      }),
      runs.onMessage(({ uri, message }) => {
        if (message.type === "DebuggerAwaited") {
          void attach(uri, message.port, cancel);
        }
      }),
    ];
  }

  dispose(): void {
    for (const part of this.parts) {
      part.dispose();
    }
  }
}

async function attach(uri: string, port: number, cancel: () => unknown): Promise<void> {
  const folder = vscode.workspace.getWorkspaceFolder(vscode.Uri.parse(uri));
  const configuration = { type: TYPE, request: "attach", name: "RobBDD", port, justMyCode: true };
  if (!(await vscode.debug.startDebugging(folder, configuration))) {
    complain("The debugger could not be started: the run is cancelled.");
    void cancel();
  }
}
