// The commands of the palette. Those of code lenses (robbdd.run, …) belong to the server.
import * as vscode from "vscode";
import type { Server } from "./client";
import type { ComparisonView } from "./panels/comparison/view";
import type { GraphView } from "./panels/graph/view";
import type { HistoryView } from "./panels/history/view";
import { recordingOf } from "./panels/replay/request";
import type { PausedScene } from "./panels/replay/paused";
import type { ReplayView } from "./panels/replay/view";
import type { SceneView } from "./panels/scene/view";
import type { StudyView } from "./panels/study/view";
import type { PreviewView } from "./preview/view";
import { debugScenario } from "./debugChoice";
import { RUNNABLE, SCENES, STUDIED, STUDIES, modelFor, openModel } from "./models";
import { inform } from "./notices";
import { newProject } from "./projects";
import type { RunOptionsChooser } from "./runs/chooser";
import type { RunMonitor } from "./runs/monitor";
import { argumentsOf } from "./runs/options";
import { askUntilFailure, tellFailure } from "./runs/untilFailure";
import { openServerSetting } from "./settings";
import { type StudyAction, executeStudy } from "./studies";
import { isRecord } from "./values";
import { hasUri } from "./runTargets";
import type { TestingView } from "./testing/view";

/** Views that show a model next to its text. */
export interface Views {
  readonly previews: PreviewView;
  readonly graphs: GraphView;
  readonly drawings: SceneView;
  readonly tests: TestingView;
  readonly replays: ReplayView;
  readonly studies: StudyView;
  readonly histories: HistoryView;
  readonly comparisons: ComparisonView;
  readonly scenes: PausedScene;
}

export function registerCommands(
  server: Server,
  runs: RunMonitor,
  chooser: RunOptionsChooser,
  { previews, graphs, drawings, replays, studies, histories, comparisons, tests, scenes }: Views,
  log: vscode.LogOutputChannel,
  reportIssue: () => unknown,
): vscode.Disposable[] {
  const handlers: Record<string, (target?: unknown) => unknown> = {
    "robbdd.runFile": (target) => withModel(target, (uri) => server.execute("robbdd.run", { uri }), RUNNABLE),
    "robbdd.runWithOptions": (target) => withModel(target, (uri) => runWithOptions(server, chooser, uri), RUNNABLE),
    "robbdd.runUntilFailure": (target) => withModel(target, (uri) => runUntilFailure(server, replays, uri), RUNNABLE),
    "robbdd.rerunFailedOfFile": (target) => withModel(target, (uri) => server.execute("robbdd.rerunFailed", { uri }), RUNNABLE),
    "robbdd.recordFile": (target) => withModel(target, (uri) => server.execute("robbdd.record", { uri }), RUNNABLE),
    "robbdd.debugFile": (target) => withModel(target, (uri) => server.execute("robbdd.run", { uri, debug: true }), RUNNABLE),
    "robbdd.debugScenario": (target) => withModel(modelOf(target), (uri) => debugScenario(server, uri, target), RUNNABLE),
    "robbdd.showPausedScene": () => scenes.open(),
    "robbdd.cancelRun": () => server.execute("robbdd.cancel", {}),
    "robbdd.generateGherkin": (target) => withModel(target, (uri) => server.execute("robbdd.gherkin", { uri })),
    "robbdd.previewGherkin": (target) => withModel(target, (uri) => previews.open(vscode.Uri.parse(uri))),
    "robbdd.showGraph": (target) =>
      withModel(target, (uri) => {
        graphs.open(vscode.Uri.parse(uri));
      }),
    "robbdd.showScene": (target) =>
      withModel(
        target,
        (uri) => {
          drawings.open(vscode.Uri.parse(uri));
        },
        SCENES,
      ),
    "robbdd.runStudy": (target) => withStudy(server, target, "run"),
    "robbdd.resumeStudy": (target) => withStudy(server, target, "resume"),
    "robbdd.showStudyResults": (target) => withStudy(server, target, "show"),
    "robbdd.showStudy": (target) => withModel(modelOf(target), (uri) => studies.choose(uri, "factors"), STUDIED),
    "robbdd.showMatrix": (target) => withModel(modelOf(target), (uri) => studies.choose(uri, "matrix"), STUDIED),
    "robbdd.showHistory": (target) => histories.open(target),
    "robbdd.compareRuns": (target) => withModel(target, (uri) => comparisons.choose(uri), RUNNABLE),
    "robbdd.replayTest": (target) => replayTest(replays, tests, target),
    "robbdd.importResults": (target) => tests.importResults(target instanceof vscode.Uri ? target : undefined),
    "robbdd.showReplay": (target) =>
      recordingOf(target) === undefined ? withModel(target, (uri) => replays.choose(uri)) : replays.open(target),
    "robbdd.openReplayLink": (target) => replays.openLink(typeof target === "string" ? target : undefined),
    "robbdd.newProject": () => newProject(server),
    "robbdd.openModel": () => openModel(),
    "robbdd.installServer": () => server.install(),
    "robbdd.restartServer": () => server.restart(),
    "robbdd.showLog": () => {
      log.show();
    },
    "robbdd.reportIssue": () => reportIssue(),
    "robbdd.showRuns": () => {
      runs.show();
    },
    "robbdd.statusActions": () => chooseAction(),
  };
  return Object.entries(handlers).map(([name, handler]) => vscode.commands.registerCommand(name, handler));
}

async function withModel(target: unknown, task: (uri: string) => unknown, languages?: string[]): Promise<void> {
  const uri = await modelFor(target, languages);
  if (uri !== undefined) {
    await task(uri.toString());
  }
}

/** The file of a menu, or the one in the argument of a lens. */
function modelOf(target: unknown): unknown {
  return hasUri(target) ? vscode.Uri.parse(target.uri) : target;
}

async function withStudy(server: Server, target: unknown, action: StudyAction): Promise<void> {
  await withModel(modelOf(target), (uri) => executeStudy(server, vscode.Uri.parse(uri), action), STUDIES);
}

async function runWithOptions(server: Server, chooser: RunOptionsChooser, uri: string): Promise<void> {
  const options = await chooser.choose(vscode.Uri.parse(uri));
  if (options !== undefined) {
    await server.execute("robbdd.run", { uri, ...argumentsOf(options) });
  }
}

async function runUntilFailure(server: Server, replays: ReplayView, uri: string): Promise<void> {
  const options = await askUntilFailure();
  if (options !== undefined) {
    tellFailure(await server.execute("robbdd.run", { uri, ...options }), (failed) => void replays.open({ uri, ...failed }));
  }
}

/** Replay the item of a Testing view menu: a test, or a message with its test. */
async function replayTest(replays: ReplayView, tests: TestingView, target: unknown): Promise<void> {
  const test = isRecord(target) && "test" in target ? target["test"] : target;
  const recording = tests.recording(test as vscode.TestItem);
  if (recording === undefined) {
    inform("A story has no execution of its own: replay one of its scenarios.");
    return;
  }
  await replays.open(recording);
}

async function chooseAction(): Promise<void> {
  const actions = [
    { label: "$(output) Show Log", run: () => void vscode.commands.executeCommand("robbdd.showLog") },
    {
      label: "$(debug-restart) Restart Language Server",
      run: () => void vscode.commands.executeCommand("robbdd.restartServer"),
    },
    {
      label: "$(cloud-download) Install Language Server",
      run: () => void vscode.commands.executeCommand("robbdd.installServer"),
    },
    {
      label: "$(gear) Open Setting robbdd.server.path",
      run: () => {
        openServerSetting();
      },
    },
  ];
  const choice = await vscode.window.showQuickPick(actions, { placeHolder: "RobBDD language server" });
  choice?.run();
}
