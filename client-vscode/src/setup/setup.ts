// Installs the language server for the user: progress, cancelling, what went wrong, and when it is too old.
import * as vscode from "vscode";
import { searchFolders } from "../lookup";
import type { Installed } from "../presentation";
import { surroundings } from "../surroundings";
import { type PrivateServer, bundledWheel, discardAbandoned, installedServer, workingFolder } from "./environments";
import { InstallProblem, installServer } from "./installer";
import { type Wanted, wantedPackage } from "./steps";

export class Setup {
  private installing: Promise<Installed> | undefined;
  /** What an update was offered for: once in a window is enough. */
  private offered: string | undefined;

  /**
   * @param storage the folder of the private environments
   * @param version that of the extension, and so of its server
   * @param bundled the folder of the wheel that the extension brings along
   */
  constructor(
    private readonly storage: string,
    private readonly version: string,
    private readonly bundled: string,
    private readonly log: vscode.LogOutputChannel,
  ) {}

  /** The server in a private environment, if there is one. */
  installed(): PrivateServer | undefined {
    return installedServer(this.storage, this.wanted().name);
  }

  /** The folder that the server works in; throws where it cannot be made. */
  workingFolder(): string {
    return workingFolder(this.storage);
  }

  /** Delete what earlier windows have left of installations that they did not finish. */
  tidy(): Promise<void> {
    return discardAbandoned(this.storage);
  }

  /** Install the server. The caller tells the user of a problem: nothing here waits for an answer to that. */
  install(): Promise<Installed> {
    this.installing ??= this.installNow().finally(() => {
      this.installing = undefined;
    });
    return this.installing;
  }

  /** Offer an update when the private server in use is not the one that belongs to this extension. */
  offerUpdate(command: string, update: () => void): void {
    const server = this.installed();
    const wanted = this.wanted().name;
    if (server?.command !== command || server.package === wanted || this.offered === wanted) {
      return;
    }
    this.offered = wanted;
    const message = `RobBDD: this version of the extension belongs to ${wanted}; ${server.package} is installed.`;
    void vscode.window.showInformationMessage(message, "Update").then((choice) => {
      if (choice !== undefined) {
        update();
      }
    });
  }

  private wanted(): Wanted {
    const setting = vscode.workspace.getConfiguration("robbdd").get("server.package", "");
    return wantedPackage(setting, this.version, bundledWheel(this.bundled, this.version));
  }

  private async installNow(): Promise<Installed> {
    const title = "Installing the RobBDD language server";
    const where = vscode.ProgressLocation.Notification;
    const problem = await vscode.window.withProgress({ location: where, title, cancellable: true }, (progress, token) =>
      this.attempt((message) => {
        progress.report({ message });
      }, token),
    );
    if (problem === undefined || problem === "cancelled") {
      return { kind: problem ?? "installed" };
    }
    this.log.error(problem);
    return { kind: "failed", problem };
  }

  /** Install it once; returns what went wrong. */
  private async attempt(
    onProgress: (message: string) => void,
    token: vscode.CancellationToken,
  ): Promise<string | undefined> {
    const stop = new AbortController();
    token.onCancellationRequested(() => {
      stop.abort();
    });
    try {
      const around = await surroundings(undefined, this.log);
      const { command } = await installServer({
        storage: this.storage,
        wanted: this.wanted(),
        folders: searchFolders(around),
        python: around.python,
        signal: stop.signal,
        onProgress,
        onLine: (line) => {
          this.log.info(line);
        },
      });
      this.log.info(`Installed ${command}`);
      return undefined;
    } catch (error) {
      if (stop.signal.aborted) {
        this.log.info("The installation was cancelled.");
        return "cancelled";
      }
      if (!(error instanceof InstallProblem)) {
        this.log.error(error instanceof Error ? error : String(error));
      }
      return error instanceof Error ? error.message : String(error);
    }
  }
}
