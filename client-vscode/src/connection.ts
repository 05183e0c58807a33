// The connection to a running server. Its library is large: this module is loaded when the first server is started.
import { createInterface } from "node:readline";
import type { Readable } from "node:stream";
import * as vscode from "vscode";
import { CloseAction, ErrorAction, LanguageClient, State, TransportKind } from "vscode-languageclient/node";
import { type Launch, serverVariables } from "./launch";
import { isRunProgress } from "./presentation";
import { RestartBudget } from "./restarts";
import { VerdictPainter } from "./verdicts/painter";

/** Receives the events of a connection and the requests of the server's commands. */
export interface Owner {
  starting(): void;
  /** The server answers; `version` is its version if it states one. */
  running(version: string | undefined): void;
  /** The server ended by itself, whether or not it will be restarted. */
  ended(): void;
  /** The server ended by itself and will not be restarted. */
  gaveUp(): void;
  runMessage(notification: unknown): void;
  execute(command: string, argument: unknown): Promise<unknown>;
}

/**
 * Logs its errors without showing them: two messages for one failure are too many. The library's stack trace is
 * omitted: it would push the server's last output out of sight.
 */
class DiscreetClient extends LanguageClient {
  override error(message: string, data?: unknown): void {
    super.error(message, data instanceof Error ? data.message : data, false);
  }
}

/** Create an unstarted client of the server that a command starts in the folder `cwd`, for files of these languages. */
export function createClient(
  command: string,
  { args, env }: Launch,
  cwd: string,
  languages: readonly string[],
  log: vscode.LogOutputChannel,
  owner: Owner,
): LanguageClient {
  const budget = new RestartBudget();
  let answered = false;
  /** Exists only while the server runs, as its data goes with it. */
  let verdicts: VerdictPainter | undefined;
  const client: LanguageClient = new DiscreetClient(
    "robbdd",
    "RobBDD",
    { command, args: [...args], transport: TransportKind.stdio, options: { cwd, env: serverVariables(process.env, env) } },
    {
      documentSelector: languages.map((language) => ({ scheme: "file", language })),
      outputChannel: log,
      initializationOptions: { pictures: true, replay: true, history: true, studies: true, debugging: true, trusted: vscode.workspace.isTrusted },
      markdown: { isTrusted: { enabledCommands: ["robbdd.showReplay", "robbdd.showHistory"] } },
      initializationFailedHandler: () => false,
      errorHandler: {
        // A broken pipe is followed by the close of the connection, which is handled there.
        error: () => ({ action: ErrorAction.Continue, handled: true }),
        closed: () => {
          owner.ended();
          // A server that never answered will fail again.
          const again = answered && budget.crashed(Date.now());
          if (!again) {
            owner.gaveUp();
          }
          return { action: again ? CloseAction.Restart : CloseAction.DoNotRestart, handled: true };
        },
      },
      middleware: {
        provideInlayHints: (document, part, token, next) => {
          const hints = next(document, part, token);
          const ask = () => client.sendRequest("robbdd/verdicts", { uri: document.uri.toString() }, token);
          return verdicts === undefined ? hints : verdicts.takeHints(document, hints, ask);
        },
        provideCodeLenses: (document, token, next) => {
          const ask = () => next(document, token);
          return verdicts === undefined ? ask() : verdicts.takeLenses(document, ask);
        },
        // The status item shows the progress of runs.
        handleWorkDoneProgress: (token, params, next) => {
          if (!isRunProgress(token)) {
            next(token, params);
          }
        },
        executeCommand: (name, [argument]: unknown[]) => owner.execute(name, argument),
      },
      // Python's logging writes everything to stderr; a line there is not necessarily an error.
      stdioOptions: { stdout: forwardLines, stderr: forwardLines },
    },
  );
  client.onNotification("robbdd/runMessage", (notification: unknown) => {
    owner.runMessage(notification);
  });
  client.onDidChangeState(({ newState }) => {
    verdicts?.dispose();
    verdicts = newState === State.Running ? new VerdictPainter() : undefined;
    if (newState === State.Starting) {
      owner.starting();
    } else if (newState === State.Running) {
      answered = true;
      owner.running(client.initializeResult?.serverInfo?.version);
    }
  });
  return client;
}

function forwardLines(input: Readable, channel: vscode.LogOutputChannel): void {
  createInterface({ input }).on("line", (line) => {
    channel.info(line);
  });
}
