// A whole session: a copy of a workspace, a code-server on it, a browser that shows it; all of it gone at the end.
import assert from "node:assert/strict";
import { cp, mkdir, mkdtemp, readFile, readdir, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { CHROMIUM, SCREENSHOTS, SLOWDOWN, VSIX, playwright, required } from "./checkout.mjs";
import { CodeServer } from "./codeServer.mjs";
import { LONG, PATIENCE, eventually } from "./patience.mjs";
import { Workbench } from "./workbench.mjs";

const LOOPBACK = new Set(["127.0.0.1", "localhost", "[::1]"]);

const CHROMIUM_FLAGS = [
  "--no-sandbox", // tests run as root in containers
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  // A window lives too short for optimized code to pay off.
  "--js-flags=--no-opt --no-maglev",
  // Below the reach of page routes too (service workers, web views): no name but loopback resolves.
  "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1 , EXCLUDE localhost",
];

/** Three dimensions without a graphics card, or none at all. */
const WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-compositing", "--disable-gpu-rasterization"];
const NO_WEBGL = ["--disable-gpu", "--disable-3d-apis"];

export class Session {
  #folder;
  #browser;
  #page;

  /**
   * Open a workspace in the workbench.
   *
   * @param {object} options
   * @param {string} options.workspace folder to work on a copy of
   * @param {Record<string, unknown>} [options.settings] editor settings
   * @param {string} [options.searchPath] PATH of the extension host
   * @param {boolean} [options.trust] false leaves the workspace untrusted
   * @param {boolean} [options.webgl] whether pages can draw in three dimensions
   * @param {(workspace: string) => Promise<void>} [options.prepare] changes the copy before it is opened
   */
  static async open({ workspace, prepare = async () => {}, webgl = false, ...options }) {
    const session = new Session();
    try {
      await session.#open(workspace, prepare, webgl ? WEBGL : NO_WEBGL, options);
      return session;
    } catch (error) {
      await session.close("could-not-open");
      throw error;
    }
  }

  /**
   * Begin anew in the same window: no editor is open, and the workspace is as it was at first.
   *
   * @param {string} workspace folder of which it is a copy
   * @param {(workspace: string) => Promise<void>} [prepare] changes the copy
   */
  async renew(workspace, prepare = async () => {}) {
    await this.workbench.tidy();
    await mirror(workspace, this.workspace);
    await prepare(this.workspace);
  }

  async #open(workspace, prepare, graphics, options) {
    this.#folder = await mkdtemp(join(tmpdir(), "robbdd-workbench-"));
    this.workspace = join(this.#folder, "workspace");
    await cp(workspace, this.workspace, { recursive: true });
    await prepare(this.workspace);
    const state = join(this.#folder, "state");
    await mkdir(state);
    this.server = new CodeServer({ state, ...options });
    await this.server.start(required(VSIX, "run npm run package in client-vscode"));
    this.#browser = await playwright().chromium.launch({
      executablePath: CHROMIUM,
      args: [...CHROMIUM_FLAGS, ...graphics],
      timeout: PATIENCE,
    });
    const context = await this.#browser.newContext({ viewport: { width: 1360, height: 1040 } });
    await context.route(
      (url) => !LOOPBACK.has(url.hostname) && url.protocol.startsWith("http"),
      (route) => route.abort("blockedbyclient"),
    );
    this.#page = await context.newPage();
    const devtools = await context.newCDPSession(this.#page);
    await devtools.send("Emulation.setCPUThrottlingRate", { rate: SLOWDOWN });
    this.workbench = await Workbench.open(this.#page, this.server.address(this.workspace));
  }

  /** The text of a file of the workspace as it is on disk. */
  text(path) {
    return readFile(join(this.workspace, path), "utf8");
  }

  /** Line and column, from 1, of a text in a file on disk: in the first line that has it, and the other words too. */
  async placeOf(path, text, beside = "") {
    const lines = (await this.text(path)).split("\n");
    const line = lines.findIndex((entry) => entry.includes(text) && entry.includes(beside));
    assert.ok(line >= 0, `${path} has no line with ${text} and ${beside}`);
    return { line: line + 1, column: lines[line].indexOf(text) + 1 };
  }

  /** The results of all runs that the workspace's store holds and that have ended, oldest first. */
  async runs() {
    const store = join(this.workspace, ".robbdd", "runs");
    const numbers = (await readdir(store).catch(() => [])).map(Number).filter((number) => number > 0);
    const texts = numbers.sort((one, other) => one - other).map((number) => {
      return readFile(join(store, String(number), "results.json"), "utf8").catch(() => undefined);
    });
    return (await Promise.all(texts)).filter((text) => text !== undefined).map((text) => JSON.parse(text));
  }

  /** Do what begins a run, wait until it has ended, and return its results. A short run leaves no other lasting sign. */
  async runOf(action) {
    const { length } = await this.runs();
    await action();
    return eventually(async () => {
      const ended = await this.runs();
      assert.ok(ended.length > length, "no run has ended");
      return ended.at(-1);
    }, LONG);
  }

  /** Close everything. With the name of a failure, a last picture and the server's log are kept, and the window's text is printed. */
  async close(failure) {
    if (failure !== undefined) {
      await mkdir(SCREENSHOTS, { recursive: true });
      await this.#page?.screenshot({ path: join(SCREENSHOTS, `${failure}.png`) }).catch(() => {});
      await cp(this.server?.log ?? "", join(SCREENSHOTS, `${failure}.log`)).catch(() => {});
      // A machine that only runs the tests keeps no pictures.
      console.log(`${failure}: the window reads\n${await this.workbench?.text().catch(String)}`);
      console.log(`${failure}: the log of the extension ends\n${await this.server?.extensionLog().catch(String)}`);
    }
    await this.#browser?.close();
    await this.server?.stop();
    if (this.#folder !== undefined) {
      await rm(this.#folder, { recursive: true, force: true, maxRetries: 5 });
    }
  }
}

/** Make a folder equal to another one. Equal files are not written: watchers would report them long afterwards. */
async function mirror(from, to) {
  const wanted = new Map((await readdir(from, { withFileTypes: true })).map((entry) => [entry.name, entry]));
  for (const entry of await readdir(to, { withFileTypes: true })) {
    if (wanted.get(entry.name)?.isDirectory() !== entry.isDirectory()) {
      await rm(join(to, entry.name), { recursive: true, maxRetries: 5 });
    }
  }
  for (const [name, entry] of wanted) {
    const [source, copy] = [join(from, name), join(to, name)];
    if (entry.isDirectory()) {
      await mkdir(copy, { recursive: true });
      await mirror(source, copy);
    } else {
      const before = await readFile(copy).catch(() => undefined);
      if (before === undefined || !before.equals(await readFile(source))) {
        await cp(source, copy);
      }
    }
  }
}
