"""``emission``: ``emits … as …`` names an event that the behaviour does not have, or the same event twice."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import MAX_OFFERED, change, finding
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site
    from robbdd_tools.syntax.declaration import Declaration

CODE = "emission"


def emission(site: Site) -> Iterator[Diagnostic]:
    """Report each unknown or repeated event in the ``emits`` of a template's behaviours."""
    for use in _uses(site.placed.declaration):
        events = load_catalog().behaviours[use.action.word].events
        for one in use.emissions:
            if one.moment.text not in events:
                near = get_close_matches(one.moment.text, events, n=MAX_OFFERED, cutoff=0.0)
                message = f"'{use.action.word}' does not emit '{one.moment.text}': it emits {', '.join(events)}"
                fixes = tuple(change(site, f"Change to '{name}'", one.moment, name) for name in near)
                yield finding(site, one.moment, Severity.ERROR, CODE, message, fixes=fixes)
        seen: set[str] = set()
        for one in use.emissions:
            if one.event.path in seen:
                message = f"'{one.event.path}' is already emitted as another event of the behaviour: name one event"
                yield finding(site, one.event, Severity.ERROR, CODE, message)
            seen.add(one.event.path)


@kept_with_key
def _uses(declaration: Declaration) -> tuple[tree.BehaviourUse, ...]:
    """Return the behaviours of a template that have ``emits``."""
    root = declaration.tree
    if not isinstance(root, tree.Template):
        return ()
    return tuple(node for node in walk(root) if isinstance(node, tree.BehaviourUse) and node.emissions)
