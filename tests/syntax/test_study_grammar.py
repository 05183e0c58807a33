"""The grammar of studies, from which the reference draws its diagrams, accepts the texts that their reader accepts."""

from __future__ import annotations

import re
from random import Random

import pytest

from kit import ROOT
from robbdd_tools.base.document import Document
from robbdd_tools.syntax import grammar
from robbdd_tools.syntax.constructs import read_rules
from robbdd_tools.syntax.grammar_files import grammar_text
from robbdd_tools.syntax.peg import Compiled
from robbdd_tools.syntax.study_text import REDUCING, SETTINGS, read_study

RULES = read_rules("study")
PARSER = Compiled(grammar.read_grammar(grammar_text("study")), "StudyFile")
SETTING = RULES["StudySetting"]
VALUES = re.compile(
    r"given twice|give only one|a whole number from|is a number from|power of two|between 0 and 1|has to be below"
    r"|lower to its upper|one unit|has a range|each once"
)
"""Messages of the reader about values, which no grammar states."""
NUMBERS = {
    "Pairwise.count": "2",
    "Stop.width": "0.05",
    "Stop.rate": "0.9",
    "Stop.against": "0.8",
    "StudyGoal.share": "90",
    "RangeFactor.low": "-1.5",
}
TEXTS = {"StudyText": ('"a.bdd"', "'b'"), "StudyName": ("pick-place", "Study", "x_1"), "StudyUnit": ("m/s", "%")}
TOKENS = (
    *SETTINGS,
    "Study",
    "import",
    "{",
    "}",
    ":",
    ",",
    "4",
    "0.5",
    "<a.b>",
    '"t"',
    "name",
    "to",
    "from",
    "seconds",
    "MB",
)


def words(expression: grammar.Expression, random: Random, rule: str) -> list[str]:
    """A random text of an expression, as its tokens. ``rule`` is the rule that contains it."""
    match expression:
        case grammar.Literal(text):
            return [text]
        case grammar.Pattern():
            return [random.choice(TEXTS[rule])]
        case grammar.Use("StudyNumber"):
            return ["4"]
        case grammar.Use("StudyReference"):
            return [f"<{random.choice('abcdefghij')}.{random.randrange(1000)}>"]
        case grammar.Use(name):
            return words(RULES[name], random, name)
        case grammar.Sequence(parts):
            return [word for part in parts for word in words(part, random, rule)]
        case grammar.Choice(options):
            return words(random.choice(options), random, rule)
        case grammar.Optional():
            return []
        case grammar.Assignment(attribute, operator, value, separator):
            if f"{rule}.{attribute}" in NUMBERS:
                return [NUMBERS[f"{rule}.{attribute}"]]
            one = words(value, random, rule)
            if operator != "+=":
                return one
            # No element of a list may be stated twice.
            others = {
                first: [first, *rest]
                for _ in range(2 if separator else 0)
                for first, *rest in [words(value, random, rule)]
            }
            return [*one, *(word for first in sorted(others) if first != one[0] for word in (",", *others[first]))]


def study(random: Random) -> list[str]:
    """The tokens of a study whose values are valid."""
    assert isinstance(SETTING, grammar.Choice)
    rules = [option.rule for option in SETTING.options if isinstance(option, grammar.Use)]
    chosen = random.sample(rules, random.randrange(len(rules) + 1))
    reducing = [rule for rule in chosen if rule.lower() in REDUCING]
    settings = [words(RULES[rule], random, rule) for rule in chosen if rule not in reducing[1:]]
    return ["import", '"a.bdd"', "Study", "name", "{", *(word for one in settings for word in one), "}"]


def mutated(tokens: list[str], random: Random) -> list[str]:
    place = random.randrange(len(tokens))
    match random.randrange(4):
        case 0:
            return [*tokens[:place], *tokens[place + 1 :]]
        case 1:
            return [*tokens[:place], random.choice(TOKENS), *tokens[place:]]
        case 2:
            return [*tokens[:place], random.choice(TOKENS), *tokens[place + 1 :]]
        case _:
            return [*tokens[:place], *tokens[place : place + 2][::-1], *tokens[place + 2 :]]


def faults(text: str) -> list[str]:
    return [one.message for one in read_study(Document("file:///x.study", 0, text))[1]]


def accepts(text: str) -> bool:
    return PARSER.parse(text)[0] is not None


def test_the_grammar_has_each_setting() -> None:
    assert isinstance(SETTING, grammar.Choice)
    begins = [words(option, Random(0), "")[0] for option in SETTING.options]
    assert sorted(begins) == sorted(SETTINGS)


@pytest.mark.parametrize("seed", range(8))
def test_both_accept_what_the_grammar_makes(seed: int) -> None:
    random = Random(seed)
    for _ in range(60):
        text = " ".join(study(random))
        assert accepts(text), text
        assert faults(text) == [], text


@pytest.mark.parametrize("seed", range(8))
def test_both_refuse_the_same_mutations(seed: int) -> None:
    random = Random(seed)
    refused = 0
    for _ in range(250):
        tokens = study(random)
        for _ in range(random.randrange(1, 3)):
            tokens = mutated(tokens, random)
        text = " ".join(tokens)
        found = faults(text)
        refused += not accepts(text)
        if accepts(text):
            assert all(map(VALUES.search, found)), (text, found)
        else:
            assert found, text
    assert 0 < refused < 250


@pytest.mark.parametrize(
    ("text", "accepted"),
    [
        ("Study a { repeat: 3 }", True),
        ("Study a{repeat:3 seed:1}// the end", True),
        ("Study a { factor var <h>: from 1 m/s to 2 m/s seed: 3 }", True),
        ("Study a { factor var <h>: from 1 to 2 seed: 3 }", True),
        ("Study a { factor var <h>: from 1m to 2 }", False),
        ("Study a { factor bhv <x>: { pick, <own-v2> } }", True),
        ("Study a { factor bhv < >: { pick } }", False),
        ("Study a { repeat: 3. }", False),
        ("Study a { repeat: +3 }", False),
        ("Study a { where: 'a=b\" }", False),
        ("Study 3 { }", False),
        ("import a Study a { }", False),
        ("Study a { } Study b { }", False),
        ("", False),
    ],
)
def test_both_agree_about_tokens(text: str, accepted: bool) -> None:
    assert accepts(text) == accepted
    assert (faults(text) == []) == accepted


def test_both_accept_the_studies_of_the_examples() -> None:
    studies = sorted((ROOT / "examples").rglob("*.study"))
    assert studies
    for path in studies:
        text = path.read_text(encoding="utf-8")
        assert accepts(text)
        assert faults(text) == []
