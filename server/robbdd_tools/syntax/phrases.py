"""Translate phrases of the catalog to rules of the grammar, for example ``<object> is located at <workspace>``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from robbdd_tools.catalog.api import Behaviour, Kind, Predicate
from robbdd_tools.catalog.registry import Catalog

PREDICATE_RULE = "Predicate_"
ACTION_RULE = "Action_"
ALIAS = "__"
_PIECE = re.compile(r"<(?P<slot>\w+)>|\$(?P<name>\w+)|#(?P<quantity>\w+)|(?P<word>[^\W\d]\w*)|(?P<sign>[^\s\w])")


def phrase_rules(catalog: Catalog) -> str:
    """Return the rules ``Predicate``, ``Condition`` and ``Action`` with one alternative per phrase of the catalog.

    A condition is a predicate that can be judged at each sample, so it is neither a text nor about a duration.
    """
    predicates = dict(_phrases(PREDICATE_RULE, catalog.predicates))
    actions = dict(_phrases(ACTION_RULE, catalog.behaviours))
    rules = [f"Predicate: {' | '.join(['TextPredicate', *_longest_first(predicates)])};"]
    of_states = {name: word for name, word in catalog.predicates.items() if word.duration is None}
    conditions = dict(_phrases(PREDICATE_RULE, of_states))
    rules.append(f"Condition: {' | '.join([*_longest_first(conditions), 'NamedUse'])};")
    rules.append(f"Action: {' | '.join(_longest_first(actions))};")
    words = {**catalog.predicates, **catalog.behaviours}
    for name, phrase in (predicates | actions).items():
        slots = words[word_of_rule(name) or ""].slots
        values = frozenset(slot.name for slot in slots if slot.kind is Kind.VALUE)
        rules.append(f"{name}: {_body(phrase, values)};")
    return "\n".join(rules) + "\n"


def word_of_rule(rule: str) -> str | None:
    """Return the catalog word of a generated rule, or ``None`` for any other rule."""
    for prefix in (PREDICATE_RULE, ACTION_RULE):
        if rule.startswith(prefix):
            return rule[len(prefix) :].partition(ALIAS)[0].replace("_", "-")
    return None


def _phrases(prefix: str, words: Mapping[str, Predicate] | Mapping[str, Behaviour]) -> Iterator[tuple[str, str]]:
    """Yield each phrase of each word with a rule name, because textX needs a separate rule for every phrase."""
    for word in words.values():
        name = prefix + word.name.replace("-", "_")
        yield name, word.phrase
        for number, alias in enumerate(word.aliases, start=1):
            yield f"{name}{ALIAS}{number}", alias


def _longest_first(phrases: Mapping[str, str]) -> list[str]:
    """Sort phrases by length, because ``picks <o> and places …`` must be tried before ``picks <o>``."""
    return sorted(phrases, key=lambda name: (-len(phrases[name]), name))


def _body(phrase: str, values: frozenset[str]) -> str:
    """Return the rule of a phrase. Literals may fill the slots ``values``."""
    parts: list[str] = []
    for match in _PIECE.finditer(phrase):
        if match["slot"]:
            parts.append(f"{match['slot']}={'Setting' if match['slot'] in values else 'TermRef'}")
        elif match["name"]:
            parts.append(f"{match['name']}=Name")
        elif match["quantity"]:
            parts.append(f"{match['quantity']}=Amount")
        else:
            parts.append(f"'{match['word'] or match['sign']}'")
    return " ".join(parts)
