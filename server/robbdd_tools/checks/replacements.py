"""Replacements for a variable or a value of the wrong type."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import units_of
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import MAX_OFFERED, change, written_text
from robbdd_tools.names.types import narrowed, variable_key
from robbdd_tools.names.uses import slot_kinds
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Fix
    from robbdd_tools.checks.template_variants import Column, Scenario
    from robbdd_tools.names.elements import Site
    from robbdd_tools.names.uses import Clauses, Kinds, Use

SET_WORDS = {"object": "obj set", "workspace": "ws set", "agent": "agn set"}
"""Kind of an element → keyword of a set of that kind in a scene or a variation."""


def variables_with_kinds(template: Site, uses: Mapping[str, list[Use]]) -> Iterator[tuple[str, Kinds]]:
    """Yield paths and kinds of a template's variables, except sets and variables whose kinds no use determines."""
    root = template.tree
    paths = (
        [f"{root.name.text}.{entry.name.text}" for entry in root.variables] if isinstance(root, tree.Template) else []
    )
    for path in paths:
        found = template.file.definitions.get(path)
        if found is not None and found.kind is SymbolKind.VARIABLE:
            yield path, narrowed(uses.get(variable_key(found), ()))


def other_variables(site: Site, use: Use, clauses: Clauses, others: Mapping[str, Kinds]) -> Iterator[Fix]:
    """Yield fixes that replace a variable by another one of the right type.

    Variables that the phrase already uses are left out.
    """
    if use.bound is not None:
        return
    phrase = _phrase_of(use, clauses)
    taken = {value.path for _, value in phrase.arguments if isinstance(value, tree.Ref)} if phrase is not None else ()
    fitting = [name for name, kinds in others.items() if kinds & use.kinds and name not in taken]
    yield from (change(site, f"Change to '{name}'", use.ref, name) for name in fitting[:MAX_OFFERED])


def similar_phrase(use: Use, clauses: Clauses, kinds: Kinds) -> str:
    """Return a predicate's phrase that accepts ``kinds`` and differs from the used phrase only in words at its end.

    Example: *does not collide* of an agent, and *does not collide with* of an object. Empty if there is none.
    """
    phrase = _phrase_of(use, clauses)
    predicates = load_catalog().predicates
    if phrase is None or phrase.word not in predicates:
        return ""
    index = next(index for index, (_, value) in enumerate(phrase.arguments) if value is use.ref)
    own = _fixed_words(predicates[phrase.word].phrase)
    for word in predicates.values():
        words, slots = _fixed_words(word.phrase), list(slot_kinds(word.name).values())
        if word.name != phrase.word and _is_longer(own, words) and slots[index] & kinds:
            return word.phrase
    return ""


def with_similar_phrase(site: Site, use: Use, clauses: Clauses, similar: str) -> Iterator[Fix]:
    """Yield a fix that writes a similar phrase with the same values."""
    phrase = _phrase_of(use, clauses)
    if phrase is not None and similar:
        values = iter([_as_written(site, value) for _, value in phrase.arguments])
        text = _SLOT.sub(lambda _: next(values), similar)
        yield change(site, f"Write '{text}'", phrase, text)


_SLOT = re.compile(r"<[\w-]+>|[#$][\w-]+")


def _phrase_of(use: Use, clauses: Clauses) -> tree.PhraseUse | None:
    return next((phrase for phrase in clauses.phrases if phrase.span.contains(use.ref.span.start)), None)


def _fixed_words(phrase: str) -> list[list[str]]:
    return [piece.split() for piece in _SLOT.split(phrase)]


def _is_longer(one: list[list[str]], other: list[list[str]]) -> bool:
    """Return whether two phrases have the same slots and differ only in words added before a slot or at the end."""
    return len(one) == len(other) and all(
        own[: len(their)] == their[: len(own)] and bool(own) == bool(their)
        for own, their in zip(one, other, strict=True)
    )


def _as_written(site: Site, node: tree.Node) -> str:
    written = written_text(site, node)
    return f"<{written}>" if isinstance(node, tree.Ref) else written


def with_units(site: Site, node: tree.Node, dimension: str) -> Iterator[Fix]:
    """Yield fixes that give a written number, or a quantity of another dimension, each unit of a dimension."""
    if isinstance(node, tree.Number | tree.Quantity):
        written = node.text if isinstance(node, tree.Quantity) else written_text(site, node)
        for unit in units_of(dimension):
            quantity = f"{written.partition(' ')[0]} {unit}"
            yield change(site, f"Change to '{quantity}'", node, quantity)


def other_values(scenario: Scenario, column: Column, node: tree.Node, kinds: Kinds, written: set[str]) -> Iterator[Fix]:
    """Yield fixes that replace a value by an element of the scene, or a set by a set of elements, of the right kinds.

    Values that are already ``written`` for the variable are left out.
    """
    site, members = scenario.site, scenario.members(kinds)
    link = next((one for one in column.written if isinstance(one, tree.Link) and one.reference is node), None)
    is_source = any(isinstance(one, tree.Selection) and one.source is node for one in column.written)
    if link is None and not is_source:
        names = [member.name for member in members if member.name not in written]
        for name in names[:MAX_OFFERED]:
            yield change(site, f"Change to '<{name}>'", node, name if isinstance(node, tree.Ref) else f"<{name}>")
        return
    sets = dict.fromkeys((SET_WORDS[member.kind], member.name.rpartition(".")[0]) for member in members)
    for words, name in list(sets)[:MAX_OFFERED]:
        if link is None:
            yield change(site, f"Change to '{name}'", node, name)
        else:
            yield change(site, f"Change to '{words} <{name}>'", link, f"{words} <{name}>")
