"""``no-emitter``: nothing in the scenario emits an event to which a clause refers, so the clause stays unknown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import MAX_OFFERED, change, finding
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Site

CODE = "no-emitter"
Key = tuple[str, str]


@dataclass(slots=True)
class _Emitters:
    """The events that an execution of a template emits.

    ``bound`` maps defined events, events in ``emits``, and events that delimit the scenario or a behaviour to their
    names. ``inner`` are the catalog names of the behaviours' own events. ``ambiguous`` are the catalog names that
    several behaviours of one When emit.
    """

    bound: dict[Key, str] = field(default_factory=dict[Key, str])
    inner: dict[str, None] = field(default_factory=dict[str, None])
    ambiguous: dict[str, None] = field(default_factory=dict[str, None])

    def emits(self, event: Definition) -> bool:
        """Return whether a run emits an event."""
        moment = inner_event(event.symbol.name, self.inner)
        return _key(event) in self.bound or (moment is not None and moment not in self.ambiguous)


def no_emitter(site: Site) -> Iterator[Diagnostic]:
    """Report references to events without an emitter in the clauses of templates and variants."""
    root = site.tree
    if isinstance(root, tree.Template):
        if site.whole(root):
            yield from _unemitted(site, root, site, _emitters(site, root))
            yield from _emitted_elsewhere(site, root)
        return
    for scenario in scenarios(site):
        template = scenario.template
        if template is not None and isinstance(template.tree, tree.Template):
            yield from _unemitted(site, scenario.variant, template, _emitters(template, template.tree))


def _emitters(site: Site, template: tree.Template) -> _Emitters:
    found = _Emitters()
    behaviours = [node for node in walk(template) if isinstance(node, tree.BehaviourUse)]
    for duration in (template.duration, *(behaviour.duration for behaviour in behaviours)):
        for ref in (duration.start, duration.end) if duration is not None else ():
            event = site.target(ref)
            if event is not None:
                found.bound.setdefault(_key(event), ref.path)
    for defined in template.events:
        found.bound.setdefault((site.uri, f"{template.name.text}.{defined.name.text}"), defined.name.text)
    for when in (node for node in walk(template) if isinstance(node, tree.When) and node.more):
        moments = Counter(
            moment for use in when.behaviours for moment in load_catalog().behaviours[use.action.word].events
        )
        found.ambiguous |= dict.fromkeys(moment for moment, number in moments.items() if number > 1)
    for behaviour in behaviours:
        events = load_catalog().behaviours[behaviour.action.word].events
        found.inner |= dict.fromkeys(events)
        for emission in behaviour.emissions:
            event = site.target(emission.event) if emission.moment.text in events else None
            if event is not None:
                found.bound.setdefault(_key(event), emission.event.path)
    return found


def _emitted_elsewhere(site: Site, template: tree.Template) -> Iterator[Diagnostic]:
    """Report events that a behaviour awaits, but that only another When or loop of the template emits."""
    whens = [node for node in walk(template.body) if isinstance(node, tree.When)]
    emitted = [set(_keys_of(site, when)) for when in whens]
    every = set[Key]().union(*emitted)
    for when, own in zip(whens, emitted, strict=True) if len(whens) > 1 else ():
        for ref in (one.event for step in when.steps for one in step.events):
            event = site.target(ref)
            if event is not None and _key(event) in every - own - set(_keys_of(site, template.duration)):
                message = (
                    f"only another 'When:' of the template emits '{ref.path}', and each has its own occurrences, so "
                    "that this behaviour would wait without end: name an event of this 'When:', or define one"
                )
                yield finding(site, ref, Severity.WARNING, CODE, message)


def _keys_of(site: Site, node: tree.When | tree.During | None) -> Iterator[Key]:
    """Yield the events that start or end the durations in a node, and the events in the ``emits`` of its behaviours."""
    for inner in () if node is None else walk(node):
        match inner:
            case tree.During(start=start, end=end):
                refs = (start, end)
            case tree.Emission(event=event):
                refs = (event,)
            case _:
                refs = ()
        for ref in refs:
            found = site.target(ref)
            if found is not None:
                yield _key(found)


def _unemitted(site: Site, node: tree.Node, template: Site, emitters: _Emitters) -> Iterator[Diagnostic]:
    for ref in _events(node):
        event = site.target(ref)
        if event is None or emitters.emits(event):
            continue
        names = list(emitters.bound.values())
        moment = inner_event(event.symbol.name, emitters.ambiguous)
        message = not_emitted(ref.path, names, emitters.inner)
        if moment is not None:
            message = (
                f"several behaviours of the When emit '{moment}', so that the clause of '{ref.path}' stays unknown: "
                f"state which one it is by 'emits {moment} as <{ref.path}>'"
            )
        near = get_close_matches(ref.path, names, n=MAX_OFFERED, cutoff=0.0)
        fixes = [change(site, f"Change to '{name}'", ref, name) for name in near]
        # The file of another template may not know the event.
        fixes += _emissions(template, ref.path, moment) if template.uri == site.uri else ()
        yield finding(site, ref, Severity.WARNING, CODE, message, fixes=tuple(fixes))


def _emissions(template: Site, event: str, moment: str | None) -> Iterator[Fix]:
    """Yield fixes that add ``emits … as <event>`` to a behaviour, for one of its moments or for all of them."""
    nodes = () if template.tree is None else walk(template.tree)
    uses = (node for node in nodes if isinstance(node, tree.BehaviourUse))
    for use in (use for use in uses if use.name.span.start < use.name.span.end):
        emitted = {emission.moment.text for emission in use.emissions}
        end = template.span((use.action, *use.emissions)[-1]).end
        for one in load_catalog().behaviours[use.action.word].events:
            if one not in emitted and moment in (None, one):
                text = f"emits {one} as <{event}>"
                title = f"Let '{use.name.text}' emit it: '{text}'"
                yield Fix(title, (Edit(template.uri, Span(end, end), f" {text}"),))


def not_emitted(event: str, bound: Iterable[str], inner: Iterable[str]) -> str:
    """Return the message on an event that nothing emits.

    ``bound`` are the events of durations, and ``inner`` those that the behaviours of the scenario emit.
    """
    message = f"nothing emits '{event}', so that its clause stays unknown: this scenario has {_listed(bound)}"
    emitted = list(inner)
    if emitted:
        message += f", and its behaviours emit {_listed(emitted)}, under these names or with 'emits … as'"
    return message


def _events(node: tree.Node) -> Iterator[tree.Ref]:
    for inner in walk(node):
        match inner:
            case tree.Before() | tree.After() | tree.Occurrence():
                yield inner.event
            case tree.During():
                yield from (inner.start, inner.end)
            case _:
                pass


def _key(event: Definition) -> Key:
    return event.uri, event.symbol.path


def _listed(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in names) or "none"
