"""Describe the settings of a study in words, and show the form of a whole study."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from robbdd_tools.features.snippets import Snippet
from robbdd_tools.syntax.study_tokens import Token

FORMS: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "scenarios": ("scenarios: { <NAME>, … }", "Executes only these variants or executions. Without it: all."),
        "where": ('where: "CONDITION"', 'Executes only scenarios with these values, such as `"robot=panda"`.'),
        "first": ("first: N", "Executes only the first N scenarios."),
        "sample": ("sample: N", "Executes N scenarios, drawn at random with the seed."),
        "pairwise": (
            "pairwise: 2",
            "Executes a covering array: all combinations of values of any 2 (or 3) variables occur.",
        ),
        "repeat": (
            "repeat: N",
            "Executes each scenario N times, each time with another seed. "
            "Without it: the number of the model's executions, or once.",
        ),
        "seed": ("seed: N", "The seed of the sample and of all executions. Without it: 1."),
        "batch": ("batch: N", "Moves results to the study's store after N executions. Without it: 500."),
        "timeout": ("timeout: N seconds", "The limit of wall time for one scenario. Without it: 300; 0 is no limit."),
        "stop": (
            "stop: width W\nstop: rate P against Q",
            "Ends the study early: when the 95 % interval of the pass rate is at most W wide, or when a pass rate of P "
            "is shown, or refuted in favour of Q. Rates and widths are between 0 and 1.",
        ),
        "block": (
            "block: repetition",
            "Gives all executions of a repetition the same seed, whatever their scenario, values and levels.",
        ),
        "traces": (
            "traces: failures N MB\ntraces: all N MB",
            "Keeps traces (MCAP) of the executions that do not hold, or of all, up to N MB in total. "
            "Traces of failures are kept first, then those of earlier executions. Without it: none.",
        ),
        "cover": (
            "cover: { levels N %, pairs N %, clauses N %, events N %, predicates N % }",
            "Goals: the share of levels of factors and variables, of pairs of levels, of clauses, of the events and of "
            "the predicates of clauses that the executions must exercise. A clause is exercised if it holds or is "
            "violated in an execution. If a goal is not met, the exit code is 1.",
        ),
        "design": (
            "design: latin-hypercube N\ndesign: sobol N\ndesign: grid N",
            "Executes each scenario at N points of the ranges: of a Latin hypercube, or of a Sobol sequence (2, 4, 8, "
            "… points). A grid has N levels of each range, bounds included, in all combinations. "
            "The seed determines the points.",
        ),
        "factor": (
            'factor scene: { "A.scenex", … }\nfactor bhv <IMPL>: { NAME, <IMPL>, … }\n'
            "factor var <VARIABLE>: from A to B",
            "Executes everything in the scene instances of each file, or with each catalog behaviour or other "
            "implementation instead of an implementation. All levels of all factors are combined, with the same seeds. "
            "A variable of scenarios takes values of a range, at the points of the `design`, instead of those of the "
            "model.",
        ),
        "import": ('import "FILE"', "A model to execute: a `.bdd` or a `.bddx`."),
        "Study": ("Study NAME { … }", "Executes scenarios many times, in several configurations."),
    }
)
"""Word that begins a part of a study → its form and its meaning."""
WHOLE = Snippet("Study", 'import "${1:model.bdd}"\n\nStudy ${2:name} {\n    repeat: ${3:10}\n    seed: ${4:1}\n}\n')
"""Snippet of a whole study."""


def study_word_meaning(word: str) -> str | None:
    """Describe a word that begins a part of a study; ``None`` for other words."""
    if word not in FORMS:
        return None
    form, meaning = FORMS[word]
    return f"```study\n{form}\n```\n\n{meaning}"


def study_keyword_meaning(tokens: Sequence[Token], number: int) -> str | None:
    """Describe a token of a study. A word inside a setting is described by the setting; names and values have ``None``.

    The last token is the end of the file.
    """
    word, before = tokens[number].text, tokens[:number]
    is_value = tokens[number + 1].text in (",", "}") or (bool(before) and before[-1].text == "Study")
    if word in FORMS and not is_value:
        return study_word_meaning(word)
    for place in range(len(before) - 1, -1, -1):
        token = before[place]
        # The brace of a list follows a colon, that of the study its name.
        if token.text == "{" and before[place - 1].text != ":":
            return None
        if token.kind == "name" and token.text in FORMS:
            inner = re.findall(r"(?<![\w<\-])[a-z][a-z\-]*", FORMS[token.text][0])
            return study_word_meaning(token.text) if word in inner else None
    return None
