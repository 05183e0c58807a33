// The server's messages about a run, as sent in the notification `robbdd/runMessage`; docs/schemas/runmessage.schema.json.
import type * as answers from "../answers/runmessage";
import type { Immutable } from "../immutable";

export { isRunNotification } from "../answers/validators.mjs";

export type RunNotification = Immutable<answers.RunNotification>;
export type RunMessage = RunNotification["message"];
export type ScenarioStarted = Immutable<answers.ScenarioStarted>;
export type ClauseStarted = Immutable<answers.ClauseStarted>;
export type ClauseJudged = Immutable<answers.ClauseJudged>;
/** The clause that another clause is unknown because of. */
export type Because = Immutable<answers.Because>;
export type UserCodeFailed = Immutable<answers.UserCodeFailed>;
