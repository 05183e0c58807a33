"""Refactoring: replace a literal of a template by a variable that has this literal as its value in each scenario."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix
from robbdd_tools.base.document import Span
from robbdd_tools.checks.table_edits import columns_added
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.features.refactor_variations import is_headed
from robbdd_tools.names.elements import Site, story_sites
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.checks.template_variants import Scenario
    from robbdd_tools.names.project import Snapshot

_Literal = tree.Number | tree.Quantity | tree.Text


def literal_as_variable(snapshot: Snapshot, uri: str, selected: Span) -> Fix | None:
    """Return the refactoring of the literal at a selection in a template; ``None`` if there is none.

    The template's scenarios must be free of syntax errors, so that each of them gets the value.
    """
    file = snapshot.file(uri)
    placed = next((one for one in file.of(tree.Template) if one.span.contains(selected.start)), None) if file else None
    if file is None or placed is None or placed.declaration.faults:
        return None
    site, template = Site(snapshot, file, placed), placed.declaration.tree
    if not isinstance(template, tree.Template):
        return None
    found = [(one, base) for one, base in _literals(template) if _is_at(site.span(one), selected)]
    if len(found) != 1:
        return None
    literal, base = found[0]
    name = _free(site, base)
    span = site.span(literal)
    value = file.document.text[span.start : span.end]
    edits = [Edit(uri, span, f"<{name}>"), _declared(site, template, name)]
    for scenario in _scenarios_of(site, template):
        own = None if scenario is None else _valued(scenario, f"<{template.name.text}.{name}>", value)
        if not own:
            return None
        edits += own
    return Fix(f"Turn {value} into the variable '{name}'", tuple(edits))


def _literals(template: tree.Template) -> Iterator[tuple[_Literal, str]]:
    """Yield the literals that a variable may replace, each with a name for the variable."""
    for node in walk(template):
        match node:
            case tree.PhraseUse():
                written = dict(node.arguments)
                named = next((one.text for one in written.values() if isinstance(one, tree.Name)), None)
                values = ((one, named or slot) for slot, one in node.arguments)
            case tree.NamedUse():
                values = ((piece.value, piece.words[-1].text if piece.words else "value") for piece in node.pieces)
            case tree.TextArgument():
                values = ((node.value, node.name.text),)
            case tree.Before() | tree.After():
                values = ((node.horizon, "duration"),)
            case tree.DefinedEvent():
                values = ((node.seconds, "duration"),)
            case _:
                continue
        yield from ((one, base) for one, base in values if isinstance(one, _Literal))


def _is_at(span: Span, selected: Span) -> bool:
    return span.start <= selected.start and selected.end <= span.end


def _free(site: Site, base: str) -> str:
    """Return a name that is unused in the file, because templates of a namespace share variables by name."""
    taken = {path.rpartition(".")[2] for path in site.file.definitions}
    return next(name for number in count(1) if (name := base if number == 1 else f"{base}-{number}") not in taken)


def _declared(site: Site, template: tree.Template, name: str) -> Edit:
    """Return the edit that declares a variable after the last one, or before the first clause."""
    document = site.file.document
    last = template.variables[-1] if template.variables else None
    start = site.span(last or (template.events[0] if template.events else template.body)).start
    begin = document.line_starts[document.position(start).line]
    indent = document.text[begin:start]
    line = f"\n{indent}" if not indent.strip() else " "
    if last is None:
        return Edit(site.uri, Span(start, start), f"var {name}{line}")
    end = site.span(last).end
    return Edit(site.uri, Span(end, end), f"{line}var {name}")


def _scenarios_of(site: Site, template: tree.Template) -> Iterator[Scenario | None]:
    """Yield the scenarios of a template in all loaded files; ``None`` for a story with a syntax error."""
    own = site.file.definitions.get(template.name.text)
    for uri in (site.uri, *site.snapshot.importers(site.uri)):
        file = site.snapshot.file(uri)
        for story in story_sites(site.snapshot, file) if file is not None else ():
            if story.placed.declaration.faults:
                yield None
                continue
            for scenario in scenarios(story):
                if story.target(scenario.variant.template) == own:
                    yield scenario


def _valued(scenario: Scenario, variable: str, value: str) -> tuple[Edit, ...]:
    """Return the edits that give a variable a value in a scenario; none if its variation cannot be extended."""
    site, variation = scenario.site, scenario.variant.variation
    if isinstance(variation, tree.Table):
        return columns_added(site, variation, [variable], [value])
    if not variation.assignments or not is_headed(scenario):
        return ()
    document, last = site.file.document, site.span(variation.assignments[-1])
    indent = document.text[document.line_starts[document.position(last.start).line] : last.start]
    line = f"\n{indent}" if not indent.strip() else " "
    return (Edit(site.uri, Span(last.end, last.end), f"{line}var {variable}: {{ {value} }}"),)
