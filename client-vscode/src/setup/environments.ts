// Private environments of the server: folders in the extension's own storage, named after the creating process. An
// environment is valid once its record is written, so an interrupted installation is never used.
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, renameSync, rmSync, statSync, writeFileSync } from "node:fs";
import { rm } from "node:fs/promises";
import { basename, join } from "node:path";
import { brotliDecompressSync } from "node:zlib";
import { isRecord } from "../values";

const PREFIX = "server-";
const RECORD = "robbdd.json";
/** The end of the name of a wheel that the extension bundles. */
const COMPRESSED = ".whl.br";
/** The latest one and its predecessor, which another window may still run. */
const KEPT = 2;

export interface PrivateServer {
  /** Path of the program. */
  readonly command: string;
  /** The name of the installed package. */
  readonly package: string;
}

interface Installed extends PrivateServer {
  readonly folder: string;
  /** ms since the epoch. */
  readonly time: number;
}

/** The compressed wheel of a version in a folder; undefined if the extension was packed without it. */
export function bundledWheel(folder: string, version: string): string | undefined {
  try {
    const name = readdirSync(folder).find((file) => file.startsWith(`robbdd_tools-${version}-`) && file.endsWith(COMPRESSED));
    return name && join(folder, name);
  } catch {
    return undefined;
  }
}

/** Decompress a bundled wheel into the extension's storage; return its path. Throws if this is impossible. */
export function unpackedWheel(bundled: string, storage: string): string {
  const folder = join(storage, "wheel");
  mkdirSync(folder, { recursive: true });
  const wheel = join(folder, basename(bundled, ".br"));
  // Another window may install it at the same time.
  const written = `${wheel}-${process.pid}`;
  writeFileSync(written, brotliDecompressSync(readFileSync(bundled)));
  renameSync(written, wheel);
  return wheel;
}

/**
 * Create the server's empty working folder. The editor's own working directory is often the opened folder, where Python
 * would search for modules.
 */
export function workingFolder(storage: string): string {
  const folder = join(storage, "work");
  mkdirSync(folder, { recursive: true });
  return folder;
}

/** Create a new folder for an environment. */
export function freshFolder(storage: string): string {
  mkdirSync(storage, { recursive: true });
  return mkdtempSync(join(storage, `${PREFIX}${process.pid}-`));
}

/** Record that the environment in a folder is complete, and delete unused ones. */
export function recordInstalled(storage: string, folder: string, server: PrivateServer): void {
  writeFileSync(join(folder, RECORD), `${JSON.stringify(server)}\n`);
  for (const old of installedIn(storage).slice(KEPT)) {
    discard(old.folder);
  }
}

/** The server to use: the latest installed under this name, else the latest of all. */
export function installedServer(storage: string, wanted: string): PrivateServer | undefined {
  const all = installedIn(storage);
  const best = all.find((one) => one.package === wanted) ?? all[0];
  return best && { command: best.command, package: best.package };
}

/**
 * Delete an environment as far as possible: Windows keeps programs that another window still runs. The record is
 * deleted first, so that an incomplete environment is never used.
 */
export function discard(folder: string): void {
  try {
    rmSync(join(folder, RECORD), { force: true });
    rmSync(folder, { recursive: true, force: true, maxRetries: 3 });
  } catch {
    // A failed deletion of an old environment does not fail the installation.
  }
}

/** Delete remains of interrupted installations: folders without a record whose process is gone. */
export async function discardAbandoned(storage: string): Promise<void> {
  const abandoned = environmentsIn(storage).filter((folder) => !existsSync(join(folder, RECORD)) && !isBeingMade(folder));
  for (const folder of abandoned) {
    // The next start tries again.
    await rm(folder, { recursive: true, force: true, maxRetries: 3 }).catch(() => undefined);
  }
}

/** Whether the process that creates an environment is alive, in this window or another one. */
function isBeingMade(folder: string): boolean {
  const maker = Number.parseInt(basename(folder).slice(PREFIX.length));
  try {
    return maker > 0 && process.kill(maker, 0);
  } catch (error) {
    return isRecord(error) && error["code"] === "EPERM";
  }
}

/** The complete ones, latest first. */
function installedIn(storage: string): Installed[] {
  return environmentsIn(storage)
    .flatMap(read)
    .sort((one, other) => other.time - one.time);
}

function environmentsIn(storage: string): string[] {
  try {
    return readdirSync(storage)
      .filter((name) => name.startsWith(PREFIX))
      .map((name) => join(storage, name));
  } catch {
    return [];
  }
}

function read(folder: string): Installed[] {
  const path = join(folder, RECORD);
  try {
    const record: unknown = JSON.parse(readFileSync(path, "utf8"));
    const time = statSync(path).mtimeMs;
    return isRecord(record) && typeof record["command"] === "string" && typeof record["package"] === "string"
      ? [{ folder, time, command: record["command"], package: record["package"] }]
      : [];
  } catch {
    return [];
  }
}
