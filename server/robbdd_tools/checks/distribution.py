"""``distribution``: a run cannot sample a distribution, or its dimension does not match its numbers.

This is a warning, because only a run that uses the distribution for a placement fails.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.catalog.executable import Law, law_fault, spherical
from robbdd_tools.checks.finding import change, finding, written_text
from robbdd_tools.graph.write.rotations import numbers_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site

CODE = "distribution"


def distribution(site: Site) -> Iterator[Diagnostic]:
    """Report bounds and means of another dimension.

    If there are none, report why the distribution cannot be sampled.
    """
    declared = site.tree
    if not isinstance(declared, tree.Distribution) or not site.whole(declared):
        return
    match declared.law:
        case tree.UniformRotation():
            return
        case tree.Uniform(dimension=dimension, lower=lower, upper=upper):
            sized, blamed = (lower, upper), upper
            law = Law("", "uniform", low=_numbers(lower), high=_numbers(upper))
        case tree.Normal(dimension=dimension, mean=mean, spread=spread):
            sized, blamed = (mean,), spread
            law = Law("", "normal", mean=_numbers(mean), covariance=_covariance(spread, len(_numbers(mean))))
    name, wanted = declared.name.text, dimension.value
    wrong = next((part for part in sized if len(_numbers(part)) != wanted), None)
    fault = law_fault(law)
    if wrong is not None:
        text = f"the distribution '{name}' has dimension {wanted}, but this has {len(_numbers(wrong))}"
        fixes = _resized(site, dimension, sized)
        yield finding(site, wrong, Severity.WARNING, CODE, text, fixes=fixes)
    elif fault:
        text = f"the distribution '{name}' {fault}: a run cannot sample from it"
        fixes = _ordered(site, declared.law) if isinstance(declared.law, tree.Uniform) else ()
        yield finding(site, blamed, Severity.WARNING, CODE, text, fixes=fixes)


def _resized(site: Site, dimension: tree.Number, sized: tuple[tree.Vector | tree.Number, ...]) -> tuple[Fix, ...]:
    """Return the fix that adapts the dimension to the numbers. All numbers must have the same dimension."""
    sizes = {len(_numbers(part)) for part in sized}
    if len(sizes) > 1:
        return ()
    (size,) = sizes
    return (change(site, f"Change the dimension to {size}", dimension, str(size)),)


def _ordered(site: Site, law: tree.Uniform) -> tuple[Fix, ...]:
    """Return the fix that swaps a lower bound and an upper bound if the lower one is greater."""
    swaps: list[Edit] = []
    for low, high in zip(_parts(law.lower), _parts(law.upper), strict=True):
        if low.value > high.value:
            swaps += (
                Edit(site.uri, site.span(old), written_text(site, new)) for old, new in ((low, high), (high, low))
            )
    return (Fix("Swap the reversed bounds", tuple(swaps)),) if swaps else ()


def _parts(value: tree.Vector | tree.Number) -> list[tree.Number]:
    return [value] if isinstance(value, tree.Number) else [part for inner in value.values for part in _parts(inner)]


def drawn(law: tree.Uniform | tree.UniformRotation | tree.Normal) -> int:
    """Return the number of values in one sample. A rotation has four."""
    match law:
        case tree.UniformRotation():
            return 4
        case tree.Uniform():
            return len(_numbers(law.lower))
        case tree.Normal():
            return len(_numbers(law.mean))


def _covariance(spread: tree.Vector | tree.Number, size: int) -> tuple[float, ...]:
    return numbers_of(spread) if isinstance(spread, tree.Vector) else spherical(float(spread.value), size)


def _numbers(value: tree.Vector | tree.Number) -> tuple[float, ...]:
    return numbers_of(value) if isinstance(value, tree.Vector) else (float(value.value),)
