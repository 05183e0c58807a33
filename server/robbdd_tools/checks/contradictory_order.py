"""``contradictory-order``: each of two events must precede the other one."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.checks.finding import change, finding, related_to
from robbdd_tools.checks.template_variants import scenarios
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site


def contradictory_order(site: Site) -> Iterator[Diagnostic]:
    """Report ``from <b> until <a>`` if the same scenario contains ``from <a> until <b>`` before it."""
    for clauses in clauses_of(site.placed.declaration):
        if isinstance(clauses.node, tree.Template):
            yield from _contradictions([(site, during) for during in clauses.once], site)
    for scenario in scenarios(site):
        template, outer = scenario.template, scenario.outer
        ordered = [(template, during) for during in outer.once] if template is not None and outer is not None else []
        yield from _contradictions([*ordered, *((site, during) for during in scenario.clauses.once)], site)


def _contradictions(durations: list[tuple[Site, tree.During]], own: Site) -> Iterator[Diagnostic]:
    first: dict[tuple[str, str], tuple[Site, tree.During]] = {}
    for site, during in durations:
        start, end = during.start.path, during.end.path
        first.setdefault((start, end), (site, during))
        other = first.get((end, start))
        if other is None or start == end or site is not own:
            continue
        text = site.file.document.text
        span = site.span(during)
        swapped = text[span.start : span.end]
        for ref, path in ((during.end, start), (during.start, end)):
            begin, stop = ref.span.start - during.span.start, ref.span.end - during.span.start
            swapped = swapped[:begin] + path + swapped[stop:]
        yield finding(
            site,
            during,
            Severity.WARNING,
            "contradictory-order",
            f"this interval is empty: elsewhere in this scenario, '{start}' occurs after '{end}'; swap the two events",
            (related_to(*other, f"here '{end}' comes first"),),
            (change(site, "Swap the two events", during, swapped),),
        )
