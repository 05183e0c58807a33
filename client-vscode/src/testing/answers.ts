// What the server's commands that run scenarios answer.
import { isRecord } from "../values";

/** Why nothing was run, where that is so. */
export function problemOf(answer: unknown): string | undefined {
  const problem = isRecord(answer) ? answer["problem"] : undefined;
  return typeof problem === "string" ? problem : undefined;
}

/** Whether that says nothing of the scenarios: another run is in progress, or nothing had failed. */
export function isMomentary(answer: unknown): boolean {
  return isRecord(answer) && answer["momentary"] === true;
}

/** Addresses of the moving pictures that were made of a run. */
export function picturesOf(answer: unknown): string[] {
  const found: unknown = isRecord(answer) ? answer["pictures"] : undefined;
  return Array.isArray(found) ? found.filter((entry) => typeof entry === "string") : [];
}

/** Address of the folder that keeps what was recorded of a run. */
export function recordedIn(answer: unknown): string | undefined {
  const stored: unknown = isRecord(answer) ? answer["stored"] : undefined;
  const folder = isRecord(stored) ? stored["folder"] : undefined;
  return typeof folder === "string" ? folder : undefined;
}
