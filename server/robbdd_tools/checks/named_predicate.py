"""``named-predicate``: the definition of a predicate contradicts itself, or a phrase does not fit the definition."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.quantity_units import QuantityError, read_quantity
from robbdd_tools.checks.finding import article, change, finding, related_to, written_text
from robbdd_tools.names.elements import Site
from robbdd_tools.names.predicate_parameters import Taken, leads_back, predicate_of, taken_by
from robbdd_tools.names.roles import VARIABLES
from robbdd_tools.names.types import kind_words, variable_type
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.predicate_tree import phrase_shape, written_phrase
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.resolve import Resolution
    from robbdd_tools.syntax.declaration import Declaration

CODE = "named-predicate"
_OWNERS = (tree.Template, tree.Story, tree.Variant, tree.NamedPredicate)


def named_predicate(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report definitions of predicates that contradict themselves, and phrases that do not fit them."""
    scope = snapshot.scope(file.document.uri)

    @cache
    def is_predicate(name: str) -> bool:
        return next(scope.declaring(name, SymbolKind.PREDICATE), None) is not None

    for placed in file.parts():
        root = placed.declaration.tree
        if not isinstance(root, _OWNERS):
            continue
        uses = _named_uses(placed.declaration)
        is_definition = isinstance(root, tree.NamedPredicate)
        has_parameters = any(map(is_predicate, _owners(placed.targets.resolution)))
        if not uses and not is_definition and not has_parameters:
            continue
        site = Site(snapshot, file, placed)
        if is_definition:
            yield from _definition(site, root)
        for node in uses:
            yield from _use(site, node)
        if has_parameters:
            yield from _foreign_parameters(site)


@kept_with_key
def _named_uses(declaration: Declaration) -> tuple[tree.NamedUse, ...]:
    """Return the phrases of named predicates in a declaration."""
    root = declaration.tree
    return () if root is None else tuple(node for node in walk(root) if isinstance(node, tree.NamedUse))


@kept_with_key
def _owners(resolution: Resolution) -> frozenset[str]:
    """Return the declarations whose parts a declaration names, such as variables and parameters."""
    paths = (target.path.partition(".") for target in resolution.targets.values())
    return frozenset(owner for owner, dot, _ in paths if dot)


def _definition(site: Site, predicate: tree.NamedPredicate) -> Iterator[Diagnostic]:
    name = predicate.name.text
    if "-" not in name:
        message = (
            f"'{name}' could be a word of another phrase: the name of a predicate has a hyphen, such as 'is-{name}'"
        )
        yield finding(site, predicate.name, Severity.ERROR, CODE, message)
    for node in walk(predicate.body):
        if isinstance(node, tree.NamedUse) and leads_back(site, predicate, node):
            message = f"'{name}' is defined by itself through '{node.predicate.path}': define it by other predicates"
            yield finding(site, node.predicate, Severity.ERROR, CODE, message)
    for ref in (reference.ref for reference in site.placed.declaration.references):
        found = site.target(ref)
        if found is not None and found.kind in VARIABLES:
            message = (
                f"'{ref.path}' is a variable of a template, but a predicate has its own parameters: "
                f"add '<{found.symbol.name}>' to its phrase"
            )
            yield finding(site, ref, Severity.ERROR, CODE, message)
    taken = taken_by(site, predicate)
    for parameter in predicate.parameters:
        yield from _parameter(site, parameter, taken[parameter.name.text])


def _parameter(site: Site, parameter: tree.Parameter, taken: Taken) -> Iterator[Diagnostic]:
    name = parameter.name.text
    if not taken.is_used:
        message = f"the definition does not use '{name}': use it, or remove it from the phrase"
        yield finding(site, parameter.name, Severity.WARNING, CODE, message)
    elif not taken.kinds or len(taken.dimensions) > 1:
        several = " and ".join(sorted(taken.dimensions)) if len(taken.dimensions) > 1 else "things of different kinds"
        message = f"'{name}' stands for {several} in the definition: use two parameters"
        yield finding(site, parameter.name, Severity.ERROR, CODE, message)
    elif len(taken.as_set) > 1:
        message = f"'{name}' stands for a set and for one element of it in the definition: use two parameters"
        yield finding(site, parameter.name, Severity.ERROR, CODE, message)


def _use(site: Site, use: tree.NamedUse) -> Iterator[Diagnostic]:
    known = predicate_of(site, use)
    if known is None:
        return
    home, predicate = known
    related = (related_to(home, predicate.name, "it is defined here"),)
    phrase = written_phrase(predicate)
    if len(use.values) != len(predicate.parameters):
        count = len(predicate.parameters)
        takes = f"{count} value{'' if count == 1 else 's'}, not {len(use.values)}"
        message = f"'{use.predicate.path}' takes {takes}: write '{phrase}'"
        yield finding(site, use, Severity.ERROR, CODE, message, related)
        return
    if phrase_shape(use) != phrase_shape(predicate):
        values = iter(use.values)
        text = " ".join(word or _bracketed(site, next(values)) for word in phrase_shape(predicate))
        message = f"the phrase of '{use.predicate.path}' has other words: write '{phrase}'"
        yield finding(
            site, use, Severity.ERROR, CODE, message, related, (change(site, f"Change to '{text}'", use, text),)
        )
        return
    taken = taken_by(home, predicate)
    for parameter, value in zip(predicate.parameters, use.values, strict=True):
        problem = _problem(site, value, taken[parameter.name.text])
        if problem:
            yield finding(site, value, Severity.ERROR, CODE, f"{problem} in '{phrase}'", related)


def _bracketed(site: Site, value: tree.Argument) -> str:
    text = written_text(site, value)
    return f"<{text}>" if isinstance(value, tree.Ref) else text


def _problem(site: Site, value: tree.Argument, taken: Taken) -> str:
    """Return why a value does not fit a parameter; empty if it does, or if the parameter itself is wrong."""
    if not taken.kinds or len(taken.dimensions) > 1:
        return ""
    if isinstance(value, tree.Quantity):
        for dimension in taken.dimensions:
            try:
                read_quantity(value.text, dimension)
            except QuantityError as error:
                return str(error)
    kinds = _kinds(site, value)
    if kinds and not kinds & taken.kinds:
        shown = value.path if isinstance(value, tree.Ref) else written_text(site, value)
        return f"'{shown}' is {article(kind_words(kinds))}, not {article(kind_words(taken.kinds))},"
    return ""


def _kinds(site: Site, value: tree.Argument) -> frozenset[str]:
    match value:
        case tree.Ref():
            found = site.target(value)
            if found is None:
                return frozenset()
            if found.kind is SymbolKind.PARAMETER:
                own = taken_by(site, site.tree) if isinstance(site.tree, tree.NamedPredicate) else dict[str, Taken]()
                return own[found.symbol.name].kinds if found.symbol.name in own else frozenset()
            if found.kind in VARIABLES:
                return variable_type(site.snapshot, found).kinds
            return frozenset({str(found.kind)})
        case tree.Quantity():
            return frozenset({"quantity"})
        case tree.Number():
            return frozenset({"number"})
        case _:
            return frozenset({"string"})


def _foreign_parameters(site: Site) -> Iterator[Diagnostic]:
    """Report parameters that are used outside the definition of their predicate."""
    for ref in (reference.ref for reference in site.placed.declaration.references):
        found = site.target(ref)
        if found is None or found.kind is not SymbolKind.PARAMETER:
            continue
        if found.uri != site.uri or not site.placed.span.contains(found.span.start):
            message = f"'{ref.path}' is a parameter of another predicate: name a variable or an element"
            yield finding(site, ref, Severity.ERROR, CODE, message)
