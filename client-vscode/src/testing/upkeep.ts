// Keep the test tree up to date with edits and with saved, created, moved and deleted files.
import * as vscode from "vscode";
import type { TestTree } from "./tree";

/** Languages and file endings of files with tests. */
const LANGUAGES = ["robbdd", "robbdd-bddx"];
const ENDINGS = [".bdd", ".bddx"];
const FILES = "**/*.{bdd,scene,scenex,ktree,bddx}";
/** Milliseconds without a keystroke before the tree is updated. */
const PAUSE = 400;

export class Upkeep implements vscode.Disposable {
  private readonly timers = new Map<string, NodeJS.Timeout>();
  private readonly listeners: readonly vscode.Disposable[];
  private watcher: vscode.FileSystemWatcher | undefined;

  /** `onShown` is called when the tests of a visible file have been listed. */
  constructor(
    private readonly tree: TestTree<vscode.TestItem>,
    private readonly onShown: () => Promise<void>,
  ) {
    this.listeners = [
      vscode.window.onDidChangeVisibleTextEditors(() => void this.showVisible()),
      vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
        if (contentChanges.length > 0) {
          this.followSoon(document.uri.toString());
        }
      }),
    ];
  }

  /** Whether the tree has found all files of the workspace, and so must follow them: after it was first opened. */
  get watches(): boolean {
    return this.watcher !== undefined;
  }

  watch(): void {
    if (this.watcher !== undefined) {
      return;
    }
    this.watcher = vscode.workspace.createFileSystemWatcher(FILES);
    const follow = (file: vscode.Uri) => {
      this.followSoon(file.toString());
    };
    this.watcher.onDidCreate(follow);
    this.watcher.onDidChange(follow);
    this.watcher.onDidDelete((file) => {
      this.tree.forget(file.toString());
      follow(file);
    });
  }

  /** Find all tests of the workspace, and follow new ones from now on. */
  async discover(): Promise<void> {
    this.watch();
    await this.tree.discover();
  }

  /** List the tests of visible files, so that they have icons. */
  async showVisible(again = false): Promise<void> {
    for (const uri of shownFiles()) {
      if (again || !this.tree.knows(uri)) {
        await this.tree.load(uri);
        await this.tree.expandSmall(uri);
        await this.onShown();
      }
    }
  }

  /** Reload the tests that depend on a changed file. */
  async follow(uri: string): Promise<void> {
    const shown = shownFiles();
    const affected = new Set(this.tree.dependents(uri));
    if (ENDINGS.some((ending) => uri.endsWith(ending)) && (this.watches || shown.includes(uri)) && (await exists(uri))) {
      affected.add(uri);
    }
    for (const file of affected) {
      await this.tree.load(file);
      if (shown.includes(file)) {
        await this.tree.expandSmall(file);
      }
    }
  }

  dispose(): void {
    for (const timer of this.timers.values()) {
      clearTimeout(timer);
    }
    this.watcher?.dispose();
    for (const listener of this.listeners) {
      listener.dispose();
    }
  }

  private followSoon(uri: string): void {
    clearTimeout(this.timers.get(uri));
    this.timers.set(
      uri,
      setTimeout(() => {
        this.timers.delete(uri);
        void this.follow(uri);
      }, PAUSE),
    );
  }
}

function shownFiles(): string[] {
  const documents = vscode.window.visibleTextEditors.map(({ document }) => document);
  return documents.filter(({ languageId }) => LANGUAGES.includes(languageId)).map(({ uri }) => uri.toString());
}

async function exists(uri: string): Promise<boolean> {
  return vscode.workspace.fs.stat(vscode.Uri.parse(uri)).then(
    () => true,
    () => false,
  );
}
