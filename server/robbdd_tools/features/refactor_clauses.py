"""Refactoring: move clauses of a variant into its template.

If other variants share the template, the clauses are moved into a copy of it. The scenarios stay the same. In the
graph, the clauses belong to the template afterwards.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import compress, count
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.features.clause_edits import additions, changed, column, operands, removals, unindented
from robbdd_tools.names.elements import Site
from robbdd_tools.names.index import FileIndex
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.features.clause_edits import Change
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


@dataclass(frozen=True, slots=True)
class _Part:
    """The clauses to remove from a ``Given`` or ``Then``, and the absolute spans to delete with them."""

    label: str
    clauses: tuple[tree.Expression, ...]
    removed: tuple[Span, ...]


@dataclass(frozen=True, slots=True)
class _Move:
    """The clauses to move out of a variant in the story ``site``, and the place of the variant's template."""

    site: Site
    variant: tree.Variant
    template: Site
    root: tree.Template
    definition: Definition
    parts: tuple[_Part, ...]


def extracted_clauses(snapshot: Snapshot, uri: str, selected: Span) -> Fix | None:
    """Return the fix that moves the selected clauses of a variant into its template.

    If nothing is selected, all clauses of the variant are moved. If the template has other variants or is in another
    file, the clauses are moved into a copy of it. If executions of the variant name policies, ``None`` is returned,
    because the policies refer to clauses and variables of the original template.
    """
    move = _move(snapshot, uri, selected)
    if move is None:
        return None
    is_alone = len(list(_leading_to(snapshot, move.definition))) == 1
    if is_alone and move.template.uri == uri:
        return _into_template(move)
    return None if _has_policies(move) else _into_copy(move)


def _move(snapshot: Snapshot, uri: str, selected: Span) -> _Move | None:
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        if file is None or not placed.span.contains(selected.start):
            continue
        site = Site(snapshot, file, placed)
        for scenario in scenarios(site) if isinstance(site.tree, tree.Story) else ():
            if site.span(scenario.variant).contains(selected.start):
                return _of_scenario(site, scenario, selected)
    return None


def _of_scenario(site: Site, scenario: Scenario, selected: Span) -> _Move | None:
    variant, template = scenario.variant, scenario.template
    definition = site.target(variant.template)
    if template is None or definition is None or not isinstance(template.tree, tree.Template):
        return None
    found = (_part(site, "Given", variant, selected), _part(site, "Then", variant, selected))
    parts = tuple(part for part in found if part is not None)
    return _Move(site, variant, template, template.tree, definition, parts) if parts else None


def _part(site: Site, label: str, variant: tree.Variant, selected: Span) -> _Part | None:
    """Return the selected clauses of one part. Return ``None`` if there are none or if a comment would be lost."""
    own = variant.given if label == "Given" else variant.then
    if own is None:
        return None
    clauses, text = operands(own), site.file.document.text
    spans = [site.span(clause) for clause in clauses]
    taken = [
        selected.start == selected.end or (span.start < selected.end and selected.start < span.end) for span in spans
    ]
    labelled = _label(site, label, variant, own)
    if not any(taken) or labelled is None:
        return None
    removed = (_with_line(text, Span(labelled, site.span(own).end)),) if all(taken) else tuple(removals(spans, taken))
    lost = "".join(text[span.start : span.end] for span in removed)
    for span in compress(spans, taken):
        lost = lost.replace(text[span.start : span.end], "", 1)
    return None if "//" in lost else _Part(label, tuple(compress(clauses, taken)), removed)


def _label(site: Site, label: str, variant: tree.Variant, own: tree.Expression) -> int | None:
    """Return the start of the label of a part, including the white space before it."""
    before = [variant.scene, *(variant.events if label == "Then" else ())]
    start = site.span(before[-1]).end
    found = re.compile(rf"[ \t]*\b{label}\s*:").search(site.file.document.text, start, site.span(own).start)
    return None if found is None else found.start()


def _with_line(text: str, span: Span) -> Span:
    """Return a span extended to the end of its line, unless other text follows it on that line."""
    line = text.find("\n", span.end)
    return Span(span.start, line + 1) if line >= 0 and not text[span.end : line].strip() else span


def _into_template(move: _Move) -> Fix:
    name, target = move.root.name.text, move.template
    arriving = [Edit(target.uri, span.shifted(target.placed.offset), text) for span, text in _arriving(move, {})]
    return Fix(f"Move the clauses to the template '{name}'", (*_leaving(move, name), *arriving))


def _into_copy(move: _Move) -> Fix | None:
    site, target, root, story = move.site, move.template, move.root, move.site.tree
    inner = [
        node.name for node in walk(root) if isinstance(node, tree.Fluent) and node.name.span.start < node.name.span.end
    ]
    suffix = _free_suffix(site.snapshot, [root.name.text, *(name.text for name in inner)])
    name = root.name.text + suffix
    inside = _renamed(target, root, move, name)
    outside = _renamed(site, move.variant, move, name)
    if inside is None or outside is None or not isinstance(story, tree.Story):
        return None
    begin = (root.name if root.namespace is None else root.namespace).span.start
    namespace = "" if story.namespace is None else f"{_text(site, story.namespace)} "
    changes: list[Change] = [(Span(begin, root.name.span.end), namespace + name)]
    changes += [(Span(fluent.span.end, fluent.span.end), suffix) for fluent in inner]
    changes += [(ref.span, path) for ref, path in inside.items()]
    changes += _arriving(move, outside)
    copied = changed(target.placed.declaration.text, root.span, changes)
    start = site.span(story).start
    gone = [span for part in move.parts for span in part.removed]
    staying = [(site.span(ref), path) for ref, path in outside.items()]
    edits = [
        Edit(site.uri, Span(start, start), f"{copied}\n\n"),
        *_leaving(move, name),
        *(Edit(site.uri, span, path) for span, path in staying if not any(one.contains(span.start) for one in gone)),
    ]
    return Fix(f"Extract the clauses to a new template '{name}'", tuple(edits))


def _leaving(move: _Move, template: str) -> Iterator[Edit]:
    """Yield the edits that remove the clauses from the variant, and remove references to them in other places."""
    site = move.site
    for part in move.parts:
        yield from (Edit(site.uri, span, "") for span in part.removed)
    clauses = [clause for part in move.parts for clause in part.clauses]
    moved = {site.span(node.name) for clause in clauses for node in walk(clause) if isinstance(node, tree.Fluent)}
    for definition in site.file.definitions.values():
        if definition.span in moved:
            for uri, span in _leading_to(site.snapshot, definition):
                yield Edit(uri, span, f"{template}.{definition.symbol.name}")


def _arriving(move: _Move, paths: Mapping[tree.Ref, str]) -> Iterator[Change]:
    """Yield the edits that insert the clauses into the template. References in ``paths`` get new paths."""
    text = move.site.placed.declaration.text
    for part in move.parts:
        texts: list[str] = []
        for clause in part.clauses:
            inside = [(ref.span, path) for ref, path in paths.items() if clause.span.contains(ref.span.start)]
            indent = column(move.site, clause.span.start)
            texts.append(unindented(changed(text, clause.span, inside), indent))
        yield from additions(move.template, move.root.body, part.label, texts)


def _renamed(site: Site, owner: tree.Node, move: _Move, name: str) -> dict[tree.Ref, str] | None:
    """Return new paths for the references in a node to the moved template or to a part of it.

    Returns ``None`` if a reference does not start with the template's name.
    """
    old, found = move.root.name.text, dict[tree.Ref, str]()
    for reference in site.placed.declaration.references:
        ref = reference.ref
        target = site.target(ref)
        if not owner.span.contains(ref.span.start) or target is None or target.uri != move.template.uri:
            continue
        if f"{target.symbol.path}.".startswith(f"{old}."):
            if f"{ref.path}.".startswith(f"{old}."):
                found[ref] = name + ref.path[len(old) :]
            elif owner is not move.root:
                return None
    return found


def _leading_to(snapshot: Snapshot, definition: Definition) -> Iterator[tuple[str, Span]]:
    """Yield each reference to a definition itself, with the span of the reference's whole path."""
    for uri in (definition.uri, *snapshot.importers(definition.uri)):
        file = snapshot.file(uri)
        for placed in file.declarations if file is not None else ():
            for ref in placed.targets:
                if definition.symbol.name in ref.path and placed.targets[ref] == definition:
                    yield uri, ref.span.shifted(placed.offset)


def _free_suffix(snapshot: Snapshot, names: Sequence[str]) -> str:
    """Return the first suffix in ``-2``, ``-3`` … with which none of the names is used in the project."""
    indices = [source for source in snapshot.sources.values() if isinstance(source, FileIndex)]
    taken = {path.rpartition(".")[2] for index in indices for path in index.names.entries}
    return next(suffix for suffix in map("-{}".format, count(2)) if taken.isdisjoint(name + suffix for name in names))


def _has_policies(move: _Move) -> bool:
    """Return whether an execution of the variant names policies."""
    snapshot, span = move.site.snapshot, move.site.span(move.variant.name)
    for uri in snapshot.importers(move.site.uri):
        file = snapshot.file(uri)
        for placed in file.declarations if file is not None else ():
            root = placed.declaration.tree
            target = placed.targets.get(root.variant) if isinstance(root, tree.Execution) and root.policies else None
            if target is not None and (target.uri, target.span) == (move.site.uri, span):
                return True
    return False


def _text(site: Site, node: tree.Node) -> str:
    span = site.span(node)
    return site.file.document.text[span.start : span.end]
