// The TextMate grammars of the six file kinds and of features. The build writes them as JSON.
import { COMMON, NAME, QUALIFIED, declaration, grammar, labels, phrases, property } from "./building.mjs";

const DECLARE = "storage.type.declaration";
const SECTION = "keyword.control.section";
const WORD = "keyword.other";
const PROPERTY = "keyword.other.property";
const PHRASE = "support.function";

const NUMBER = String.raw`(?<![\p{L}\p{N}_.])([+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)`;

const string = (quote, kind) => ({
  name: `string.quoted.${kind}.robbdd`,
  begin: quote,
  end: quote,
  patterns: [
    { match: String.raw`\\.`, name: "constant.character.escape.robbdd" },
    // `{name}` stands for an argument in a text template.
    { match: String.raw`\{${NAME}\}`, name: "constant.other.placeholder.robbdd" },
  ],
});

const common = grammar("RobBDD common ground", "source.robbdd.common", [
  { match: "//.*$", name: "comment.line.double-slash.robbdd" },
  string('"', "double"),
  string("'", "single"),
  {
    match: String.raw`(<)\s*((?:${NAME}\.)*)(${NAME})\s*(>)`,
    name: "meta.reference.robbdd",
    captures: {
      1: { name: "punctuation.definition.reference.begin.robbdd" },
      2: { name: "variable.other.object.robbdd" },
      3: { name: "variable.other.property.robbdd" },
      4: { name: "punctuation.definition.reference.end.robbdd" },
    },
  },
  declaration("keyword.other.namespace", "entity.name.namespace", "ns"),
  {
    match: String.raw`(\()\s*(ns)\s*(=)\s*(${NAME})\s*(\))`,
    captures: {
      1: { name: "punctuation.section.parens.begin.robbdd" },
      2: { name: "keyword.other.namespace.robbdd" },
      3: { name: "keyword.operator.assignment.robbdd" },
      4: { name: "entity.name.namespace.robbdd" },
      5: { name: "punctuation.section.parens.end.robbdd" },
    },
  },
  phrases("keyword.control.import", "import"),
  { match: String.raw`${NUMBER}(?![\p{L}\p{N}_])`, captures: { 1: { name: "constant.numeric.robbdd" } } },
]);

const quantity = {
  match: String.raw`${NUMBER}\s*(m/s|deg/s|deg|rad|mm|cm|ms|kg|g|m|s|N|%)(?![\p{L}\p{N}_/-])`,
  captures: { 1: { name: "constant.numeric.robbdd" }, 2: { name: "keyword.other.unit.robbdd" } },
};

// A word as the value of a property: `colour: red`, `colour: red, grey`, `where colour = red`.
const valueWords = [
  { match: String.raw`(?<=[^=]=\s)${NAME}(?![\p{L}\p{N}_.-])`, name: "constant.other.value.robbdd" },
  { match: String.raw`(?<=:\s)${NAME}(?=\s*[,}]|\s+${NAME}\s*:)`, name: "constant.other.value.robbdd" },
];

const scene = grammar("RobBDD Scene", "source.robbdd.scene", [
  quantity,
  COMMON,
  declaration(DECLARE, "entity.name.type.set", "similar obj set", "similar agn set", "obj set", "ws set", "agn set"),
  declaration(DECLARE, "entity.name.type.scene", "scene"),
  declaration(DECLARE, "entity.name.type.composition", "comp"),
  declaration(DECLARE, "variable.other.constant", "object", "workspace", "agent"),
  property(PROPERTY, "variable.other.constant", "base name"),
  labels(PROPERTY, "base name", "count", "correct for"),
  { match: `${NAME}(?=\\s*:)`, name: `${PROPERTY}.robbdd` },
  phrases("constant.language", "true", "false"),
  // What stays of a declaration that is still being typed, and links to sets and compositions.
  phrases(DECLARE, "similar", "obj set", "ws set", "agn set", "ws comp", "comp", "scene", "obj", "ws", "agn"),
  phrases(DECLARE, "object", "workspace", "agent"),
  phrases(WORD, "of", "where", "and", "not"),
  {
    match: String.raw`(?<![\p{L}\p{N}_-])(with)\s+(${NAME}(?:\s*,\s*${NAME})*)`,
    captures: { 1: { name: `${WORD}.robbdd` }, 2: { name: "variable.other.property.robbdd" } },
  },
  phrases(WORD, "with"),
  { match: String.raw`(?<![\p{L}\p{N}_-])${NAME}(?=\s*(?:!=|<=|>=|=|<|>)\s)`, name: "variable.other.property.robbdd" },
  ...valueWords,
]);

const predicates = phrases(
  `${PHRASE}.predicate`,
  "is located at",
  "is held by",
  "are sorted into",
  "can reach",
  "does not drop",
  "moves safely",
  "moves slower than",
  "is tilted less than",
  "is open",
  "is closed",
  "it takes less than",
  "is at rest",
  "is entirely inside",
  "is on top of",
  "is correct for",
  "are sorted correctly into",
  "touches",
  "does not touch",
  "presses",
  "with less than",
  "does not collide with",
  "does not collide",
  "stays within",
  "keeps its joints",
  "from their limits",
);

// The last word of the phrase is behind a quantity, a variable or an element.
const distance = {
  begin: String.raw`(?<![\p{L}\p{N}_-])(is\s+(?:nearer|farther)\s+than|keeps\s+a\s+distance\s+of|of\s+the\s+line\s+from)(?![\p{L}\p{N}_-])`,
  beginCaptures: { 1: { name: `${PHRASE}.predicate.robbdd` } },
  end: String.raw`(?<![\p{L}\p{N}_.-])(to|from)(?![\p{L}\p{N}_-])|(?=[,)])`,
  endCaptures: { 1: { name: `${PHRASE}.predicate.robbdd` } },
  patterns: [quantity, COMMON],
};

const bdd = grammar("RobBDD", "source.robbdd", [
  quantity,
  distance,
  COMMON,
  declaration(DECLARE, "entity.name.type.template", "Scenario Template"),
  declaration(DECLARE, "entity.name.type.story", "User Story"),
  declaration(DECLARE, "entity.name.type.variant", "Scenario Variant", "Scenario"),
  declaration(DECLARE, "entity.name.type.behaviour", "Behaviour Tree", "Behaviour"),
  declaration(DECLARE, "variable.other.constant", "Event", "Task", "Requirement", "Predicate", "const set"),
  {
    match: String.raw`(?<![\p{L}\p{N}_-])(event)\s+(${NAME})(?=\s+when(?![\p{L}\p{N}_-]))`,
    captures: { 1: { name: `${DECLARE}.robbdd` }, 2: { name: "variable.other.constant.robbdd" } },
  },
  // The name of a predicate that the model defines, behind its subject: '<part> is-stored in <bin>'.
  {
    match: String.raw`(?<=>\s)([\p{L}_][\p{L}\p{N}_]*-[\p{L}\p{N}_-]*)(?=[\s:,])`,
    captures: { 1: { name: `${PHRASE}.predicate.robbdd` } },
  },
  phrases(`${WORD}.time`, "when"),
  declaration(WORD, "entity.name.type.behaviour", "sequence", "selector"),
  declaration(WORD, "variable.other.property", "node"),
  labels(SECTION, "Given", "When", "Then", "Scenarios", "variation"),
  labels(PROPERTY, "duration", "task", "verifies", "id", "source", "template", "scene", "node"),
  phrases("keyword.other.verifies", "verifies"),
  {
    match: String.raw`(?<![\p{L}\p{N}_-])((?:set\s+)?var)\s+(${QUALIFIED})`,
    captures: { 1: { name: "storage.type.variable.robbdd" }, 2: { name: "variable.parameter.robbdd" } },
  },
  phrases("storage.type.variable", "set var", "var"),
  {
    match: String.raw`(?<![\p{L}\p{N}_-])(${NAME})\s*(:)\s*(holds)(?![\p{L}\p{N}_-])`,
    captures: {
      1: { name: "entity.name.function.fluent.robbdd" },
      2: { name: "punctuation.separator.label.robbdd" },
      3: { name: "keyword.other.holds.robbdd" },
    },
  },
  { match: String.raw`(?<![\p{L}\p{N}_-])holds(?=\s*\()`, name: "keyword.other.holds.robbdd" },
  predicates,
  {
    match: String.raw`(?<![\p{L}\p{N}_-])(has\s+config)\s+(${NAME})`,
    captures: { 1: { name: `${PHRASE}.predicate.robbdd` }, 2: { name: "variable.parameter.robbdd" } },
  },
  { match: String.raw`(?<![\p{L}\p{N}_-])pred(?=\s*\()`, name: `${PHRASE}.predicate.robbdd` },
  { match: String.raw`(?<![\p{L}\p{N}_-])${NAME}(?=\s*=)`, name: "variable.parameter.robbdd" },
  valueWords[0],
  phrases(`${PHRASE}.behaviour`, "picks", "places", "and places at", "and places it at", "opens", "closes", "pushes", "hands over", "moves to"),
  phrases(`${PHRASE}.event`, "occurs"),
  { match: String.raw`(?<=>)\s*(at|to)(?![\p{L}\p{N}_-])`, captures: { 1: { name: `${PHRASE}.behaviour.robbdd` } } },
  phrases(`${WORD}.time`, "within", "seconds", "before", "after", "at some time", "from", "until", "whenever", "the first", "the last", "every"),
  { match: String.raw`(?<![\p{L}\p{N}_-])for(?=\s+[\d.])`, name: `${WORD}.time.robbdd` },
  phrases("keyword.control.quantifier", "for all", "exists in", "such that", "in"),
  phrases("keyword.operator.wordlike", "and", "or", "not"),
  phrases("keyword.control.order", "then", "meanwhile"),
  phrases(`${WORD}.story`, "As A", "As An", "I Want", "So That"),
  phrases(
    `${WORD}.variation`,
    "select",
    "combinations from",
    "repeated combinations from",
    "permutations from",
    "can be",
    "where",
    "obj set",
    "ws set",
    "agn set",
    "set",
    "obj",
    "ws",
    "agn",
  ),
  // What stays of a declaration that is still being typed.
  phrases(DECLARE, "Scenario Template", "User Story", "Scenario Variant", "Scenario", "Behaviour Tree", "Behaviour", "const set"),
  phrases(DECLARE, "Event", "Task", "Requirement", "Predicate"),
  phrases("keyword.other.event", "event"),
  { match: String.raw`\|(?:\s*-{3,}\s*\|)*`, name: "punctuation.separator.table.robbdd" },
]);

// A unit is one only behind a number, a vector or `unit:`; elsewhere `m` may well be a name.
const UNIT = String.raw`(kg\*m\^2|rad/s|N\*m|mm|cm|m|rad|deg|kg|g|Hz|seconds|s)(?![\p{L}\p{N}_-])`;
const units = [
  {
    match: `${NUMBER}\\s*${UNIT}`,
    captures: { 1: { name: "constant.numeric.robbdd" }, 2: { name: "keyword.other.unit.robbdd" } },
  },
  { match: String.raw`(?<=[)>])\s*${UNIT}`, captures: { 1: { name: "keyword.other.unit.robbdd" } } },
  {
    match: String.raw`(?<![\p{L}\p{N}_-])(unit)\s*(:)\s*${UNIT}`,
    captures: {
      1: { name: `${PROPERTY}.robbdd` },
      2: { name: "punctuation.separator.label.robbdd" },
      3: { name: "keyword.other.unit.robbdd" },
    },
  },
];

const scenex = grammar("RobBDD Scene Instance", "source.robbdd.scenex", [
  ...units,
  COMMON,
  property(PROPERTY, "constant.language", "axes"),
  property(PROPERTY, "entity.name.namespace", "module", "attr"),
  declaration(DECLARE, "entity.name.type.instance", "scene inst"),
  declaration(DECLARE, "entity.name.type.tree", "ktree inst", "ktree", "kgraph"),
  declaration(DECLARE, "entity.name.type.distribution", "distrib"),
  declaration(DECLARE, "entity.name.function.model", "model"),
  declaration(DECLARE, "variable.other.constant", "body", "frame", "pose", "fixed", "revolute", "camera"),
  declaration(DECLARE, "variable.other.constant", "force-torque", "imu"),
  labels(
    PROPERTY,
    ...["dimension", "lower", "upper", "mean", "covariance", "std-dev", "scene", "wrt", "xyz", "orientation", "xyzw"],
    ...["angles", "axes", "x", "y", "z", "root", "tip", "anchor", "parent", "child", "axis", "limits"],
    ...["offset", "polarity", "rate", "module", "attr", "frame", "mass", "position", "velocity", "effort"],
    ...["tool", "actuator", "open", "close", "closed", "pads", "stroke", "home", "joint", "size", "on"],
  ),
  { match: String.raw`(?<![\p{L}\p{N}_-])(?:sys\s+path|ros\s+pkg|path)(?=\s*=)`, name: `${PROPERTY}.robbdd` },
  phrases(`${WORD}.distribution`, "uniform-rotation", "uniform", "normal", "sample"),
  phrases("constant.language", "mjcf", "urdf", "usd", "extrinsic", "intrinsic"),
  phrases(`${WORD}.rotation`, "quat", "euler", "direction-cosine"),
  phrases(DECLARE, "scene inst", "ktree inst", "ktree", "kgraph", "distrib", "model", "body", "joints", "frame", "box"),
  phrases(DECLARE, "pose", "inertia", "gripper", "opening", "fixed", "revolute", "serial", "parallel", "camera", "force-torque", "imu"),
  phrases(WORD, "actuation", "mimic", "offset", "limits", "polarity", "parent", "child", "as", "of", "on", "to", "py", "friction"),
  phrases(WORD, "map body", "map tree", "catalog", "obj set", "agn set", "ws set", "obj", "agn", "ws"),
]);

const bddx = grammar("RobBDD Execution", "source.robbdd.bddx", [
  ...units,
  COMMON,
  property(PROPERTY, "entity.name.namespace", "module", "attr"),
  declaration(DECLARE, "entity.name.type.execution", "Scenario Exec"),
  declaration(DECLARE, "entity.name.function.behaviour", "bhv impl"),
  declaration(DECLARE, "entity.name.function.policy", "obs policy"),
  declaration(DECLARE, "entity.name.function.provider", "obs provider"),
  declaration(DECLARE, "entity.name.function.observation", "observation"),
  declaration(DECLARE, "entity.name.function.log", "robot log"),
  labels(
    PROPERTY,
    ...["bhv action", "answer within", "ros topic", "type", "update-rate", "provider", "horizon", "observations", "evaluator"],
    ...["certain beyond", "less-than", "greater-than", "equals", "tolerance", "between", "max time offset", "trinary topic"],
    ...["variant", "scene inst", "bhv", "policies", "repeat", "seed", "timeout", "noise", "latency", "module", "attr"],
    ...["path", "frames", "base frames", "world frame", "joint topics", "events", "grips", "annotations", "uncertainty", "log"],
  ),
  phrases("storage.type.variable", "set var", "var"),
  phrases(`${PHRASE}.evaluator`, "linear distance", "angular distance"),
  phrases(`${PHRASE}.provider`, "ros simulation entity state", "simulation ground truth"),
  phrases(WORD, "observes", "for", "and", "py", "catalog", "process", "endpoint", "obj", "ws", "agn", "where", "when", "while", "of", "to"),
  phrases(DECLARE, "Scenario Exec", "bhv impl", "obs policy", "obs provider", "observation", "robot log"),
]);

const study = grammar("RobBDD Study", "source.robbdd.study", [
  {
    match: `${NUMBER}\\s*(seconds)(?![\\p{L}\\p{N}_-])`,
    captures: { 1: { name: "constant.numeric.robbdd" }, 2: { name: "keyword.other.unit.robbdd" } },
  },
  {
    // A bound of a range with its unit; the name of the next setting is no unit.
    match: String.raw`(?<![\p{L}\p{N}_-])(from|to)\s+${NUMBER}[ \t]*(?!to\s|[\p{L}-]+\s*:|factor\s)([\p{L}%][\p{L}%/]*)`,
    captures: {
      1: { name: `${WORD}.factor.robbdd` },
      2: { name: "constant.numeric.robbdd" },
      3: { name: "keyword.other.unit.robbdd" },
    },
  },
  {
    // The levels are names of catalog behaviours and, in brackets, of implementations.
    begin: String.raw`(?<![\p{L}\p{N}_-])(factor)\s+(bhv)\s*(<[^<>]*>)\s*(:)\s*\{`,
    beginCaptures: {
      1: { name: `${WORD}.factor.robbdd` },
      2: { name: `${WORD}.factor.robbdd` },
      3: { name: "variable.other.property.robbdd" },
      4: { name: "punctuation.separator.label.robbdd" },
    },
    end: String.raw`\}`,
    patterns: [COMMON, { match: NAME, name: "entity.name.function.behaviour.robbdd" }],
  },
  COMMON,
  declaration(DECLARE, "entity.name.type.study", "Study"),
  labels(PROPERTY, "scenarios", "where", "first", "sample", "pairwise", "repeat", "seed", "batch", "timeout", "stop", "block", "traces", "design", "cover"),
  phrases(`${WORD}.stop`, "width", "rate", "against"),
  phrases(`${WORD}.traces`, "failures", "all", "MB"),
  phrases(`${WORD}.block`, "repetition"),
  phrases(`${WORD}.cover`, "levels", "pairs", "clauses", "events", "predicates"),
  phrases(`${WORD}.design`, "latin-hypercube", "sobol", "grid"),
  phrases(`${WORD}.factor`, "factor scene", "factor bhv", "factor var", "factor", "scene", "bhv", "var", "from", "to"),
  phrases(DECLARE, "Study"),
]);

// Features as our templates write them, English or German, for editors that have no extension for Gherkin.
const STEP_WORDS = "Given|When|Then|And|But|Angenommen|Wenn|Dann|Und|Aber";
const HEADINGS = "Feature|Background|Scenario Outline|Scenario|Examples|Funktionalität|Grundlage|Szenariogrundriss|Szenario|Beispiele";
const feature = grammar("Gherkin", "text.gherkin.robbdd", [
  { match: String.raw`^\s*#.*$`, name: "comment.line.number-sign.robbdd" },
  { match: String.raw`(?<=^|\s)@\S+`, name: "storage.type.annotation.tag.robbdd" },
  {
    match: String.raw`^\s*(${HEADINGS})(:)\s*(.*)$`,
    captures: {
      1: { name: `${SECTION}.robbdd` },
      2: { name: "punctuation.separator.label.robbdd" },
      3: { name: "entity.name.type.scenario.robbdd" },
    },
  },
  { match: String.raw`^\s*(${STEP_WORDS})(?=\s)`, captures: { 1: { name: "keyword.control.step.robbdd" } } },
  { match: String.raw`"(?:[^"\\]|\\.)*"`, name: "string.quoted.double.robbdd" },
  { match: String.raw`(?<=\|)[^|]*(?=\|)`, name: "variable.other.constant.robbdd" },
  { match: String.raw`(?<![\w-])(?:before|after) event|(?<![\w-])(?:whenever|at some time(?: within)?|within|for(?= [\d.]+(?:e[+-]?\d+)? seconds)|from|until)(?![\w-])`, name: `${WORD}.time.robbdd` },
]);

export const grammars = { common, scene, bdd, scenex, bddx, study, feature };
