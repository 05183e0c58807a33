// Check the page of a panel with axe: the rules of WCAG 2.2 A and AA, and what axe calls best practice.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { ROOT } from "./checkout.mjs";
import { HIGH_CONTRAST, PLAIN, SCHEMES } from "./workbench.mjs";

const SOURCE = join(ROOT, "client-vscode", "node_modules", "axe-core", "axe.min.js");
const GRAVE = new Set(["serious", "critical"]);

/** Rules that are off, each with its reason. */
const OFF = {
  // VS Code's own frame has no title within the frame in which axe runs.
  "frame-title": "the frame is VS Code's",
};

/** Assert that axe finds nothing serious or critical in the page of a panel. */
export async function accessible(page, name) {
  const root = await page.locator("html").elementHandle();
  const frame = await root.ownerFrame();
  if (!(await frame.evaluate(() => "axe" in globalThis))) {
    await frame.evaluate(await readFile(SOURCE, "utf8"));
  }
  const rules = Object.fromEntries(Object.keys(OFF).map((rule) => [rule, { enabled: false }]));
  const { violations, passes } = await frame.evaluate((off) => globalThis.axe.run(document, { rules: off, resultTypes: ["violations", "passes"] }), rules);
  assert.ok(passes.length > 5, `axe found nothing to check in ${name}`);
  const found = violations
    .filter(({ impact }) => GRAVE.has(impact))
    .flatMap(({ id, help, nodes }) => nodes.map(({ html, failureSummary }) => `${id}: ${help}\n  ${html.slice(0, 200)}\n  ${failureSummary}`));
  assert.deepEqual(found, [], `${name} is not accessible:\n${found.join("\n")}`);
}

/** Assert the same in each colour scheme, and take a picture of each; the last scheme remains. */
export async function accessibleInEach(workbench, page, name, schemes = SCHEMES) {
  for (const [scheme, windowClass] of Object.entries(schemes)) {
    await workbench.changeScheme(scheme, schemes);
    await workbench.themed(page, windowClass);
    await workbench.screenshot(`${name}-${scheme}`);
    await accessible(page, `${name} (${windowClass})`);
  }
}

/** Assert the same in each theme of high contrast; the dark one without high contrast remains. */
export async function accessibleInContrast({ server, workbench }, page, name) {
  await server.configure(HIGH_CONTRAST.settings);
  await accessibleInEach(workbench, page, `contrast-axe-${name}`, HIGH_CONTRAST.schemes);
  await server.configure(PLAIN.settings);
  await workbench.changeScheme("dark");
}
