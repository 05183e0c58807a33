// The connection to a running server. Its library is large: this module is loaded when the first server is started.
import { createInterface } from "node:readline";
import type { Readable } from "node:stream";
import * as vscode from "vscode";
import { CloseAction, ErrorAction, LanguageClient, State, TransportKind } from "vscode-languageclient/node";
import { RestartBudget } from "./restarts";
import { VerdictPainter } from "./verdicts/painter";

/** What hears of a connection, and does what the server's commands ask for. */
export interface Owner {
  starting(): void;
  running(): void;
  /** The server ended by itself, whether or not it is started again. */
  ended(): void;
  /** The server ended by itself and is not started again. */
  gaveUp(): void;
  runMessage(notification: unknown): void;
  execute(command: string, argument: unknown): Promise<unknown>;
}

/**
 * Logs its errors and leaves it to us to speak to the user: two messages for one failure are one too many. Where in its
 * library one arose is left out: it would push what the server said last out of sight.
 */
class DiscreetClient extends LanguageClient {
  override error(message: string, data?: unknown): void {
    super.error(message, data instanceof Error ? data.message : data, false);
  }
}

/** A client, not started yet, of the server that a command starts in the folder `cwd`, for files of these languages. */
export function createClient(
  command: string,
  cwd: string,
  languages: readonly string[],
  log: vscode.LogOutputChannel,
  owner: Owner,
): LanguageClient {
  const budget = new RestartBudget();
  let answered = false;
  /** There while the server runs: what it has sent goes with it. */
  let verdicts: VerdictPainter | undefined;
  const client = new DiscreetClient(
    "robbdd",
    "RobBDD",
    { command, transport: TransportKind.stdio, options: { cwd } },
    {
      documentSelector: languages.map((language) => ({ scheme: "file", language })),
      outputChannel: log,
      initializationOptions: { pictures: true, replay: true, trusted: vscode.workspace.isTrusted },
      markdown: { isTrusted: { enabledCommands: ["robbdd.showReplay"] } },
      initializationFailedHandler: () => false,
      errorHandler: {
        // A broken pipe is followed by the close of the connection, which is where the decision is made.
        error: () => ({ action: ErrorAction.Continue, handled: true }),
        closed: () => {
          owner.ended();
          // A server that never answered will not do so the next time either.
          const again = answered && budget.crashed(Date.now());
          if (!again) {
            owner.gaveUp();
          }
          return { action: again ? CloseAction.Restart : CloseAction.DoNotRestart, handled: true };
        },
      },
      middleware: {
        provideCompletionItem: async (document, position, context, token, next) =>
          withoutSnippets(await next(document, position, context, token)),
        provideInlayHints: (document, part, token, next) => {
          const ask = (range: vscode.Range) => next(document, range, token);
          return verdicts === undefined ? ask(part) : verdicts.takeHints(document, part, ask);
        },
        provideCodeLenses: (document, token, next) => {
          const ask = () => next(document, token);
          return verdicts === undefined ? ask() : verdicts.takeLenses(document, ask);
        },
        executeCommand: (name, [argument]: unknown[]) => owner.execute(name, argument),
      },
      // Python's logging writes everything to stderr; that alone does not make a line an error.
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
      owner.running();
    }
  });
  return client;
}

function forwardLines(input: Readable, channel: vscode.LogOutputChannel): void {
  createInterface({ input }).on("line", (line) => {
    channel.info(line);
  });
}

/** Leaves out the server's snippets: the extension has the same ones, and offers them while there is no server, too. */
function withoutSnippets<Found extends vscode.CompletionItem[] | vscode.CompletionList>(
  found: Found | null | undefined,
): Found | vscode.CompletionItem[] | null | undefined {
  const isKept = ({ kind }: vscode.CompletionItem) => kind !== vscode.CompletionItemKind.Snippet;
  if (Array.isArray(found)) {
    return found.filter(isKept);
  }
  if (found) {
    found.items = found.items.filter(isKept);
  }
  return found;
}
