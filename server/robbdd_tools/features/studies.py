"""Names in a study: the scenarios and implementations of behaviours that its models declare."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.features.executions import executions_of
from robbdd_tools.names.index import language_of
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.study_content import STUDY
from robbdd_tools.syntax.study_text import read_study

if TYPE_CHECKING:
    from robbdd_tools.base.document import Document
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.study_content import Word

_LOCAL = re.compile(r"[^:/#<>]*$")
"""The local name at the end of a CURIE or an IRI."""


def is_study(uri: str) -> bool:
    """Return whether a file is a study."""
    return language_of(uri) == STUDY


def scenarios_of_study(snapshot: Snapshot, uri: str) -> Mapping[str, Definition]:
    """Return the variants and executions that a study may name, by local name.

    As in a run, a variant of a model with executions can be named only if it is executed.
    """
    found: dict[str, Definition] = {}
    for model in _models(snapshot, uri):
        files = [file.document.uri for file in snapshot.closure(model)]
        executions = [one for file in files for one in executions_of(snapshot, file)]
        executed = {one.variant.iri for one in executions}
        variants = [one for file in files for one in variants_of(snapshot, file)]
        for definition in (
            *(one.definition for one in executions),
            *(one.definition for one in variants if not executions or one.iri in executed),
        ):
            found.setdefault(definition.symbol.name, definition)
    return found


def implementations_of_study(snapshot: Snapshot, uri: str) -> Mapping[str, Definition]:
    """Return the implementations of behaviours that a study may replace by others, by local name."""
    found: dict[str, Definition] = {}
    for definition in _definitions(snapshot, uri, SymbolKind.IMPLEMENTATION):
        found.setdefault(definition.symbol.name, definition)
    return found


def variables_of_study(snapshot: Snapshot, uri: str) -> Mapping[str, Definition]:
    """Return the variables to which a study may give a range, by local name and with their templates (``pick.height``).

    If several templates have a variable of the same local name, the local name stands for all of these variables, but
    its definition is the first one.
    """
    found: dict[str, Definition] = {}
    for definition in _definitions(snapshot, uri, SymbolKind.VARIABLE):
        found.setdefault(definition.symbol.name, definition)
        found.setdefault(definition.symbol.path, definition)
    return found


def study_name_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, Definition] | None:
    """Return the local name of a scenario or an implementation at an offset of a study, and its definition."""
    found = ((span, target) for span, target in _names(snapshot, uri) if span.contains(offset))
    return next(found, None)


def uses_in_study(snapshot: Snapshot, uri: str, definition: Definition) -> Iterator[Span]:
    """Yield the places where a study names a scenario or an implementation."""
    for span, target in _names(snapshot, uri):
        if (target.uri, target.symbol.path) == (definition.uri, definition.symbol.path):
            yield span


def _names(snapshot: Snapshot, uri: str) -> Iterator[tuple[Span, Definition]]:
    document = snapshot.document(uri)
    content = read_study(document)[0]
    named = [word for one in content.factors for word in (one.implementation, *one.levels)]
    implementations = [word for word in named if word is not None and word.is_name]
    for words, known_in in (
        (content.scenarios, scenarios_of_study),
        (implementations, implementations_of_study),
    ):
        if words:
            known = known_in(snapshot, uri)
            for word in words:
                yield from _target(document, word, known)
    if content.ranges:
        variables = variables_of_study(snapshot, uri)
        templates = {one.symbol.name: one for one in _definitions(snapshot, uri, SymbolKind.TEMPLATE)}
        for one in content.ranges:
            yield from _target(document, one.variable, variables)
            yield from _template(document, one.variable, templates)


def _template(document: Document, word: Word, known: Mapping[str, Definition]) -> Iterator[tuple[Span, Definition]]:
    """Yield the place and the definition of the template in the name of a variable, if any."""
    template, dot, _ = word.text.rpartition(".")
    if dot and template in known:
        start = document.text.index(word.text, word.span.start)
        yield Span(start, start + len(template)), known[template]


def _target(document: Document, word: Word, known: Mapping[str, Definition]) -> Iterator[tuple[Span, Definition]]:
    """Yield the place of the local name in a reference, and its definition, if the definition is known."""
    local = _LOCAL.search(word.text)
    target = known.get(local[0]) if local is not None else None
    if local is None or target is None or (":" in word.text and not _is_of(word.text, target)):
        return
    end = document.text.index(word.text, word.span.start) + len(word.text)
    yield Span(end - len(local[0].rpartition(".")[2]), end), target


def _is_of(written: str, target: Definition) -> bool:
    """Return whether a CURIE or IRI may denote a definition. The prefixes of the graph are not known here."""
    return target.iri == written or "/" not in written


def _definitions(snapshot: Snapshot, uri: str, kind: SymbolKind) -> Iterator[Definition]:
    """Yield the definitions of a kind in the models of a study and in their imports."""
    for model in _models(snapshot, uri):
        for file in snapshot.closure(model):
            yield from (one for one in file.definitions.values() if one.kind is kind)


def _models(snapshot: Snapshot, uri: str) -> Iterator[str]:
    """Yield the models that a study imports and that can be read."""
    file = snapshot.file(uri)
    for link in file.imports if file is not None else ():
        if link.problem is None and language_of(link.uri) in ("bdd", "bddx") and snapshot.file(link.uri) is not None:
            yield link.uri
