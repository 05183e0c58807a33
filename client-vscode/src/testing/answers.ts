// Answers of the server's commands that run scenarios.
import { isRecord } from "../values";

/** Why nothing was run, if so. */
export function problemOf(answer: unknown): string | undefined {
  const problem = isRecord(answer) ? answer["problem"] : undefined;
  return typeof problem === "string" ? problem : undefined;
}

/** Whether the refusal is unrelated to the scenarios: another run is in progress, or nothing had failed. */
export function isMomentary(answer: unknown): boolean {
  return isRecord(answer) && answer["momentary"] === true;
}

/** Addresses of a run's videos. */
export function picturesOf(answer: unknown): string[] {
  const found: unknown = isRecord(answer) ? answer["pictures"] : undefined;
  return Array.isArray(found) ? found.filter((entry) => typeof entry === "string") : [];
}

/** Address of the folder with a run's recording. */
export function recordedIn(answer: unknown): string | undefined {
  const stored: unknown = isRecord(answer) ? answer["stored"] : undefined;
  const folder = isRecord(stored) ? stored["folder"] : undefined;
  return typeof folder === "string" ? folder : undefined;
}
