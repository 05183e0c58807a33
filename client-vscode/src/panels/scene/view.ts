// The scene of a `.scenex` next to its text, in 3D: it follows edits, and its faults lead to the text.
import * as vscode from "vscode";
import type { Server } from "../../client";
import { type FilePanel, FilePanels } from "../filePanels";
import { Panel } from "../panel";
import { reveal } from "../reveal";
import { type ScenePicture, isScenePicture, remark } from "./answer";
import type { ToScene } from "./messages";

/** Milliseconds without an edit before a scene is drawn again. */
const PAUSE = 300;
/** Endings of files that describe robots and objects. */
const DESCRIPTION = /\.(xml|mjcf|urdf|srdf)$/i;

export class SceneView extends FilePanels<ScenePanel> {
  constructor(server: Server, extension: vscode.Uri) {
    super(server, "robbdd.scene", "Scene", (view, uri) => new ScenePanel(view, extension, server, uri));
    this.subscriptions.push(
      // Meshes are read from the disk; descriptions of robots as they are edited.
      vscode.workspace.onDidSaveTextDocument(() => {
        this.refreshSoon();
      }),
      vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (DESCRIPTION.test(document.uri.path)) {
          this.refreshSoon();
        }
      }),
    );
  }
}

/** One panel with the scenes of one file. */
class ScenePanel implements FilePanel {
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
