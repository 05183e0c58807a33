// Servers without processes: the tests' build uses this instead of "vscode-languageclient/node".
import { World } from "./testing.kit";
import type { Question } from "../src/testing/listing";

export const State = { Stopped: 1, Running: 2, Starting: 3 };
export const CloseAction = { DoNotRestart: 1, Restart: 2 };
export const ErrorAction = { Continue: 1, Shutdown: 2 };
export const TransportKind = { stdio: 0 };

interface ServerOptions {
  readonly command: string;
  readonly args: readonly string[];
  readonly options: { readonly cwd: string; readonly env: Readonly<Record<string, string | undefined>> };
}

interface ClientOptions {
  readonly initializationOptions: Readonly<Record<string, unknown>>;
  readonly middleware: { readonly executeCommand: (name: string, values: unknown[]) => Promise<unknown> };
}

/** Starts immediately, and returns prepared answers; the Testing view gets the tests of a `World`. */
export class LanguageClient {
  /** All created clients, the latest last. */
  static readonly made: LanguageClient[] = [];
  /** What servers answer, by the request's method. */
  static readonly answers = new Map<string, (params: never) => unknown>();

  /** Commands of the server that it was sent. */
  readonly executed: string[] = [];
  /** Notifications that the server was sent. */
  readonly notified: [method: string, params: unknown][] = [];
  /** What hears of the server's notifications, by the method. */
  readonly listeners = new Map<string, (notification: unknown) => void>();
  /** Version that servers state; undefined for none. */
  static version: string | undefined;
  readonly initializeResult = { serverInfo: { version: LanguageClient.version } };
  private state = State.Stopped;
  private hear: (change: { newState: number }) => void = () => undefined;

  constructor(
    _id: string,
    _name: string,
    readonly server: ServerOptions,
    readonly options: ClientOptions,
  ) {
    LanguageClient.made.push(this);
  }

  static reset(): void {
    this.made.length = 0;
    this.answers.clear();
    this.version = undefined;
    const world = new World();
    this.answers.set("robbdd/tests", (question: Question) => world.ask(question));
  }

  onDidChangeState(hear: (change: { newState: number }) => void): void {
    this.hear = hear;
  }

  onNotification(method: string, listener: (notification: unknown) => void): void {
    this.listeners.set(method, listener);
  }

  async start(): Promise<void> {
    this.change(State.Starting);
    await Promise.resolve();
    this.change(State.Running);
  }

  isRunning(): boolean {
    return this.state === State.Running;
  }

  needsStop(): boolean {
    return this.isRunning();
  }

  async dispose(): Promise<void> {
    await Promise.resolve();
    this.change(State.Stopped);
  }

  async sendRequest(method: string, params: object): Promise<unknown> {
    await Promise.resolve();
    if (method === "workspace/executeCommand" && "command" in params) {
      this.executed.push(String(params.command));
    }
    return LanguageClient.answers.get(method)?.(params as never);
  }

  sendNotification(method: string, params: unknown): Promise<void> {
    this.notified.push([method, params]);
    return Promise.resolve();
  }

  error(): void {
    return undefined;
  }

  private change(state: number): void {
    this.state = state;
    this.hear({ newState: state });
  }
}
