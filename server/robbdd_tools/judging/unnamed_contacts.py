"""Find the contacts in an execution that no clause names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robbdd_tools.catalog.predicates.does_not_collide import DOES_NOT_COLLIDE
from robbdd_tools.judging.decisions import Instance, alternatives
from robbdd_tools.monitor.compound import CompoundEvaluator, leaves
from robbdd_tools.protocol.clauses import Clause, Fluent, fluents_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import Arguments
    from robbdd_tools.monitor.contact import Contact
    from robbdd_tools.monitor.judge import Regions
    from robbdd_tools.monitor.trace import Trace


def _of_contact(fluent: Fluent, instance: Instance) -> list[Arguments]:
    """Return the arguments of each *does not collide* in an instance of a fluent."""
    evaluate = fluent.predicate.evaluate
    stated = [(fluent.predicate, instance.arguments)]
    if isinstance(evaluate, CompoundEvaluator):
        stated = list(leaves(evaluate.definition, instance.arguments))
    return [own for one, own in stated if one.name == DOES_NOT_COLLIDE.name]


def unnamed_contacts(clauses: Iterable[Clause], trace: Trace, regions: Regions) -> tuple[Contact, ...]:
    """Return the agents' contacts in a trace, except those with targets of *does not collide* in ``clauses``.

    An undeclared moving part (``env:press/door``) belongs to its object.
    """
    named: set[tuple[str, str]] = set()
    for fluent in (fluent for clause in clauses for fluent in fluents_of(clause)):
        for arguments in (
            one for group in alternatives(fluent) for instance in group for one in _of_contact(fluent, instance)
        ):
            agent, target = str(arguments["agent"]), str(arguments["target"])
            carriers = [carrier for carrier, _ in regions.get(target, ())]
            named |= {(agent, carrier) for carrier in carriers or [target]}
    return tuple(
        contact
        for contact in trace.contacts
        if named.isdisjoint((contact.agent, name) for name in (contact.other, contact.other.rpartition("/")[0]))
    )
