// Install the language server for the user: progress, cancellation, errors, and updates.
import * as vscode from "vscode";
import { searchFolders } from "../lookup";
import { inform, warn } from "../notices";
import type { Installed } from "../presentation";
import { openServerSetting } from "../settings";
import { surroundings } from "../surroundings";
import { fits } from "../versions";
import { type PrivateServer, bundledWheel, discardAbandoned, installedServer, unpackedWheel, workingFolder } from "./environments";
import { InstallProblem, installServer } from "./installer";
import { type Wanted, wantedPackage } from "./steps";

export class Setup {
  private installing: Promise<Installed> | undefined;
  /** The server for which an update was offered: once in a window is enough. */
  private offered: string | undefined;
  /** Version of the last server that did not fit. */
  private unfit: string | undefined;

  /**
   * @param storage the folder of the private environments
   * @param version version of the extension and of its server
   * @param bundled the folder of the compressed wheel
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

  /** The server's working folder; throws if it cannot be created. */
  workingFolder(): string {
    return workingFolder(this.storage);
  }

  /** Delete remains of unfinished installations of earlier windows. */
  tidy(): Promise<void> {
    return discardAbandoned(this.storage);
  }

  /** Install the server. The caller reports problems to the user; nothing here waits for an answer. */
  install(): Promise<Installed> {
    this.installing ??= this.installNow().finally(() => {
      this.installing = undefined;
    });
    return this.installing;
  }

  /** Offer an update if the private server in use does not match this extension. */
  offerUpdate(command: string, update: () => void): void {
    const server = this.installed();
    const wanted = this.wanted().name;
    if (server?.command !== command || server.package === wanted || this.offered === wanted) {
      return;
    }
    this.offered = wanted;
    const message = `RobBDD: this version of the extension needs ${wanted}; ${server.package} is installed.`;
    inform(message, { Update: update });
  }

  /** Warn, once for each pair of versions, if a server does not fit this extension. */
  checkFit(command: string, version: string | undefined): void {
    if (version === undefined || fits(version, this.version) || this.unfit === version) {
      return;
    }
    this.unfit = version;
    const found = `The language server ${command} has version ${version}, this extension ${this.version}`;
    warn(`${found}: parts of it may not work. Install the same version of both.`, {
      "Open Setting": () => {
        openServerSetting();
      },
    });
  }

  /** The package to install; `wheel` is the path of the unpacked wheel of the server. */
  private wanted(wheel?: string): Wanted {
    const setting = vscode.workspace.getConfiguration("robbdd").get("server.package", "");
    return wantedPackage(setting, this.version, wheel);
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

  /** Install it once; return the problem, if any. */
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
      const bundled = bundledWheel(this.bundled, this.version);
      const { command } = await installServer({
        storage: this.storage,
        wanted: this.wanted(bundled && unpackedWheel(bundled, this.storage)),
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
