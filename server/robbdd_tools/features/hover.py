"""Hover: describe a name, a phrase of the catalog, a keyword, a time constraint or an import."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.catalog_source import describe_catalog_entry
from robbdd_tools.features.clause_results import clause_hints
from robbdd_tools.features.describe import describe, describe_import
from robbdd_tools.features.element_properties import describe_property
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.features.outside_names import outside_name_at
from robbdd_tools.features.policy_results import policy_hints
from robbdd_tools.features.result_words import result_words
from robbdd_tools.features.run_verdicts import NOTHING
from robbdd_tools.features.sentences import emission_meaning, time_meaning, word_meaning, word_of
from robbdd_tools.features.studies import is_study
from robbdd_tools.features.study_words import study_keyword_meaning
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.constructs import construct_of, constructs_with
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.keyword_at import keyword_in_part
from robbdd_tools.syntax.study_tokens import study_tokens
from robbdd_tools.syntax.symbols import walk_at

if TYPE_CHECKING:
    from collections.abc import Sequence

    from robbdd_tools.features.run_verdicts import Findings, Judged
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class Hover:
    """A Markdown description of the text in ``span`` (absolute).

    ``judged`` is the result that the hover shows, if any. For a clause, it is the worst result. For a scenario, it is
    the result of its worst clause.
    """

    markdown: str
    span: Span
    judged: Judged | None = None


def hover(snapshot: Snapshot, uri: str, offset: int, findings: Findings = NOTHING) -> Hover | None:
    """Describe the name or import at an offset. If there is none, describe the enclosing phrase or the keyword.

    ``findings`` are the latest results of clauses. Everywhere inside a clause, the hover shows the clause's results.
    """
    hints = (*clause_hints(snapshot, uri, findings), *policy_hints(snapshot, uri, findings))
    around = [one for one in hints if one.span.contains(offset)]
    hint = min(around, key=lambda one: one.span.end - one.span.start, default=None)
    found = symbol_at(snapshot, uri, offset)
    if found is not None:
        definition = found[1]
        words = Hover(describe(snapshot, definition, findings), found[0], _worst_of(definition, findings))
        is_own = hint is not None and definition.extent == hint.span and definition.uri == uri
        if hint is not None and (is_own or definition.kind is SymbolKind.POLICY):
            # The description of a clause or a policy contains its results.
            return replace(words, judged=hint.worst)
    else:
        words = _words(snapshot, uri, offset) or _import(snapshot, uri, offset) or _elsewhere(snapshot, uri, offset)
    keyword = None if found is not None else _keyword(snapshot, uri, offset)
    results = None if hint is None else Hover(result_words(hint), hint.span, hint.worst)
    return _joined([one for one in (words, results, keyword) if one is not None])


def _joined(parts: Sequence[Hover]) -> Hover | None:
    """Join the descriptions of a place. The general meaning of a keyword is last, because readers soon know it."""
    if not parts:
        return None
    smallest = min((one.span for one in parts), key=lambda span: span.end - span.start)
    judged = next((one.judged for one in parts if one.judged is not None), None)
    return Hover("\n\n".join(one.markdown for one in parts), smallest, judged)


def _words(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    if is_study(uri):
        return _study_word(snapshot, uri, offset)
    analysis = snapshot.file(uri)
    for placed in analysis.declarations if analysis is not None else ():
        root = placed.declaration.tree
        if root is None or not placed.span.contains(offset):
            continue
        for node in walk_at(root, offset - placed.offset):
            span = node.span.shifted(placed.offset)
            if isinstance(node, tree.PhraseUse):
                return Hover(word_meaning(word_of(node)), span)
            if isinstance(node, tree.During | tree.Before | tree.After):
                return Hover(time_meaning(node), span)
            if isinstance(node, tree.Property | tree.PropertyCondition) and node.name.span.shifted(
                placed.offset
            ).contains(offset):
                found = describe_property(snapshot, uri, node.name.text)
                return None if found is None else Hover(found, node.name.span.shifted(placed.offset))
            if isinstance(node, tree.Columns):
                name = next((one for one in node.names if one.span.shifted(placed.offset).contains(offset)), None)
                found = None if name is None else describe_property(snapshot, uri, name.text)
                return None if name is None or found is None else Hover(found, name.span.shifted(placed.offset))
            if isinstance(node, tree.Emission):
                return Hover(emission_meaning(node), span)
    return None


def _keyword(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    """Describe the construct of a keyword."""
    analysis = snapshot.file(uri)
    if analysis is None or is_study(uri):
        return None
    for placed in analysis.parts(Span(offset, offset + 1)):
        found = keyword_in_part(language_of(uri), placed.declaration, offset - placed.offset)
        if found is None:
            continue
        construct = construct_of(language_of(uri), found.rule, found.word)
        possible = [construct] if found.rule else constructs_with(language_of(uri), found.word)
        if len(possible) == 1 and possible[0] is not None:
            return Hover(possible[0].markdown, found.span.shifted(placed.offset))
    return None


def _study_word(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    """Describe a keyword of a study, or a catalog behaviour that is a level of a factor."""
    tokens = list(study_tokens(snapshot.document(uri).text))
    for number, token in enumerate(tokens):
        if token.kind == "name" and token.span.contains(offset):
            is_level = tokens[number + 1].text in (",", "}")
            found = study_keyword_meaning(tokens, number) or (describe_catalog_entry(token.text) if is_level else None)
            return None if found is None else Hover(found, token.span)
    return None


def _import(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    analysis = snapshot.file(uri)
    for link in analysis.imports if analysis is not None else ():
        if link.span.contains(offset) and link.problem is None:
            return Hover(describe_import(snapshot, link.uri), link.span)
    return None


def _elsewhere(snapshot: Snapshot, uri: str, offset: int) -> Hover | None:
    found = outside_name_at(snapshot, uri, offset)
    markdown = None if found is None else found.describe()
    return None if found is None or markdown is None else Hover(markdown, found.span)


def _worst_of(definition: Definition, findings: Findings) -> Judged | None:
    """Return the worst result of a variant or of an execution that did not hold."""
    match definition.kind:
        case SymbolKind.VARIANT:
            scenarios = findings.variants.get(definition.iri or "", ())
        case SymbolKind.EXECUTION:
            known = (one for several in findings.variants.values() for one in several)
            scenarios = tuple(one for one in known if one.execution and one.execution == definition.iri)
        case _:
            return None
    every = (
        (scenario, judgement)
        for scenario in scenarios
        for judgement in scenario.clauses.values()
        if judgement.outcome != "holds"
    )
    return min(every, key=lambda judged: judged[1].rank, default=None)
