// Find, start, watch and stop the language server.
import * as vscode from "vscode";
import type { LanguageClient } from "vscode-languageclient/node";
import { openFiles } from "./written";
import { type Lookup, OWN, findServer } from "./lookup";
import { type Launch, launchSettings, serverVariables } from "./launch";
import { complain, inform, warn } from "./notices";
import { type ServerState, afterInstallation, notInstalled } from "./presentation";
import { isRunNotification } from "./runs/messages";
import type { RunMonitor } from "./runs/monitor";
import { makesPictures, recordingWords, tellPictures } from "./runs/recording";
import { openServerSetting } from "./settings";
import type { Setup } from "./setup/setup";
import { surroundings } from "./surroundings";
import { commandBeside } from "./terminal";
import { isMomentary, problemOf } from "./testing/answers";
import { RUNNING, type Named, hasUri, isNamed } from "./runTargets";

export const LANGUAGES = ["robbdd", "robbdd-scene", "robbdd-scenex", "robbdd-bddx", "robbdd-ktree", "robbdd-study"];
const STOP_TIMEOUT = 3000;

export class Server implements vscode.Disposable {
  private client: LanguageClient | undefined;
  private lookup: Lookup | undefined;
  private launch: Launch = { args: [], env: {} };
  private state: ServerState = { kind: "stopped" };
  private begun = false;
  /** Number of runs started by commands; part of their names. */
  private commands = 0;
  /** Serialises starts and stops, however fast they are requested. */
  private pending: Promise<void> = Promise.resolve();

  constructor(
    private readonly log: vscode.LogOutputChannel,
    private readonly runs: RunMonitor,
    private readonly setup: Setup,
    private readonly onState: (state: ServerState) => void,
  ) {}

  /** Find and start the server, unless already done: nothing runs until it is needed. */
  begin(): Promise<void> {
    if (this.begun) {
      return this.pending;
    }
    void this.setup.tidy();
    return this.restart();
  }

  /** Stop the server, if any, find it again and start it. */
  restart(): Promise<void> {
    this.begun = true;
    return this.enqueue(async () => {
      await this.shutDown();
      const lookup = await this.find();
      this.lookup = lookup;
      this.launch = launchSettings();
      if (lookup.found) {
        await this.start(lookup.command, lookup.origin);
        this.setup.offerUpdate(lookup.command, () => void this.install());
      } else {
        this.reportMissing(lookup);
      }
    });
  }

  /** Restart only if the lookup or the settings of the start would have another result than last time. */
  async restartIfMoved(): Promise<void> {
    if (!this.begun) {
      return;
    }
    const lookup = await this.find();
    if (JSON.stringify([lookup, launchSettings()]) !== JSON.stringify([this.lookup, this.launch])) {
      await this.restart();
    }
  }

  stop(): Promise<void> {
    return this.enqueue(() => this.shutDown());
  }

  /** Install a server for this extension and start it; return whether one runs then. */
  async install(): Promise<boolean> {
    await this.pending;
    const lookup = this.lookup;
    if (lookup?.found === true && lookup.origin !== OWN) {
      const used = `The language server ${lookup.command} (from ${lookup.origin}) is in use`;
      inform(`${used}; it takes precedence over one of the extension's own.`);
      return this.isRunning();
    }
    const before = this.state;
    if (!this.isRunning()) {
      this.publish({ kind: "installing" });
    }
    const ended = await this.setup.install();
    if (ended.kind === "installed") {
      await this.restart();
    } else if (this.state.kind === "installing") {
      this.publish(afterInstallation(ended, before));
    }
    if (ended.kind === "failed") {
      complain(notInstalled(ended.problem), {
        Retry: () => void this.install(),
        "Show Log": () => {
          this.log.show();
        },
        "Open Setting": () => {
          openServerSetting("package");
        },
      });
    }
    return this.isRunning();
  }

  /** Whether a server runs after pending starts; if none does, ask the user what to do. */
  async ready(): Promise<boolean> {
    await this.begin();
    if (this.state.kind === "missing") {
      const modal = { modal: true, detail: "It takes a minute or two and needs the network." };
      const message = "This needs the RobBDD language server, which is not installed.";
      return (await vscode.window.showInformationMessage(message, modal, "Install")) === "Install" && this.install();
    }
    if (!this.isRunning()) {
      complain("The RobBDD language server is not running.", {
        "Show Log": () => {
          this.log.show();
        },
        Restart: () => void this.restart(),
      });
    }
    return this.isRunning();
  }

  /** The command line of the server in use, or undefined, after a message, without one. */
  async commandLine(): Promise<{ readonly command: string; readonly env: Record<string, string> } | undefined> {
    if (!(await this.ready()) || this.lookup?.found !== true) {
      return undefined;
    }
    const entries = Object.entries(serverVariables(process.env, this.launch.env));
    const env = Object.fromEntries(entries.filter((entry): entry is [string, string] => entry[1] !== undefined));
    return { command: commandBeside(this.lookup.command), env };
  }

  private named<T extends object>(target: T): T & Named {
    this.commands += 1;
    return { token: `command-${this.commands}`, ...target };
  }

  private isRunning(): boolean {
    return this.client?.isRunning() === true;
  }

  private async find(): Promise<Lookup> {
    return findServer(await surroundings(this.setup.installed()?.command, this.log));
  }

  /**
   * Run a command of the server and handle its answer. Show a message and return `problem` if there is no server or it
   * refuses. A run without a `token` gets one, so that its end can be distinguished.
   */
  async execute(command: string, target: unknown): Promise<unknown> {
    const argument = RUNNING.has(command) && hasUri(target) ? this.named(target) : target;
    // A command may have activated the extension: the server is just starting then.
    await this.begin();
    const client = this.client;
    if (client?.isRunning() !== true) {
      const problem = "The RobBDD language server is not running.";
      warn(problem);
      return { problem };
    }
    if (RUNNING.has(command) && !vscode.workspace.isTrusted) {
      const problem = "Nothing was run: scenarios run code of this workspace, which you do not trust yet.";
      complain(problem, {
        "Manage Workspace Trust": () => void vscode.commands.executeCommand("workbench.trust.manage"),
      });
      this.tellRefusal(argument, { problem });
      return { problem };
    }
    try {
      const params = { command, arguments: [argument] };
      const result: unknown = await client.sendRequest("workspace/executeCommand", params);
      if (command === "robbdd.gherkin" || command === "robbdd.steps") {
        await openFiles(result);
      } else if (RUNNING.has(command)) {
        this.tellRefusal(argument, result);
        if (makesPictures(command, argument)) {
          this.runs.tell(recordingWords(result));
        }
        if (makesPictures(command, argument) && !isNamed(target)) {
          tellPictures(result);
        }
      }
      return result;
    } catch (error) {
      return { problem: this.refused(command, error) };
    } finally {
      if (isNamed(argument)) {
        // The answer follows the last message. A cancelled or crashed run has not reported its end.
        this.runs.end(argument.token);
      }
    }
  }

  /** Send a request that no user waits for; undefined without a server or an answer. */
  async request(method: string, params: object): Promise<unknown> {
    if (this.client?.isRunning() !== true) {
      return undefined;
    }
    try {
      return await this.client.sendRequest(method, params);
    } catch (error) {
      this.log.warn(`${method}: ${String(error)}`);
      return undefined;
    }
  }

  /** Send a request that a user waits for, and show why there is no answer. */
  async ask(method: string, params: object): Promise<unknown> {
    if (!(await this.ready())) {
      return undefined;
    }
    try {
      return await this.client?.sendRequest(method, params);
    } catch (error) {
      this.refused(method, error);
      return undefined;
    }
  }

  /** Notify the server, if it runs. */
  notify(method: string, params: object): void {
    if (this.isRunning()) {
      void this.client?.sendNotification(method, params);
    }
  }

  /** Wait until a pending start or stop has ended. */
  settled(): Promise<void> {
    return this.pending;
  }

  dispose(): void {
    void this.stop();
  }

  private enqueue(task: () => Promise<void>): Promise<void> {
    this.pending = this.pending.then(task).catch((error: unknown) => {
      this.log.error(error instanceof Error ? error : String(error));
    });
    return this.pending;
  }

  private async start(command: string, origin: string): Promise<void> {
    this.log.info(`Starting ${command} (from ${origin})`);
    let client: LanguageClient | undefined;
    try {
      client = await this.createClient(command);
      this.client = client;
      await client.start();
    } catch (error) {
      // The client or the exiting server has already written the reason to the log.
      this.log[client === undefined ? "error" : "debug"](String(error));
      this.fail(client, `The RobBDD language server (${command}) could not be started. See the log.`);
    }
  }

  private async createClient(command: string): Promise<LanguageClient> {
    const { createClient } = await import("./connection");
    const client = createClient(command, this.launch, this.setup.workingFolder(), LANGUAGES, this.log, {
      starting: () => {
        this.publish({ kind: "starting" });
      },
      running: (version) => {
        this.publish({ kind: "ready", command, version });
        this.setup.checkFit(command, version);
      },
      ended: () => {
        this.runs.abandon();
      },
      gaveUp: () => {
        this.fail(client, `The RobBDD language server (${command}) ended unexpectedly. See the log.`);
      },
      runMessage: (notification) => {
        if (isRunNotification(notification)) {
          this.runs.accept(notification);
        } else {
          this.log.warn(`Not a run message of this version: ${JSON.stringify(notification)}`);
        }
      },
      execute: (name, argument) => this.execute(name, argument),
    });
    return client;
  }

  /** Report at the requested items why they were not run. */
  private tellRefusal(target: unknown, answer: unknown): void {
    const problem = problemOf(answer);
    if (problem !== undefined && hasUri(target) && !isMomentary(answer)) {
      this.runs.refuse({ ...target, problem });
    }
  }

  private refused(command: string, error: unknown): string {
    const reason = error instanceof Error ? error.message : String(error);
    this.log.error(`${command}: ${reason}`);
    complain(`RobBDD: ${reason}`, {
      "Show Log": () => {
        this.log.show();
      },
    });
    return reason;
  }

  private async shutDown(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    if (client?.needsStop() === true) {
      await client.dispose(STOP_TIMEOUT);
    }
    this.runs.abandon();
    this.publish({ kind: "stopped" });
  }

  private publish(state: ServerState): void {
    this.state = state;
    void vscode.commands.executeCommand("setContext", "robbdd.serverReady", state.kind === "ready");
    this.onState(state);
  }

  /** Report once, for the current client, that it is gone. */
  private fail(client: LanguageClient | undefined, problem: string): void {
    if (this.client !== client) {
      return;
    }
    this.client = undefined;
    this.publish({ kind: "failed", problem });
    complain(problem, {
      "Show Log": () => {
        this.log.show();
      },
      Restart: () => void this.restart(),
    });
  }

  private reportMissing(lookup: Lookup & { found: false }): void {
    this.log.error(lookup.problem);
    for (const path of lookup.tried) {
      this.log.info(`tried ${path}`);
    }
    this.publish({ kind: lookup.installable ? "missing" : "failed", problem: lookup.problem });
    const buttons = { "Open Setting": openServerSetting, "Try Again": () => void this.restart() };
    if (lookup.installable) {
      warn(lookup.problem, { Install: () => void this.install(), ...buttons });
    } else {
      complain(lookup.problem, buttons);
    }
  }
}
