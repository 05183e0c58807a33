"""``simultaneous-agent``: one agent has two behaviours at the same time (``meanwhile``), or two roles in one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.catalog.api import Kind
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "simultaneous-agent"
_MEANWHILE = "meanwhile"


def simultaneous_agent(site: Site) -> Iterator[Diagnostic]:
    """Report each behaviour whose agent executes another one at the same time, or hands over to itself."""
    template = site.tree
    if not isinstance(template, tree.Template):
        return
    for node in walk(template.body):
        if isinstance(node, tree.When) and node.more:
            yield from _in_when(site, node)
        elif isinstance(node, tree.BehaviourUse):
            yield from _in_behaviour(site, node)


def _in_behaviour(site: Site, use: tree.BehaviourUse) -> Iterator[Diagnostic]:
    seen: dict[tuple[str, str], tree.Ref] = {}
    for agent in _agents(use):
        target = site.target(agent)
        if target is None:
            continue
        first = seen.setdefault((target.uri, target.symbol.path), agent)
        if first is not agent:
            message = f"'{agent.path}' is both agents of '{use.action.word}': name another agent"
            yield finding(site, agent, Severity.ERROR, CODE, message, (related_to(site, first, "the same agent"),))


def _in_when(site: Site, when: tree.When) -> Iterator[Diagnostic]:
    busy: dict[tuple[str, str], tree.Ref] = {}
    for step in when.steps:
        if not isinstance(step, tree.Further) or step.link != _MEANWHILE:
            busy = {}
        agent = next(_agents(step.behaviour), None)
        target = None if agent is None else site.target(agent)
        if agent is None or target is None:
            continue
        first = busy.setdefault((target.uri, target.symbol.path), agent)
        if first is not agent and isinstance(step, tree.Further):
            start = site.span(step).start
            fix = Fix("Execute it afterwards: 'then'", (Edit(site.uri, Span(start, start + len(_MEANWHILE)), "then"),))
            message = (
                f"'{agent.path}' cannot execute two behaviours at the same time: name another agent, or write 'then'"
            )
            related = (related_to(site, first, "its other behaviour"),)
            yield finding(site, agent, Severity.ERROR, CODE, message, related, (fix,))


def _agents(use: tree.BehaviourUse) -> Iterator[tree.Ref]:
    """Yield the agents of a behaviour; the first one executes it."""
    written = dict(use.action.arguments)
    for slot in load_catalog().behaviours[use.action.word].slots:
        agent = written.get(slot.name)
        if slot.kind is Kind.AGENT and isinstance(agent, tree.Ref):
            yield agent
