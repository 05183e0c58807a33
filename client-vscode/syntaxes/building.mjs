// Small parts that the grammars are put together from.

// Names may hold `-`, so `\b` is not their boundary: `is-held` is one name and no keyword.
const LETTER = String.raw`\p{L}\p{N}_`;
export const NAME = String.raw`[\p{L}_][\p{L}\p{N}_-]*`;
export const QUALIFIED = String.raw`${NAME}(?:\.${NAME})*`;
const START = `(?<![${LETTER}-])`;
const END = `(?![${LETTER}-])`;

/** A pattern for phrases of one or more words each, longest first, with free white space between the words. */
export function phrases(scope, ...texts) {
  const longestFirst = [...texts].sort((a, b) => b.length - a.length);
  return { match: `${START}(?:${longestFirst.map(spaced).join("|")})${END}`, name: `${scope}.robbdd` };
}

/** The same for words that stand before a colon. */
export function labels(scope, ...texts) {
  const longestFirst = [...texts].sort((a, b) => b.length - a.length);
  return {
    match: String.raw`${START}(${longestFirst.map(spaced).join("|")})\s*(:)`,
    captures: { 1: { name: `${scope}.robbdd` }, 2: { name: "punctuation.separator.label.robbdd" } },
  };
}

/** A label whose value is a bare word, as in `base name: washer`. */
export function property(scope, valueScope, ...texts) {
  const longestFirst = [...texts].sort((a, b) => b.length - a.length);
  return {
    match: String.raw`${START}(${longestFirst.map(spaced).join("|")})\s*(:)\s*(${QUALIFIED})${END}`,
    captures: {
      1: { name: `${scope}.robbdd` },
      2: { name: "punctuation.separator.label.robbdd" },
      3: { name: `${valueScope}.robbdd` },
    },
  };
}

/** A declaration: its words, perhaps a namespace in parentheses, its name. */
export function declaration(keyword, nameScope, ...texts) {
  const longestFirst = [...texts].sort((a, b) => b.length - a.length);
  return {
    match: String.raw`${START}(${longestFirst.map(spaced).join("|")})(?:\s*(\()\s*(ns)\s*(=)\s*(${NAME})\s*(\)))?\s+(${NAME})`,
    captures: {
      1: { name: `${keyword}.robbdd` },
      2: { name: "punctuation.section.parens.begin.robbdd" },
      3: { name: "keyword.other.namespace.robbdd" },
      4: { name: "keyword.operator.assignment.robbdd" },
      5: { name: "entity.name.namespace.robbdd" },
      6: { name: "punctuation.section.parens.end.robbdd" },
      7: { name: `${nameScope}.robbdd` },
    },
  };
}

/** All patterns of the shared ground. */
export const COMMON = { include: "source.robbdd.common" };

export function grammar(name, scopeName, patterns) {
  return { name, scopeName, patterns };
}

function spaced(text) {
  return text.replaceAll(".", String.raw`\.`).replaceAll(" ", String.raw`\s+`);
}
