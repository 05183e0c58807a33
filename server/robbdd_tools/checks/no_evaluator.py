"""``no-evaluator``: neither a step function nor an observation policy judges the free text of a clause."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import uri_to_path
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.step_files import may_define
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.said_texts import said_phrases
from robbdd_tools.names.elements import Site
from robbdd_tools.names.index import language_of
from robbdd_tools.protocol.time_words import instant_words, interval_words
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.predicate_tree import phrase_shape
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "no-evaluator"
FreeClause = tree.Fluent | tree.TextClause
_SLOT = re.compile(r"\{\w[\w-]*\}")


@dataclass(frozen=True, slots=True)
class Unjudged:
    """A free-text clause that nothing evaluates. ``span`` is the span of its text."""

    placed: PlacedDeclaration
    clause: FreeClause
    span: Span


def no_evaluator(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such clause at its text."""
    for found in unjudged(snapshot, file):
        if said_phrases(Site(snapshot, file, found.placed), found.clause):
            continue
        message = needs_evaluator(may_have_policy=isinstance(found.clause, tree.Fluent))
        yield Diagnostic(file.document.uri, found.span, Severity.WARNING, CODE, message)


def needs_evaluator(*, may_have_policy: bool) -> str:
    """Return the message on a text that nothing evaluates."""
    ways = "a step function or a policy in a .bddx" if may_have_policy else "a step function"
    return f"nothing judges this text, so the clause stays unknown: it needs {ways}"


def unjudged(snapshot: Snapshot, file: FileAnalysis) -> list[Unjudged]:
    """Return the free-text clauses that nothing evaluates, in text order."""
    clauses = [(placed, clause) for placed in file.parts() for clause in _free_clauses(placed.declaration)]
    if not clauses:
        return []
    uri = file.document.uri
    judged = frozenset(_judged_by_policies(snapshot, uri))
    users = (uri, *(name for name in snapshot.importers(uri) if language_of(name) == "bdd"))
    models = [path for path in map(uri_to_path, users) if path is not None]
    found: list[Unjudged] = []
    for placed, clause in clauses:
        if isinstance(clause, tree.Fluent) and clause.name.span.shifted(placed.offset) in judged:
            continue
        sentence = _sentence(clause)
        if not any(may_define(model, sentence) for model in models):
            found.append(Unjudged(placed, clause, text_of(clause).span.shifted(placed.offset)))
    return found


def text_of(clause: FreeClause) -> tree.Text:
    """Return the free text of a clause."""
    if isinstance(clause, tree.TextClause):
        return clause.text
    assert isinstance(clause.predicate, tree.TextPredicate)
    return clause.predicate.template


@kept_with_key
def _free_clauses(declaration: Declaration) -> tuple[FreeClause, ...]:
    root = declaration.tree
    found: list[FreeClause] = []
    for node in walk(root) if isinstance(root, tree.Template | tree.Story | tree.Variant) else ():
        match node:
            case tree.TextClause() | tree.Fluent(predicate=tree.TextPredicate()) if text_of(node).value.strip():
                found.append(node)
            case _:
                pass
    return tuple(found)


def _judged_by_policies(snapshot: Snapshot, uri: str) -> Iterator[Span]:
    """Yield the names of the clauses of a file for which some loaded ``.bddx`` has a policy."""
    for importer in snapshot.importers(uri):
        file = snapshot.file(importer) if language_of(importer) == "bddx" else None
        for placed in file.declarations if file is not None else ():
            if isinstance(placed.declaration.tree, tree.Policy):
                clause = placed.targets.get(placed.declaration.tree.fluent)
                if clause is not None and clause.uri == uri:
                    yield clause.span


def _sentence(clause: FreeClause) -> str:
    conditions = clause.conditions if isinstance(clause, tree.Fluent) else ()
    return sample_sentence(
        text_of(clause).value, _time_words(clause.time), [_condition_sentence(one) for one in conditions]
    )


def _condition_sentence(condition: tree.PhraseUse | tree.NamedUse) -> str:
    if isinstance(condition, tree.NamedUse):
        return " ".join(word or '"{value}"' for word in phrase_shape(condition))
    return load_catalog().predicates[condition.word].sentence


def _time_words(time: tree.TimeConstraint) -> str:
    if isinstance(time, tree.During):
        return interval_words("x", "x", time.some_time)
    relation = "before" if isinstance(time, tree.Before) else "after"
    seconds = f"{time.horizon.value:g}" if isinstance(time.horizon, tree.Number) else time.horizon and "1"
    return instant_words(relation, "x", seconds, time.some_time, time.which)


def sample_sentence(text: str, time: str, conditions: Sequence[str] = ()) -> str:
    """Return the sentence of a step for a text, as in a feature, with sample words for values.

    ``time`` are the words of its time constraint, with sample words for events. ``conditions`` are the sentences of
    its conditions.
    """
    stated = _SLOT.sub('"x"', text.strip().replace("\\", "\\\\"))
    if conditions:
        stated += f" whenever {_SLOT.sub('x', ' and '.join(conditions))}"
    return f"{stated} {time}"
