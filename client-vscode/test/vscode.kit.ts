// The editor without an editor: the part of its API that the extension uses. The tests' build puts it in place of the
// module "vscode". What a test may look at or set is in `editor`.
import { pathToFileURL, fileURLToPath } from "node:url";
import { Node, Nodes } from "./testing.kit";

type Listener = (event: unknown) => unknown;
type Handler = (...values: unknown[]) => unknown;

const ended = { dispose: () => undefined };
const nothing = (): Promise<undefined> => Promise.resolve(undefined);

export class EventEmitter {
  private readonly listeners = new Set<Listener>();

  readonly event = (listener: Listener): { dispose: () => void } => {
    this.listeners.add(listener);
    return { dispose: () => this.listeners.delete(listener) };
  };

  fire(event?: unknown): void {
    for (const listener of this.listeners) {
      listener(event);
    }
  }

  dispose(): void {
    this.listeners.clear();
  }
}

export class Uri {
  private constructor(private readonly address: URL) {}

  static parse(text: string): Uri {
    return new Uri(new URL(text || "file:///"));
  }

  static from({ scheme, path, query }: { readonly scheme: string; readonly path: string; readonly query: string }): Uri {
    return Uri.parse(`${scheme}:${path}?${encodeURIComponent(query)}`);
  }

  static file(path: string): Uri {
    return new Uri(pathToFileURL(path));
  }

  static joinPath({ address }: Uri, ...parts: string[]): Uri {
    return new Uri(new URL([address.href.replace(/\/$/, ""), ...parts.map(encodeURIComponent)].join("/")));
  }

  get scheme(): string {
    return this.address.protocol.slice(0, -1);
  }

  get path(): string {
    return decodeURIComponent(this.address.pathname);
  }

  get query(): string {
    return decodeURIComponent(this.address.search.slice(1));
  }

  get fsPath(): string {
    return fileURLToPath(this.address);
  }

  toString(): string {
    return this.address.href;
  }
}

/** A panel with a page, as the extension leaves it. */
export class WebviewPanel {
  /** The messages to the page. */
  readonly posted: unknown[] = [];
  /** Fires the messages of the page. */
  readonly fromPage = new EventEmitter();
  readonly webview = {
    html: "",
    options: {},
    cspSource: "https://*.pages.example",
    asWebviewUri: (uri: Uri) => `https://pages.example${uri.path}`,
    onDidReceiveMessage: this.fromPage.event,
    postMessage: (message: unknown) => Promise.resolve(void this.posted.push(message)),
  };
  readonly onDidDispose = new EventEmitter().event;
  iconPath: unknown;
  viewColumn = 1;
  disposed = false;

  constructor(public title: string) {}

  reveal(): void {
    return undefined;
  }

  dispose(): void {
    this.disposed = true;
  }
}

/** Something that can be cancelled and is not. */
export class CancellationTokenSource {
  private readonly cancelled = new EventEmitter();
  readonly token = { isCancellationRequested: false, onCancellationRequested: this.cancelled.event };

  cancel(): void {
    this.token.isCancellationRequested = true;
    this.cancelled.fire();
  }

  dispose(): void {
    this.cancelled.dispose();
  }
}

class Editor {
  settings: Readonly<Record<string, unknown>> = {};
  readonly commands = new Map<string, Handler>();
  /** What starts runs in the Testing view, by its name. */
  readonly profiles = new Map<string, Handler>();
  /** Restores panels, by type. */
  readonly serializers = new Map<string, { deserializeWebviewPanel: (panel: WebviewPanel, state: unknown) => Promise<void> }>();
  readonly panels: WebviewPanel[] = [];
  /** Messages that are no problems. */
  readonly messages: string[] = [];
  /** The buttons that the user presses in those messages, one after the other. */
  readonly pressed: string[] = [];
  /** Messages that say to the user what went wrong. */
  readonly problems: string[] = [];
  /** Tests that could not be run, each with the reason. */
  readonly errored: string[] = [];
  /** Tests that passed. */
  readonly passed: string[] = [];
  /** What the user chooses from the lists that are shown, one after the other: the end of a label. Then nothing more. */
  readonly choices: string[] = [];
  /** What the user types into the boxes that are shown, one after the other; refused where a box refuses it. */
  readonly typed: string[] = [];
  /** The titles of the lists that were shown. */
  readonly titles: string[] = [];
  /** The lists that were shown. */
  readonly lists: (readonly { readonly label: string; readonly description?: string; readonly detail?: string }[])[] = [];
  /** How many entries of runs are open in the Testing view. */
  openRuns = 0;
  /** Completes the configuration of a session, and listens to its adapter. */
  resolve: Handler = () => undefined;
  track: Handler = () => undefined;
  debugEvent: Handler = () => undefined;
  session: unknown;
  /** Describes the debug adapter of a session. */
  adapter: Handler = () => undefined;
  /** The configurations of debug sessions, and whether they start. */
  readonly debugged: unknown[] = [];
  debugs = true;
  /** The texts of new documents. */
  readonly texts: string[] = [];
  /** The tasks that were begun, and whether edited files can be saved before. */
  readonly tasks: Task[] = [];
  saves = true;
  readonly files = new Map<string, string>();
  /** Addresses at which there is no file. */
  readonly missing = new Set<string>();
  clipboard = "";
  /** Opens links to the extension. */
  uriHandler: { readonly handleUri: (uri: { readonly toString: () => string }) => unknown } | undefined;
  /** What fills the Testing view. */
  controller: { resolveHandler: (item: undefined) => Promise<void> } = { resolveHandler: nothing };
  readonly opened = new EventEmitter();
  readonly saved = new EventEmitter();
  readonly trusted = new EventEmitter();

  /** Reset, as another window. */
  reset(isTrusted: boolean): void {
    workspace.isTrusted = isTrusted;
    workspace.workspaceFolders = undefined;
    for (const part of [this.commands, this.profiles, this.serializers, this.files]) {
      part.clear();
    }
    for (const event of [this.opened, this.saved, this.trusted]) {
      event.dispose();
    }
    this.missing.clear();
    this.clipboard = "";
    this.panels.length = 0;
    this.problems.length = 0;
    this.messages.length = 0;
    this.pressed.length = 0;
    this.errored.length = 0;
    this.passed.length = 0;
    this.choices.length = 0;
    this.typed.length = 0;
    this.lists.length = 0;
    this.titles.length = 0;
    this.openRuns = 0;
    this.texts.length = 0;
    this.tasks.length = 0;
    this.saves = true;
    this.debugged.length = 0;
    this.debugs = true;
    this.session = undefined;
  }

  /** Trust the workspace, as the user would. */
  trust(): void {
    workspace.isTrusted = true;
    this.trusted.fire();
  }
}

export const editor = new Editor();

const quiet = () => new EventEmitter().event;
const report = (problem: string): Promise<undefined> => {
  editor.problems.push(problem);
  return nothing();
};

export const workspace = {
  isTrusted: true,
  textDocuments: [],
  workspaceFolders: undefined as readonly { readonly uri: Uri }[] | undefined,
  fs: {
    stat: (uri: Uri) => (editor.missing.has(uri.toString()) ? Promise.reject(new Error("FileNotFound")) : nothing()),
    writeFile: (uri: Uri, content: Uint8Array) => Promise.resolve(void editor.files.set(uri.toString(), Buffer.from(content).toString("base64"))),
    readFile: (uri: Uri) => Promise.resolve(new TextEncoder().encode(editor.files.get(uri.toString()) ?? "")),
  },
  asRelativePath: (uri: Uri): string => {
    const folder = workspace.getWorkspaceFolder(uri);
    return folder === undefined ? String(uri) : decodeURIComponent(uri.toString().slice(folder.uri.toString().length + 1));
  },
  getWorkspaceFolder: (uri: Uri): { readonly uri: Uri } | undefined => {
    return workspace.workspaceFolders?.find((folder) => uri.toString().startsWith(`${folder.uri.toString()}/`));
  },
  getConfiguration: () => ({ get: (name: string, otherwise?: unknown) => editor.settings[name] ?? otherwise }),
  createFileSystemWatcher: () => ({ ...ended, onDidCreate: quiet(), onDidChange: quiet(), onDidDelete: quiet() }),
  registerTextDocumentContentProvider: () => ended,
  openTextDocument: (shown?: { readonly content?: string }) => {
    editor.texts.push(shown?.content ?? "");
    return Promise.resolve({ languageId: "feature" });
  },
  findFiles: () => Promise.resolve([]),
  saveAll: () => Promise.resolve(editor.saves),
  onDidChangeConfiguration: quiet(),
  onDidChangeTextDocument: quiet(),
  onDidChangeWorkspaceFolders: quiet(),
  onDidCloseTextDocument: quiet(),
  onDidGrantWorkspaceTrust: editor.trusted.event,
  onDidOpenTextDocument: editor.opened.event,
  onDidSaveTextDocument: editor.saved.event,
};

export const window = {
  activeTextEditor: undefined,
  visibleTextEditors: [],
  tabGroups: { activeTabGroup: { activeTab: undefined } },
  createOutputChannel: () => {
    const write = (): void => undefined;
    return { ...ended, show: write, appendLine: write, debug: write, info: write, warn: write, error: write };
  },
  createStatusBarItem: () => ({ ...ended, show: () => undefined }),
  createTextEditorDecorationType: () => ended,
  createWebviewPanel: (_: string, title: string) => {
    const panel = new WebviewPanel(title);
    editor.panels.push(panel);
    return panel;
  },
  registerWebviewPanelSerializer: (type: string, serializer: { deserializeWebviewPanel: () => Promise<void> }) => {
    editor.serializers.set(type, serializer);
    return ended;
  },
  registerUriHandler: (handler: { readonly handleUri: (uri: { readonly toString: () => string }) => unknown }) => {
    editor.uriHandler = handler;
    return ended;
  },
  showSaveDialog: ({ defaultUri }: { readonly defaultUri?: Uri }) => Promise.resolve(defaultUri),
  showErrorMessage: report,
  showWarningMessage: report,
  showInformationMessage: (message: string) => {
    editor.messages.push(message);
    return Promise.resolve(editor.pressed.shift());
  },
  showInputBox: ({ validateInput }: { readonly validateInput?: (text: string) => string | undefined }) => {
    const text = editor.typed.shift();
    const problem = text === undefined ? undefined : validateInput?.(text);
    return problem === undefined ? Promise.resolve(text) : report(problem);
  },
  showOpenDialog: nothing,
  showQuickPick: (
    list: readonly { readonly label: string; readonly picked?: boolean }[],
    options?: { readonly canPickMany?: boolean; readonly title?: string },
  ) => {
    editor.lists.push(list);
    editor.titles.push(options?.title ?? "");
    if (options?.canPickMany === true) {
      return Promise.resolve(list.filter(({ picked }) => picked === true));
    }
    const end = editor.choices.shift();
    return Promise.resolve(end === undefined ? undefined : list.find(({ label }) => label.endsWith(end)));
  },
  createQuickPick: () => new QuickPick(),
  showTextDocument: nothing,
  onDidChangeActiveTextEditor: quiet(),
  onDidChangeTextEditorSelection: quiet(),
  onDidChangeVisibleTextEditors: quiet(),
};

/** A list in which a test chooses the next of `choices` a moment after it is shown, when late entries have come. */
class QuickPick {
  title = "";
  placeholder = "";
  busy = false;
  items: readonly { readonly label: string }[] = [];
  activeItems: readonly { readonly label: string }[] = [];
  selectedItems: readonly { readonly label: string }[] = [];
  private accepted: () => void = () => undefined;
  private hidden: () => void = () => undefined;

  onDidAccept(listener: () => void): void {
    this.accepted = listener;
  }

  onDidHide(listener: () => void): void {
    this.hidden = listener;
  }

  show(): void {
    this.activeItems = this.items.slice(0, 1);
    setImmediate(() => {
      editor.titles.push(this.title);
      editor.lists.push(this.items);
      const end = editor.choices.shift();
      this.selectedItems = this.items.filter(({ label }) => end !== undefined && label.endsWith(end)).slice(0, 1);
      if (this.selectedItems.length > 0) {
        this.accepted();
      } else {
        this.hide();
      }
    });
  }

  hide(): void {
    this.hidden();
  }

  dispose(): void {
    this.items = [];
  }
}

/** A task that a test reads: the program and its arguments, and where it runs. */
export class ProcessExecution {
  constructor(
    readonly process: string,
    readonly args: readonly string[],
    readonly options: { readonly cwd: string; readonly env: Readonly<Record<string, string>> },
  ) {}
}

export class Task {
  presentationOptions: unknown;

  constructor(
    readonly definition: Readonly<Record<string, string>>,
    readonly scope: number,
    readonly name: string,
    readonly source: string,
    readonly execution: ProcessExecution,
  ) {}
}

const ends = new EventEmitter();

export const tasks = {
  executeTask: (task: Task) => {
    editor.tasks.push(task);
    return Promise.resolve(task);
  },
  onDidEndTaskProcess: ends.event,
};

/** End the process of a task. */
export function endTask(task: Task, exitCode: number): void {
  ends.fire({ execution: task, exitCode });
}

export const commands = {
  executeCommand: nothing,
  registerCommand: (name: string, handler: Handler) => {
    editor.commands.set(name, handler);
    return ended;
  },
};

export class DebugAdapterExecutable {
  constructor(
    readonly command: string,
    readonly args: readonly string[],
    readonly options: { readonly env: Record<string, string> },
  ) {}
}

export class EvaluatableExpression {
  constructor(readonly range: unknown) {}
}

export class DebugAdapterServer {
  constructor(
    readonly port: number,
    readonly host: string,
  ) {}
}

export const debug = {
  registerDebugAdapterDescriptorFactory: (_: string, factory: { createDebugAdapterDescriptor: Handler }) => {
    editor.adapter = factory.createDebugAdapterDescriptor;
    return ended;
  },
  registerDebugConfigurationProvider: (_: string, provider: { resolveDebugConfiguration: Handler }) => {
    editor.resolve = provider.resolveDebugConfiguration;
    return ended;
  },
  onDidReceiveDebugSessionCustomEvent: (hear: Handler) => {
    editor.debugEvent = hear;
    return ended;
  },
  registerDebugAdapterTrackerFactory: (_: string, factory: { createDebugAdapterTracker: Handler }) => {
    editor.track = factory.createDebugAdapterTracker;
    return ended;
  },
  get activeDebugSession() {
    return editor.session;
  },
  startDebugging: (_: unknown, configuration: unknown) => {
    editor.debugged.push(configuration);
    return Promise.resolve(editor.debugs);
  },
};

export const languages = { registerEvaluatableExpressionProvider: () => ended, getDiagnostics: () => [], getLanguages: () => Promise.resolve([]) };
export const version = "1.91.0";
export const env = {
  remoteName: undefined,
  appName: "Editor",
  uriScheme: "vscode",
  clipboard: {
    readText: () => Promise.resolve(editor.clipboard),
    writeText: (text: string) => Promise.resolve(void (editor.clipboard = text)),
  },
};
export const extensions = { getExtension: () => undefined };

export const tests = {
  createTestController: () => {
    const controller = {
      ...ended,
      resolveHandler: nothing as (item: undefined) => Promise<void>,
      items: new Nodes(),
      createTestItem: (id: string, label: string, uri: Uri) => Object.assign(new Node(id, label), { uri }),
      createRunProfile: (name: string, _: unknown, handler: Handler) => {
        editor.profiles.set(name, handler);
        return ended;
      },
      createTestRun: () => {
        editor.openRuns += 1;
        return {
          token: new CancellationTokenSource().token,
          enqueued: () => undefined,
          started: () => undefined,
          passed: ({ label }: Node) => editor.passed.push(label),
          errored: ({ label }: Node, { message }: TestMessage) => editor.errored.push(`${label}: ${message}`),
          appendOutput: () => undefined,
          end: () => {
            editor.openRuns -= 1;
          },
        };
      },
      invalidateTestResults: () => undefined,
    };
    editor.controller = controller;
    return controller;
  },
};

export class TestMessage {
  constructor(readonly message: string) {}
}

export class TestRunRequest {
  constructor(readonly include?: readonly unknown[]) {}
}

export class Range {
  constructor(
    readonly startLine: number,
    readonly startCharacter: number,
    readonly endLine: number,
    readonly endCharacter: number,
  ) {}
}

export class ThemeColor {
  constructor(readonly id: string) {}
}

export class Location {
  constructor(
    readonly uri: Uri,
    readonly range: Range,
  ) {}
}

export class MarkdownString {
  value = "";

  appendText(text: string): this {
    this.value += text;
    return this;
  }
}

export class TabInputWebview {
  constructor(readonly viewType: string) {}
}

export const CompletionItemKind = { Snippet: 14 };
export const ProgressLocation = { Notification: 15 };
export const StatusBarAlignment = { Left: 1 };
export const TestRunProfileKind = { Run: 1, Debug: 2 };
export const TextEditorRevealType = { InCenterIfOutsideViewport: 2 };
export const TaskPanelKind = { Dedicated: 2 };
export const TaskRevealKind = { Always: 1 };
export const TaskScope = { Workspace: 2 };
export const ViewColumn = { Active: -1, Beside: -2, One: 1, Two: 2, Three: 3 };
