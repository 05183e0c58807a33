// The verdicts among the server's hints and lenses, as marks in the text.
import type * as vscode from "vscode";
import type { VerdictData } from "../answers/verdictdata";
import type { VerdictHints } from "../answers/verdicts";
import { isVerdictData } from "../answers/validators.mjs";
import type { Immutable } from "../immutable";

/** Data that determine the colour of a result. */
export type Appearance = Immutable<Required<VerdictData>>;

/** Text before or after a place of a document, with its tooltip. */
export interface Mark extends Appearance {
  readonly words: string;
  readonly line: number;
  readonly character: number;
  readonly side: "before" | "after";
  readonly tooltip: string;
}

/** Columns of a line beside which there is room for the words of another line in a window of usual size (1,360 px). */
const LONG_LINE = 60;

/** Characters of a reason before a clause: the clause has to stay in sight, too. */
const REASON = 72;

/** Columns of a line after which the first words of a verdict are out of sight in such a window. */
const WIDE_LINE = 95;

type Text = Pick<vscode.TextDocument, "lineAt" | "lineCount">;

type Hint = Immutable<VerdictHints[number]>;

/** The appearance of a hint or a lens of the server; undefined if it has no verdict. */
export function appearanceOf(shown: object): Appearance | undefined {
  const data: unknown = "data" in shown ? shown.data : undefined;
  return isVerdictData(data) ? { rejudged: false, consequence: false, reason: "", ...data } : undefined;
}

/**
 * The verdicts on clauses and rows. A verdict other than *holds* is drawn before its clause, with its reason: after it,
 * the editor draws the failure of the test over everything else, but not always, and only the part that has room. A verdict
 * that was re-judged is drawn after its clause, because someone is typing there; if it were out of sight there, it is drawn
 * at a line next to it. Any other verdict that would be out of sight after its clause is drawn before it.
 */
export function marksOfHints(document: Text, hints: readonly Hint[]): Mark[] {
  return hints.flatMap((hint): Mark[] => {
    const appearance = appearanceOf(hint);
    if (appearance === undefined) {
      return [];
    }
    const { line, character } = hint.position;
    const { label: words, tooltip = "" } = hint;
    const mark = { ...appearance, words, line, tooltip };
    const { firstNonWhitespaceCharacterIndex: first, text } = document.lineAt(line);
    if (appearance.rejudged && text.length > WIDE_LINE) {
      return [nextToWideLine(document, mark) ?? { ...mark, character: first, side: "before" }];
    }
    if (character > WIDE_LINE) {
      return [{ ...mark, words: appearance.verdict === "holds" ? words : withReason(mark), character: first, side: "before" }];
    }
    // The editor draws nothing at the row of a table, nor at a consequence, whose test has no message.
    return appearance.verdict === "holds" || appearance.rejudged || appearance.consequence || text[first] === "|"
      ? [{ ...mark, character, side: "after" }]
      : [{ ...mark, words: withReason(mark), character: first, side: "before" }];
  });
}

/** A mark at the end of the line below or above its own, if that is short, with an arrow to its own. */
function nextToWideLine(document: Text, mark: Omit<Mark, "character" | "side">): Mark | undefined {
  const next = [
    { line: mark.line + 1, arrow: "↑" },
    { line: mark.line - 1, arrow: "↓" },
  ];
  const end = (line: number) => document.lineAt(line).text.length;
  const host = next.find(({ line }) => line >= 0 && line < document.lineCount && end(line) <= LONG_LINE);
  return host && { ...mark, words: `${host.arrow} ${mark.words}`, line: host.line, character: end(host.line), side: "after" };
}

function withReason({ words, reason }: Pick<Mark, "words" | "reason">): string {
  if (reason === "") {
    return words;
  }
  const short = reason.length > REASON ? `${reason.slice(0, REASON - 1).trimEnd()}…` : reason;
  const isSign = words.length === 1;
  return `${words}${isSign ? "" : ":"} ${short}`;
}

/** The pass rates, at the ends of the lines below their lenses, or at the beginnings of wide lines. */
export function marksOfLenses(document: Text, lenses: readonly vscode.CodeLens[]): Mark[] {
  return lenses.flatMap((lens): Mark[] => {
    const appearance = appearanceOf(lens);
    if (appearance === undefined) {
      return [];
    }
    const { line } = lens.range.start;
    const { text, firstNonWhitespaceCharacterIndex: first } = document.lineAt(line);
    const place = text.length > WIDE_LINE ? ({ character: first, side: "before" } as const) : ({ character: text.length, side: "after" } as const);
    return [{ ...appearance, words: lens.command?.title ?? "", line, ...place, tooltip: "" }];
  });
}
