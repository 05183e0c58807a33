// Entry point: create the parts and connect them.
import * as vscode from "vscode";
import { LANGUAGES, Server } from "./client";
import { registerCommands } from "./commands";
import { Debugging } from "./debugging";
import { noticeModels } from "./milestones";
import { ComparisonView } from "./panels/comparison/view";
import { GraphView } from "./panels/graph/view";
import { HistoryView } from "./panels/history/view";
import { PausedScene } from "./panels/replay/paused";
import { ReplayView } from "./panels/replay/view";
import { SceneView } from "./panels/scene/view";
import { StudyView } from "./panels/study/view";
import { PreviewView } from "./preview/view";
import { onInterpreterChange } from "./python";
import { RunOptionsChooser } from "./runs/chooser";
import { RunMonitor } from "./runs/monitor";
import { Setup } from "./setup/setup";
import { StatusItem } from "./status";
import { offerCommandLine } from "./terminal";
import { TestingView } from "./testing/view";
import { type Versions, reportText } from "./versions";

let server: Server | undefined;

export function activate(context: vscode.ExtensionContext): void {
  const log = vscode.window.createOutputChannel("RobBDD", { log: true });
  const status = new StatusItem();
  const runs = new RunMonitor((progress, summary) => {
    status.showRuns(progress, summary);
  });
  const { version } = context.extension.packageJSON as { readonly version: string };
  const setup = new Setup(context.globalStorageUri.fsPath, version, context.asAbsolutePath("out/server"), log);
  let running: Versions["server"];
  const started = new Server(log, runs, setup, (state) => {
    status.showServer(state);
    running = state.kind === "ready" ? state : undefined;
    offerCommandLine(context.environmentVariableCollection, running?.command);
    if (state.kind === "ready") {
      previews.refreshSoon();
      graphs.refreshSoon();
      drawings.refreshSoon();
      void tests.serverReady();
    }
  });
  const previews = new PreviewView(started);
  const graphs = new GraphView(started, context.extensionUri);
  const drawings = new SceneView(started, context.extensionUri);
  const chooser = new RunOptionsChooser(context.workspaceState, (target) => started.execute("robbdd.estimate", target));
  const tests = new TestingView(started, runs, chooser);
  const replays = new ReplayView(started, context.extensionUri, context.extension.id);
  const scenes = new PausedScene(context.extensionUri);
  const studies = new StudyView(started, replays, context.extensionUri);
  const comparisons = new ComparisonView(started, replays, context.extensionUri);
  const histories = new HistoryView(started, replays, comparisons, runs, context.extensionUri);
  server = started;
  context.subscriptions.push(
    log,
    status,
    runs,
    previews,
    graphs,
    drawings,
    replays,
    studies,
    histories,
    comparisons,
    tests,
    noticeModels(),
    new Debugging(started, runs),
    scenes,
    ...registerCommands(started, runs, chooser, { previews, graphs, drawings, replays, studies, histories, comparisons, tests, scenes }, log, () =>
      reportIssue(started, { extension: version, server: running }),
    ),
    vscode.window.registerUriHandler({
      handleUri: (uri) => replays.openLink(uri.toString(true)),
    }),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("robbdd.server")) {
        void started.restartIfMoved();
      }
    }),
    vscode.workspace.onDidOpenTextDocument((document) => {
      if (LANGUAGES.includes(document.languageId)) {
        void started.begin();
      }
    }),
    vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
      // The server sees code only when it is saved: an error that a run found in it is outdated from the first edit on.
      if (document.languageId === "python" && contentChanges.length > 0 && hasOurs(document.uri)) {
        started.notify("robbdd/codeEdited", { uri: document.uri.toString() });
      }
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(() => {
      // Send the state to the server when it starts; it may be another one now.
      void started.restart();
    }),
    vscode.workspace.onDidChangeWorkspaceFolders(() => {
      void started.restartIfMoved();
    }),
  );
  // Activate the parts when a model is shown or the Testing view is opened; a folder with models alone does not. Not
  // awaited: parts that need the server wait for it themselves.
  if (vscode.workspace.textDocuments.some(({ languageId }) => LANGUAGES.includes(languageId))) {
    void started.begin();
  }
  void onInterpreterChange(() => void started.restartIfMoved(), log).then((listener) => {
    if (listener !== undefined) {
      context.subscriptions.push(listener);
    }
  });
}

/** Open a new text with the versions of all parts, to be completed and sent. */
async function reportIssue(started: Server, parts: Pick<Versions, "extension" | "server">): Promise<void> {
  const editor = `${vscode.env.appName} ${vscode.version}`;
  const environment = parts.server === undefined ? undefined : await started.request("robbdd/versions", {});
  const content = reportText({ ...parts, environment, editor, system: `${process.platform} ${process.arch}` });
  await vscode.window.showTextDocument(await vscode.workspace.openTextDocument({ language: "markdown", content }));
}

/** Whether the server has found an error in a file. */
function hasOurs(uri: vscode.Uri): boolean {
  return vscode.languages.getDiagnostics(uri).some(({ source }) => source === "robbdd");
}

export function deactivate(): Promise<void> | undefined {
  return server?.stop();
}
