"""``single-element``: a behaviour gets a set in a slot for one element. Only a slot for a place accepts a set."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Related, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import finding
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site
    from robbdd_tools.syntax.declaration import Declaration

CODE = "single-element"


def single_element(site: Site) -> Iterator[Diagnostic]:
    """Report each set variable in a slot of a template's behaviour that needs a single element."""
    for action in _actions(site.placed.declaration):
        behaviour = load_catalog().behaviours[action.word]
        kinds = {slot.name: slot.kind for slot in behaviour.slots}
        for name, ref in action.arguments:
            if not isinstance(ref, tree.Ref) or kinds[name] is Kind.WORKSPACE:
                continue
            target = site.target(ref)
            if target is None or target.kind is not SymbolKind.SET_VARIABLE:
                continue
            message = needs_one(behaviour.name, name, ref.path)
            related = (Related(target.uri, target.span, "declared as a set"),)
            yield finding(site, ref, Severity.WARNING, CODE, message, related)


def needs_one(behaviour: str, slot: str, variable: str) -> str:
    """Return the message on a set in a slot of a behaviour that needs a single element."""
    return (
        f"'{behaviour}' needs one {slot}, but '{variable}' is a set: declare it as 'var', "
        f"or write 'for all ( var x in <{variable}> ) {{ … }}' around the behaviour"
    )


@kept_with_key
def _actions(declaration: Declaration) -> tuple[tree.PhraseUse, ...]:
    root = declaration.tree
    if not isinstance(root, tree.Template):
        return ()
    return tuple(node.action for node in walk(root) if isinstance(node, tree.BehaviourUse))
