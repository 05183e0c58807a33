// The scene of a `.scenex` next to its text, in 3D: it follows edits, and its faults lead to the text.
import * as vscode from "vscode";
import { LANGUAGES, type Server } from "../../client";
import { isRecord } from "../../values";
import { Panel, beside } from "../panel";
import { reveal } from "../reveal";
import { type ScenePicture, isScenePicture, remark } from "./answer";
import type { ToScene } from "./messages";

const TYPE = "robbdd.scene";
/** Milliseconds without an edit before a scene is drawn again. */
const PAUSE = 300;

export class SceneView implements vscode.Disposable {
  /** By the URI of the file. */
  private readonly scenes = new Map<string, ScenePanel>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: Server,
    private readonly extension: vscode.Uri,
  ) {
    this.subscriptions = [
      vscode.window.registerWebviewPanelSerializer(TYPE, {
        deserializeWebviewPanel: async (view, state: unknown) => {
          await server.begin();
          this.restore(view, state);
        },
      }),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (LANGUAGES.includes(document.languageId)) {
          this.refreshSoon();
        }
      }),
      // Models are read from the disk.
      vscode.workspace.onDidSaveTextDocument(() => {
        this.refreshSoon();
      }),
    ];
  }

  /** Show the scene of a file next to it. */
  open(file: vscode.Uri): void {
    const uri = file.toString();
    const open = this.scenes.get(uri);
    if (open === undefined) {
      this.adopt(beside(TYPE, `Scene ${file.path.replace(/^.*\//, "")}`), uri);
    } else {
      open.panel.view.reveal(undefined, true);
    }
  }

  /** Draw all scenes again, because a text or the server has changed. */
  refreshSoon(): void {
    for (const scene of this.scenes.values()) {
      scene.loadSoon();
    }
  }

  dispose(): void {
    for (const part of [...this.subscriptions, ...[...this.scenes.values()].map(({ panel }) => panel)]) {
      part.dispose();
    }
  }

  private restore(view: vscode.WebviewPanel, state: unknown): void {
    if (isRecord(state) && typeof state["uri"] === "string" && !this.scenes.has(state["uri"])) {
      this.adopt(view, state["uri"]);
    } else {
      view.dispose();
    }
  }

  private adopt(view: vscode.WebviewPanel, uri: string): void {
    const scene = new ScenePanel(view, this.extension, this.server, uri);
    this.scenes.set(uri, scene);
    view.onDidDispose(() => {
      scene.stop();
      this.scenes.delete(uri);
    });
  }
}

/** One panel with the scenes of one file. */
class ScenePanel {
  readonly panel: Panel<ToScene>;
  private picture: ScenePicture | undefined;
  private timer: NodeJS.Timeout | undefined;
  /** One request at a time: drawing takes seconds. */
  private loading = false;
  private outdated = false;

  constructor(
    view: vscode.WebviewPanel,
    extension: vscode.Uri,
    private readonly server: Server,
    private readonly uri: string,
  ) {
    this.panel = new Panel(
      view,
      extension,
      "scene",
      () => {
        this.post();
        void this.load();
      },
      ({ scene, fault }) => {
        this.show(scene, fault);
      },
    );
  }

  loadSoon(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.load(), PAUSE);
  }

  stop(): void {
    clearTimeout(this.timer);
  }

  private async load(): Promise<void> {
    if (this.loading) {
      this.outdated = true;
      return;
    }
    this.loading = true;
    try {
      const answer = await this.server.request("robbdd/scene", { uri: this.uri });
      if (isScenePicture(answer)) {
        this.picture = answer;
        this.post();
      }
    } finally {
      this.loading = false;
    }
    if (this.outdated) {
      this.outdated = false;
      this.loadSoon();
    }
  }

  private post(): void {
    if (this.picture !== undefined) {
      this.panel.post({ type: "scenes", uri: this.uri, scenes: this.picture.scenes, remark: remark(this.picture) });
    }
  }

  private show(scene: unknown, fault: unknown): void {
    const known = typeof scene === "number" ? this.picture?.scenes[scene]?.faults : undefined;
    const source = typeof fault === "number" ? known?.[fault]?.source : undefined;
    if (source !== null && source !== undefined) {
      void reveal(source.uri, source.range, this.panel.view.viewColumn);
    }
  }
}
