// The first minute on a machine without a language server: the extension offers to install one, does so, and checks.
import { execFile } from "node:child_process";
import { mkdtemp, readdir, rename, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, delimiter, dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { EXAMPLES, LANGUAGE_SERVER, ROOT, required } from "./harness/checkout.mjs";
import { LONG } from "./harness/patience.mjs";
import { Session } from "./harness/session.mjs";

let folder;
let wheel;
/** Where the setting says that it is, which is true only after the first attempt. */
let place;
/** @type {Session} */
let session;
let passed = false;

before(async () => {
  folder = await mkdtemp(join(tmpdir(), "robbdd-first-minute-"));
  wheel = await buildWheel();
  place = join(folder, basename(wheel));
  session = await Session.open({
    workspace: EXAMPLES,
    searchPath: ["/usr/bin", "/bin", dirname(process.execPath)].join(delimiter),
    settings: { "robbdd.server.package": place },
  });
});

after(async () => {
  await session?.close(passed ? undefined : "first-minute-failed");
  await rm(folder, { recursive: true, force: true });
});

test("a button installs a missing server, which checks open files", async () => {
  const { workbench } = session;
  await workbench.openFile("pickplace/pickplace.bdd");
  const offer = await workbench.notification("It can be installed");
  await workbench.screenshot("first-minute-offer");
  await offer.getByRole("button", { name: "Install" }).click();

  const problem = await workbench.notification("No such file or directory");
  await rename(wheel, place);
  await workbench.screenshot("first-minute-problem");
  const progress = workbench.said(/Installing the RobBDD language server.*(Collecting|Downloading)/);
  await problem.getByRole("button", { name: "Retry" }).click();
  await progress;
  await workbench.screenshot("first-minute-progress");
  await workbench.statusText(/RobBDD/);
  await workbench.codeLens("Run").first().waitFor({ timeout: LONG });
  await workbench.waitForNoError();

  await workbench.goTo(1, 1);
  await workbench.type("import 'no-such.scene' ");
  await workbench.waitForError();
  await (await workbench.problem("no-such.scene")).first().waitFor();
  await workbench.screenshot("first-minute-checked");
  passed = true;
});

/** The distribution of this checkout, as its users would get it. */
async function buildWheel() {
  const python = required(join(dirname(LANGUAGE_SERVER), "python"), "make setup");
  const built = join(folder, "built");
  await promisify(execFile)(python, ["-m", "build", "--wheel", "--outdir", built, ROOT]);
  const [name] = await readdir(built);
  return join(built, name);
}
