"""Catalog phrases as grammar rules: ``<object> is located at <workspace>`` → a textX rule."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from robbdd_tools.catalog.api import Behaviour, Predicate
from robbdd_tools.catalog.registry import Catalog

PREDICATE_RULE = "Predicate_"
ACTION_RULE = "Action_"
_PIECE = re.compile(r"<(?P<slot>\w+)>|\$(?P<name>\w+)|(?P<word>[^\W\d]\w*)|(?P<sign>[^\s\w])")


def phrase_rules(catalog: Catalog) -> str:
    """Return the rules ``Predicate`` and ``Action`` with one alternative per word of the catalog."""
    predicates = ["TextPredicate", *_rule_names(PREDICATE_RULE, catalog.predicates)]
    rules = [f"Predicate: {' | '.join(predicates)};"]
    rules.append(f"Action: {' | '.join(_rule_names(ACTION_RULE, catalog.behaviours))};")
    rules += [f"{_rule_name(PREDICATE_RULE, word.name)}: {_body(word.phrase)};" for word in catalog.predicates.values()]
    rules += [f"{_rule_name(ACTION_RULE, word.name)}: {_body(word.phrase)};" for word in catalog.behaviours.values()]
    return "\n".join(rules) + "\n"


def word_of_rule(rule: str) -> str | None:
    """Return the catalog name behind a generated rule's name, ``None`` for any other rule."""
    for prefix in (PREDICATE_RULE, ACTION_RULE):
        if rule.startswith(prefix):
            return rule[len(prefix) :].replace("_", "-")
    return None


def _rule_names(prefix: str, words: Mapping[str, Predicate] | Mapping[str, Behaviour]) -> Iterable[str]:
    """Longest phrase first: ``picks <o> and places …`` must be tried before ``picks <o>``."""
    ordered = sorted(words.values(), key=lambda word: (-len(word.phrase), word.name))
    return (_rule_name(prefix, word.name) for word in ordered)


def _rule_name(prefix: str, word: str) -> str:
    return prefix + word.replace("-", "_")


def _body(phrase: str) -> str:
    parts: list[str] = []
    for match in _PIECE.finditer(phrase):
        if match["slot"]:
            parts.append(f"{match['slot']}=VariableRef")
        elif match["name"]:
            parts.append(f"{match['name']}=Name")
        else:
            parts.append(f"'{match['word'] or match['sign']}'")
    return " ".join(parts)
