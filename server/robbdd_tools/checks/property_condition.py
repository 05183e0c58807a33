"""``property-condition``: ``where`` selects no element, or compares a property with a value of another kind."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.property_conditions import EQUAL, Properties, PropertyCondition
from robbdd_tools.base.property_values import TEXT
from robbdd_tools.checks.chosen_elements import iri_of
from robbdd_tools.checks.finding import MAX_OFFERED, article, change, finding, listed
from robbdd_tools.graph.property_facts import conditions_of, properties_by_element
from robbdd_tools.names.elements import Site, elements_of
from robbdd_tools.names.suggest import similar
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic, Fix
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "property-condition"
NAME = re.compile(r"[^\W\d][\w\-]*")
Known = list[tuple[str, Properties]]
"""The elements of a set by name, with their properties."""
Selected = tuple[tree.Ref, tree.Where]


def property_condition(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report faulty conditions in a file, each at most once."""
    if "where" not in file.document.text:
        return
    for placed in file.parts():
        for ref, where in _selected(placed.declaration):
            yield from _findings(Site(snapshot, file, placed), ref, where)


@kept_with_key
def _selected(declaration: Declaration) -> tuple[Selected, ...]:
    """Return the sets of a declaration from which conditions select elements."""
    found: list[Selected] = []
    for node in walk(declaration.tree) if declaration.tree is not None else ():
        match node:
            case tree.Link(reference=ref, where=tree.Where() as where):
                found.append((ref, where))
            case tree.Selection(source=ref, where=tree.Where() as where):
                found.append((ref, where))
            case tree.ForAll(in_set=ref, where=tree.Where() as where):
                found.append((ref, where))
            case tree.Exists(in_set=ref, where=tree.Where() as where):
                found.append((ref, where))
            case _:
                pass
    return tuple(found)


def _findings(site: Site, ref: tree.Ref, where: tree.Where) -> Iterator[Diagnostic]:
    target = site.target(ref)
    if target is not None and target.kind is SymbolKind.SET_VARIABLE:
        message = (
            f"'{ref.path}' is a variable, whose elements are not known here: write the condition where the variable "
            "gets its values, as in 'select 2 combinations from <set> where …'"
        )
        yield finding(site, where, Severity.ERROR, CODE, message)
        return
    known = properties_in(site, site.follow(ref))
    conditions = conditions_of(site.placed, where)
    if not known or conditions is None:
        return  # Other rules report an empty set and an unknown name.
    found = [
        one for pair in zip(where.conditions, conditions, strict=True) for one in _condition(site, ref, *pair, known)
    ]
    yield from found
    is_explained = any(one.severity is Severity.ERROR for one in found)
    if not is_explained and not any(all(one.holds(has) for one in conditions) for _, has in known):
        words = " and ".join(map(str, conditions))
        message = f"no element of '{ref.path}' satisfies '{words}': correct the condition, or state the property"
        yield finding(site, where, Severity.ERROR, CODE, message, fixes=tuple(_values(site, where, conditions, known)))


def _condition(
    site: Site, ref: tree.Ref, written: tree.PropertyCondition, condition: PropertyCondition, known: Known
) -> Iterator[Diagnostic]:
    """Yield the finding on a condition: unknown property, values of another kind, or elements without the property."""
    name = condition.name
    values = [value for _, has in known for value in has.get(name, ())]
    if not values:
        yield unknown_property(site, ref, written.name, known, Severity.ERROR, CODE)
        return
    other = next((value for value in values if not condition.compares(value)), None)
    if other is not None:
        kind = f"'{other.text}', {article(other.measures)}"
        wanted = (
            "compare it with '=' or '!='"
            if other.measures == condition.value.measures
            else "compare values of one kind"
        )
        message = f"'{name}' has the value {kind}, which cannot be compared with '{condition.value.text}': {wanted}"
        yield finding(site, written, Severity.ERROR, CODE, message)
        return
    lacking = [element for element, has in known if not has.get(name)]
    if lacking and written.value is not None:
        shown = listed(lacking[:MAX_OFFERED]) + (" and others" if len(lacking) > MAX_OFFERED else "")
        message = f"{shown} of '{ref.path}' without a '{name}' cannot be selected: state the property for each element"
        yield finding(site, written.name, Severity.INFORMATION, CODE, message)


def unknown_property(
    site: Site, ref: tree.Ref, name: tree.Name, known: Known, severity: Severity, code: str
) -> Diagnostic:
    """Return the finding on a property that no element of a set has, with similar names as fixes."""
    near = similar(name.text, sorted({other for _, has in known for other in has}))[:MAX_OFFERED]
    hint = f"did you mean '{near[0]}'?" if near else "state it in the scene, or in an imported graph"
    fixes = tuple(change(site, f"Change to '{one}'", name, one) for one in near)
    message = f"no element of '{ref.path}' has the property '{name.text}': {hint}"
    return finding(site, name, severity, code, message, fixes=fixes)


def properties_in(site: Site, declared: Site | None) -> Known:
    """Return the elements of the set that ``declared`` declares, with what ``site`` knows of them; empty if unknown."""
    everything = properties_by_element(site.snapshot, site.uri)
    elements = elements_of(declared) or ()
    return [(element.name, everything.get(iri_of(site, element), {})) for element in elements]


def _values(site: Site, where: tree.Where, conditions: tuple[PropertyCondition, ...], known: Known) -> Iterator[Fix]:
    """Yield fixes that replace a word by a similar one that some element has as its value."""
    for written, condition in zip(where.conditions, conditions, strict=True):
        words = {value.text for _, has in known for value in has.get(condition.name, ()) if value.kind == TEXT}
        near = similar(condition.value.text, sorted(words)) if condition.value.kind == TEXT else ()
        for word in near[:MAX_OFFERED]:
            if written.value is not None and NAME.fullmatch(word) and condition.comparison == EQUAL:
                yield change(site, f"Change to '{word}'", written.value, word)
