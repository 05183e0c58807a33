"""``hidden-variable``: a quantifier's variable has the name of another variable, so that both have one IRI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Related, Severity
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.problems import free_name
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import children, walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.base.document import Span
    from robbdd_tools.checks.template_variants import Scenario
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site

CODE = "hidden-variable"
_Quantifier = tree.ForAll | tree.Exists


def hidden_variable(site: Site) -> Iterator[Diagnostic]:
    """Report quantifiers of a template or variant whose variable hides another variable, or shares its IRI."""
    root = site.tree
    if isinstance(root, tree.Template):
        if site.whole(root):
            declared = {variable.name.text: variable.name for variable in root.variables}
            yield from _hiding(site, root.body, declared, {})
        return
    for scenario in scenarios(site):
        for part in (scenario.variant.given, scenario.variant.then):
            if part is not None:
                yield from _hiding(site, part, {}, {})
                yield from _sharing(scenario, part)


def _hiding(
    site: Site, node: tree.Node, declared: Mapping[str, tree.Name], bound: Mapping[str, tree.Name]
) -> Iterator[Diagnostic]:
    """Report the quantifiers in a node. ``declared`` are the template's variables, ``bound`` the outer ones."""
    if isinstance(node, _Quantifier):
        name = node.variable.text
        hidden = bound.get(name) or declared.get(name)
        if hidden is not None:
            whose = "of a quantifier around this one" if name in bound else "of the template"
            message = (
                f"'{name}' is also a variable {whose}: in these braces it means an element of the set, and both are "
                "one node of the graph, so give one of them another name"
            )
            related = (related_to(site, hidden, "the other variable"),)
            yield finding(site, node.variable, Severity.WARNING, CODE, message, related, (_renamed(site, node),))
        bound = {**bound, name: node.variable}
    for child in children(node):
        yield from _hiding(site, child, declared, bound)


def _sharing(scenario: Scenario, part: tree.Expression) -> Iterator[Diagnostic]:
    """Report the quantifiers of a variant whose variable has the IRI of a variable of the template."""
    site = scenario.site
    by_iri = {variable.iri: variable for variable in scenario.declared().values() if variable.iri is not None}
    for node in walk(part):
        if not isinstance(node, tree.Exists):
            continue
        own = _definition(site, node.variable)
        other = None if own is None or own.iri is None else by_iri.get(own.iri)
        if other is not None:
            path = other.symbol.path
            uses = any(isinstance(ref, tree.Ref) and ref.path == path for ref in walk(node.body))
            meaning = f"'<{path}>' would mean an element of the set here" if uses else "both are one node of the graph"
            message = (
                f"'{node.variable.text}' has the IRI of the template's '{path}': {meaning}, so give it another name"
            )
            related = (Related(other.uri, other.span, "the other variable"),)
            severity = Severity.ERROR if uses else Severity.WARNING
            yield finding(site, node.variable, severity, CODE, message, related, (_renamed(site, node),))


def _definition(site: Site, name: tree.Name) -> Definition | None:
    found = (one.path for one in site.placed.declaration.symbols if one.span == name.span)
    return next(map(site.file.definitions.get, found), None)


def _renamed(site: Site, quantifier: _Quantifier) -> Fix:
    """Return the fix that gives the quantifier's variable a name that the file does not have yet."""
    name = quantifier.variable.text
    free = free_name(name, site.file.definitions)
    places = [quantifier.variable.span, *_uses(quantifier.body, name)]
    edits = tuple(Edit(site.uri, span.shifted(site.placed.offset), free) for span in places)
    return Fix(f"Rename it to '{free}'", edits)


def _uses(node: tree.Node, name: str) -> Iterator[Span]:
    """Yield the places of a variable in its quantifier's body, but not inside inner quantifiers that hide it."""
    if isinstance(node, tree.Ref) and node.path == name:
        yield node.span
    hides = isinstance(node, _Quantifier) and node.variable.text == name
    for child in children(node) if not hides or not isinstance(node, _Quantifier) else (node.in_set,):
        yield from _uses(child, name)
