// One code-server on loopback with a separate profile and process group.
import { spawn } from "node:child_process";
import { createHash } from "node:crypto";
import { once } from "node:events";
import { createWriteStream, existsSync } from "node:fs";
import { cp, mkdir, readFile, readdir, rename, rm, writeFile } from "node:fs/promises";
import { createServer } from "node:net";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { CACHE, codeServerEntry } from "./checkout.mjs";
import { PATIENCE } from "./patience.mjs";

const STOP_LIMIT = 5_000;
const LOG_OF_EXTENSION = /robbdd-workbench[/\\].*\.log$/;
const LOG_LINES = 30;

const QUIET = {
  "workbench.startupEditor": "none",
  "workbench.enableExperiments": false,
  "workbench.secondarySideBar.defaultVisibility": "hidden",
  "telemetry.telemetryLevel": "off",
  "extensions.autoUpdate": false,
  "extensions.autoCheckUpdates": false,
  "extensions.ignoreRecommendations": true,
  "update.mode": "none",
  "chat.commandCenter.enabled": false,
  "git.enabled": false,
  "files.autoSave": "off",
  "window.menuBarVisibility": "hidden",
  "window.autoDetectColorScheme": true,
  "editor.minimap.enabled": false,
  // Disable automatic edits: the tests type the exact text.
  "editor.autoClosingBrackets": "never",
  "editor.quickSuggestions": { other: "off", comments: "off", strings: "off" },
  "editor.suggestOnTriggerCharacters": false,
  "editor.accessibilitySupport": "off",
  "editor.cursorBlinking": "solid",
};

/**
 * Processes of ours that still run, each with its group. Killed when this process ends in whatever way: the
 * extension host and the language server would outlive the page.
 */
const groups = new Set();
process.on("exit", () => {
  for (const group of groups) {
    signal(group, "SIGKILL");
  }
});
for (const name of ["SIGINT", "SIGTERM"]) {
  process.once(name, () => process.exit(1));
}

export class CodeServer {
  #state;
  #port;
  #settings;
  #process;

  /**
   * @param {object} options
   * @param {string} options.state an empty folder for the profile, the extensions and the log
   * @param {Record<string, unknown>} [options.settings] editor settings on top of the quiet ones
   * @param {string} [options.searchPath] PATH of the server and its extension host
   * @param {boolean} [options.trust] false turns workspace trust on and leaves every workspace untrusted
   */
  constructor({ state, settings = {}, searchPath = process.env.PATH, trust = true }) {
    this.#state = state;
    this.trust = trust;
    this.searchPath = searchPath;
    this.#settings = {
      ...QUIET,
      ...settings,
      "security.workspace.trust.enabled": !trust,
      "security.workspace.trust.startupPrompt": "never",
    };
  }

  get log() {
    return join(this.#state, "server.log");
  }

  /** Install an extension, start the server; resolves when it answers. */
  async start(vsix) {
    await this.#writeProfile();
    await this.#installExtension(vsix);
    const flags = ["--disable-telemetry", "--disable-update-check", "--disable-getting-started-override"];
    if (this.trust) {
      flags.push("--disable-workspace-trust");
    }
    this.#process = this.#spawn([...flags, "--disable-proxy"]);
    await this.#answering();
  }

  /** The address that opens a folder. */
  address(folder) {
    return `http://127.0.0.1:${this.#port}/?folder=${encodeURIComponent(folder)}`;
  }

  /** The last lines of the extension's and its language server's log. */
  async extensionLog() {
    const logs = join(this.#state, "data", "logs");
    const names = (await readdir(logs, { recursive: true })).filter((name) => LOG_OF_EXTENSION.test(name)).sort();
    return (await readFile(join(logs, names.at(-1) ?? ""), "utf8")).split("\n").slice(-LOG_LINES).join("\n");
  }

  /** End the whole process group, kindly first. */
  async stop() {
    const group = this.#process?.pid;
    if (group === undefined || !groups.has(group)) {
      return;
    }
    signal(group, "SIGTERM");
    const limit = Date.now() + STOP_LIMIT;
    while (signal(group, 0) && Date.now() < limit) {
      await sleep(50);
    }
    signal(group, "SIGKILL");
    groups.delete(group);
  }

  /** Change settings; the window follows as soon as it notices. */
  async configure(settings) {
    Object.assign(this.#settings, settings);
    const text = JSON.stringify(this.#settings, undefined, 2);
    // An extension may ask for its settings before the browser has sent the user's: the machine's are there at once.
    for (const place of ["Machine", "User"]) {
      await writeFile(join(this.#state, "data", place, "settings.json"), text);
    }
  }

  async #writeProfile() {
    this.#port = await freePort();
    for (const folder of ["home", "data/User", "data/Machine", "extensions"]) {
      await mkdir(join(this.#state, folder), { recursive: true });
    }
    await this.configure({});
    const config = `bind-addr: 127.0.0.1:${this.#port}\nauth: none\ncert: false\n`;
    await writeFile(join(this.#state, "config.yaml"), config);
  }

  /** Install an extension. Sessions copy one installation: each of them would take seconds. */
  async #installExtension(vsix) {
    const digest = createHash("sha256").update(await readFile(vsix)).digest("hex").slice(0, 16);
    const installed = join(CACHE, `extensions-${digest}`);
    const own = join(this.#state, "extensions");
    if (existsSync(installed)) {
      await cp(installed, own, { recursive: true });
      return;
    }
    const install = this.#spawn(["--install-extension", vsix]);
    const [code] = await once(install, "exit");
    groups.delete(install.pid);
    if (code !== 0) {
      throw new Error(`${vsix} could not be installed:\n${await readFile(this.log, "utf8")}`);
    }
    const copied = `${installed}-${process.pid}`;
    await cp(own, copied, { recursive: true });
    try {
      await rename(copied, installed);
    } catch (error) {
      // Another process has installed it at the same time.
      if (!existsSync(installed)) {
        throw error;
      }
      await rm(copied, { recursive: true });
    }
  }

  #spawn(args) {
    const place = (name) => join(this.#state, name);
    const child = spawn(
      process.execPath,
      [
        ...[codeServerEntry(), "--config", place("config.yaml")],
        ...["--user-data-dir", place("data"), "--extensions-dir", place("extensions"), ...args],
      ],
      { detached: true, stdio: ["ignore", "pipe", "pipe"], env: this.#environment() },
    );
    groups.add(child.pid);
    const log = createWriteStream(this.log, { flags: "a" });
    child.stdout.pipe(log, { end: false });
    child.stderr.pipe(log, { end: false });
    return child;
  }

  /** Only the listed variables of the user's environment, and no extension gallery. */
  #environment() {
    const home = join(this.#state, "home");
    return {
      PATH: this.searchPath,
      LANG: "C.UTF-8",
      HOME: home,
      XDG_CONFIG_HOME: join(home, ".config"),
      XDG_DATA_HOME: join(home, ".local/share"),
      XDG_CACHE_HOME: join(home, ".cache"),
      XDG_RUNTIME_DIR: home,
      EXTENSIONS_GALLERY: JSON.stringify({ serviceUrl: "http://127.0.0.1:9/", itemUrl: "http://127.0.0.1:9/" }),
    };
  }

  async #answering() {
    const limit = Date.now() + PATIENCE;
    while (this.#process.exitCode === null && Date.now() < limit) {
      try {
        const response = await fetch(`http://127.0.0.1:${this.#port}/healthz`);
        if (response.ok) {
          return;
        }
      } catch {
        // Not listening yet.
      }
      await sleep(100);
    }
    const log = await readFile(this.log, "utf8");
    await this.stop();
    throw new Error(`code-server did not start:\n${log}`);
  }
}

/** Signal a whole process group; false when nothing of it is left. */
function signal(group, name) {
  try {
    process.kill(-group, name);
    return true;
  } catch {
    return false;
  }
}

async function freePort() {
  const probe = createServer().listen(0, "127.0.0.1");
  await once(probe, "listening");
  const { port } = probe.address();
  probe.close();
  await once(probe, "close");
  return port;
}
