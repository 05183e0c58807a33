"""``defined-event``: a behaviour or the scenario should emit an event that occurs according to its own definition."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.names.elements import site_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "defined-event"


def defined_event(site: Site) -> Iterator[Diagnostic]:
    """Report events with a definition in ``emits``, and at the start or end of a scenario or behaviour."""
    template = site.tree
    if not isinstance(template, tree.Template):
        return
    for ref, emitter in _emitted(template):
        event = _definition(site, ref)
        if event is not None:
            message = (
                f"'{ref.path}' occurs when its conditions become true, so {emitter} cannot emit it: name another event"
            )
            yield finding(site, ref, Severity.ERROR, CODE, message, (related_to(*event, "it is defined here"),))


def _emitted(template: tree.Template) -> Iterator[tuple[tree.Ref, str]]:
    """Yield the events that a template expects to be emitted, each with its emitter in words."""
    if template.duration is not None:
        yield from ((ref, "the scenario") for ref in (template.duration.start, template.duration.end))
    for use in walk(template.body):
        if isinstance(use, tree.BehaviourUse):
            limits = () if use.duration is None else (use.duration.start, use.duration.end)
            for ref in (*limits, *(emission.event for emission in use.emissions)):
                yield ref, "a behaviour"


def _definition(site: Site, ref: tree.Ref) -> tuple[Site, tree.Name] | None:
    """Return the name of an event in its definition, or ``None`` if the event has no definition."""
    target = site.target(ref)
    owner = None if target is None else site_of(site.snapshot, target)
    if target is None or owner is None or not isinstance(owner.tree, tree.Template):
        return None
    names = (event.name for event in owner.tree.events)
    return next(((owner, name) for name in names if owner.span(name) == target.span), None)
