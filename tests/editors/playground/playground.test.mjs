// The playground of the documentation, driven in a browser as it is served: by files alone, without any other host.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { after, before, test } from "node:test";
import { accessible } from "../workbench/harness/axe.mjs";
import { CHROMIUM, ROOT, SCREENSHOTS, playwright, required } from "../workbench/harness/checkout.mjs";
import { LONG, PATIENCE } from "../workbench/harness/patience.mjs";

const FOLDER = join(ROOT, "build/extra/playground");
const WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".mjs": "text/javascript", ".wasm": "application/wasm" };

let server;
let browser;
/** @type {import("playwright-core").Page} */
let page;
const elsewhere = [];

before(async () => {
  required(join(FOLDER, "core.zip"), "make playground");
  server = createServer(async ({ url }, answer) => {
    const path = normalize(new URL(url, "http://localhost").pathname);
    const content = await readFile(join(FOLDER, path)).catch(() => undefined);
    answer.writeHead(content === undefined ? 404 : 200, { "content-type": TYPES[extname(path)] ?? "application/octet-stream" });
    answer.end(content);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  browser = await playwright().chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", ...WEBGL], timeout: PATIENCE });
  page = await browser.newPage({ viewport: { width: 1300, height: 1500 } });
  page.setDefaultTimeout(PATIENCE);
  await page.route(
    (url) => url.hostname !== "127.0.0.1",
    (route) => {
      elsewhere.push(route.request().url());
      return route.abort();
    },
  );
});

after(async () => {
  await page?.screenshot({ path: join(SCREENSHOTS, "playground-last.png") });
  await browser?.close();
  server?.close();
});

test("the example is opened in its colours and without a finding", async (context) => {
  const start = Date.now();
  await page.goto(`http://127.0.0.1:${server.address().port}/index.html`);
  await page.locator(".cm-line .word-keyword", { hasText: "import" }).waitFor({ timeout: LONG });
  await state("ready");
  context.diagnostic(`first findings after ${Date.now() - start} ms`);
  assert.equal(await page.locator("#count").textContent(), "0");
});

test("Gherkin and graph are those of the model", async () => {
  await show("Gherkin");
  await page.locator("#gherkin", { hasText: 'Given "env:cube0" is located at "env:table_ws"' }).waitFor();
  await show("Graph");
  await page.locator("#graph", { hasText: "bdd:ScenarioTemplate" }).waitFor();
  await show("Problems");
});

test("the graph is drawn", async () => {
  await show("Picture");
  await page.locator("#picture svg", { hasText: "tidy-bench" }).waitFor();
  await show("Problems");
});

test("a recorded execution is replayed in three dimensions", async () => {
  await show("Replay");
  const frame = page.frameLocator("#replay iframe");
  await frame.locator(".stage canvas").waitFor({ timeout: LONG });
  await frame.locator(".label", { hasText: "cube0" }).waitFor();
  const style = () => frame.locator(".label", { hasText: "cube0" }).getAttribute("style");
  const before = await style();
  await frame.getByRole("slider", { name: "Time" }).press("End");
  await frame.locator(".readout", { hasText: "10.27 / 10.27 s" }).waitFor();
  for (const end = Date.now() + LONG; (await style()) === before; ) {
    assert.ok(Date.now() < end, "the name of the cube has not moved with it");
    await page.waitForTimeout(50);
  }
  await page.screenshot({ path: join(SCREENSHOTS, "playground-replay.png") });
  await accessible(frame, "the replay of the playground");
});

test("a clause of the replay leads to its text", async () => {
  const frame = page.frameLocator("#replay iframe");
  await frame.getByRole("button", { name: "Go to the text of in-hand" }).click();
  await page.waitForFunction(() => getSelection().toString() === "in-hand");
});

test("the violated moment of another example is shown, and the lack of a recording is stated", async () => {
  await page.getByLabel("Example").selectOption("deadlines");
  const frame = page.frameLocator("#replay iframe");
  await frame.locator(".title", { hasText: "two-limits 2" }).waitFor({ timeout: LONG });
  await frame.locator(".readout", { hasText: /^5\.\d\d / }).waitFor();
  await page.getByLabel("Example").selectOption("limits");
  await page.getByText("No execution of limits is recorded here").waitFor();
  await page.getByLabel("Example").selectOption("pickplace");
  await show("Problems");
  await state("ready");
});

test("a mistake is underlined and listed, and its quick fix corrects it", async (context) => {
  await page.locator(".cm-line", { hasText: "at-goal:" }).click();
  await page.keyboard.press("End");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("ArrowLeft");
  const start = Date.now();
  await page.keyboard.type("s");
  await mistake().waitFor();
  context.diagnostic(`findings ${Date.now() - start} ms after a key`);
  await page.locator(".cm-lintRange-error").first().waitFor();
  await page.screenshot({ path: join(SCREENSHOTS, "playground-problem.png") });
  await page.keyboard.press("Escape");
  await page.locator(".cm-lintRange-error").first().hover();
  await page.getByRole("button", { name: "Change to 'evt-place-end'" }).click();
  await mistake().waitFor({ state: "detached" });
  await state("ready");
});

test("a description remains open while the model is validated", async () => {
  await state("ready");
  await page.clock.install();
  await page.clock.pauseAt(Date.now() + 60_000);
  await page.keyboard.type("s");
  await mistake().waitFor();
  await page.locator(".cm-lintRange-error").first().hover();
  await page.clock.runFor(350);
  const fix = page.getByRole("button", { name: "Change to 'evt-place-end'" });
  await fix.waitFor();
  await page.clock.runFor(1000);
  await state("Gherkin and graph are those before the errors");
  await page.clock.resume();
  assert.ok(await fix.isVisible());
  await fix.click();
  await mistake().waitFor({ state: "detached" });
});

test("after a bracket, names of the right kind are offered", async () => {
  await page.locator(".cm-line", { hasText: "at-goal:" }).click();
  await page.keyboard.press("End");
  for (let presses = 0; presses < "evt-place-end>)".length; presses += 1) {
    await page.keyboard.press("ArrowLeft");
  }
  await page.keyboard.press("Control+Space");
  await page.locator(".cm-completionLabel", { hasText: "evt-pick-start" }).waitFor();
  const labels = await page.locator(".cm-completionLabel").allTextContents();
  assert.deepEqual(labels.filter((label) => !label.startsWith("evt-")), []);
  await page.keyboard.press("Escape");
});

test("hovering over a name describes it", async () => {
  await page.locator(".cm-line", { hasText: "at-goal:" }).locator(".word-variable", { hasText: "goal" }).hover();
  await page.locator(".description", { hasText: "workspace" }).waitFor();
});

test("a violated shape is found", async () => {
  await page.getByRole("tab", { name: "bench.scene" }).click();
  await page.locator(".cm-line", { hasText: "comp (ns=env)" }).first().waitFor();
  await page.getByRole("tab", { name: "pickplace.bdd" }).click();
  const row = page.locator(".cm-line", { hasText: "var <pick-place.thing>" });
  await row.click();
  await page.keyboard.press("End");
  await page.keyboard.press("Shift+Home");
  await page.keyboard.type("var <pick-place.thing>: { <places.left_ws> }");
  await page.locator("#problems .error", { hasText: "[shacl-" }).first().waitFor({ timeout: LONG });
});

test("axe finds no barrier, and nothing was asked of another host", async () => {
  await accessible(page, "the playground");
  assert.deepEqual(elsewhere, []);
});

function state(text) {
  return page.locator("#state", { hasText: text }).waitFor({ timeout: LONG });
}

function mistake() {
  return page.locator("#problems .error", { hasText: "33: there is no event 'evt-place-ends'; did you mean 'evt-place-end'? [unknown-name]" });
}

function show(view) {
  return page.getByRole("tab", { name: view }).click();
}
