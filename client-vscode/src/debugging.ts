// Debugging: sessions of our own adapter, which pauses simulations at clauses, and of the debugger of Python code, whose
// process answers the Debug Adapter Protocol by itself.
import * as vscode from "vscode";
import type { Server } from "./client";
import { RUNNABLE, modelFor } from "./models";
import { complain } from "./notices";
import type { RunMonitor } from "./runs/monitor";
import { isRecord } from "./values";

export const TYPE = "robbdd";
const HOST = "127.0.0.1";
/** The adapter's event at the end of a run that it has stored. */
const STORED = "robbdd/stored";
/** `FileChangeType.Created` of the protocol. */
const CREATED = 1;
/** A name in a model, or a path of names. */
const NAME = /[\w-]+(\.[\w-]+)*/;

export class Debugging implements vscode.Disposable {
  private readonly parts: readonly vscode.Disposable[];

  constructor(
    private readonly server: Server,
    runs: RunMonitor,
  ) {
    this.parts = [
      vscode.debug.registerDebugConfigurationProvider(TYPE, {
        resolveDebugConfiguration: (_, configuration) => resolved(configuration),
      }),
      vscode.debug.registerDebugAdapterDescriptorFactory(TYPE, {
        createDebugAdapterDescriptor: ({ configuration }) => this.adapter(configuration),
      }),
      vscode.languages.registerEvaluatableExpressionProvider(RUNNABLE, {
        provideEvaluatableExpression: (document, position) => {
          const range = document.getWordRangeAtPosition(position, NAME);
          return range && new vscode.EvaluatableExpression(range);
        },
      }),
      // Whether or not the editor watches the files of the folder.
      vscode.debug.onDidReceiveDebugSessionCustomEvent(({ event, body, session }) => {
        if (event === STORED && session.type === TYPE && isRecord(body) && typeof body["results"] === "string") {
          this.server.notify("workspace/didChangeWatchedFiles", { changes: [{ uri: body["results"], type: CREATED }] });
        }
      }),
      runs.onMessage(({ uri, message }) => {
        if (message.type === "DebuggerAwaited") {
          void this.attach(uri, message.port);
        }
      }),
    ];
  }

  dispose(): void {
    for (const part of this.parts) {
      part.dispose();
    }
  }

  private async adapter({ request, port }: vscode.DebugConfiguration): Promise<vscode.DebugAdapterDescriptor | undefined> {
    if (request !== "launch") {
      return typeof port === "number" ? new vscode.DebugAdapterServer(port, HOST) : undefined;
    }
    const line = await this.server.commandLine();
    return line && new vscode.DebugAdapterExecutable(line.command, ["dap"], { env: line.env });
  }

  private async attach(uri: string, port: number): Promise<void> {
    const folder = vscode.workspace.getWorkspaceFolder(vscode.Uri.parse(uri));
    const configuration = { type: TYPE, request: "attach", name: "RobBDD", port, justMyCode: true };
    if (!(await vscode.debug.startDebugging(folder, configuration))) {
      complain("The debugger could not be started: the run is cancelled.");
      void this.server.execute("robbdd.cancel", {});
    }
  }
}

/** Complete a configuration: without launch.json, debug the model in the editor. Undefined: do not debug. */
async function resolved(configuration: Partial<vscode.DebugConfiguration>): Promise<vscode.DebugConfiguration | undefined> {
  const known: vscode.DebugConfiguration = { type: TYPE, request: "launch", name: "RobBDD", ...configuration };
  if (known.request !== "launch") {
    return known;
  }
  if (!vscode.workspace.isTrusted) {
    complain("Trust the workspace to debug its models: a simulation can execute code.", {
      "Manage Workspace Trust": () => void vscode.commands.executeCommand("workbench.trust.manage"),
    });
    return undefined;
  }
  const program: unknown = known["program"] ?? (await modelFor(undefined, RUNNABLE))?.fsPath;
  return program === undefined ? undefined : { ...known, program };
}
