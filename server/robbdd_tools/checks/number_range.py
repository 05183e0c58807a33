"""``number-range``: a number is outside the range of its quantity, for example a negative seed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import floor, inf, pi
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Edit, Fix, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.removals import removal
from robbdd_tools.catalog.settings import setting_of
from robbdd_tools.checks.finding import change, finding, written_text
from robbdd_tools.graph.write.units import LENGTHS
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.elements import Site
    from robbdd_tools.syntax.declaration import Declaration

CODE = "number-range"


@dataclass(frozen=True, slots=True)
class _Quantity:
    """The range of a number. ``above`` excludes the bound ``low`` itself, and ``whole`` excludes fractions."""

    words: str
    low: float = 0.0
    high: float = inf
    above: bool = False
    whole: bool = False

    @property
    def wanted(self) -> str:
        number = "a whole number" if self.whole else "a number"
        if self.high < inf:
            start = f"greater than {self.low:g} and up" if self.above else f"from {self.low:g}"
            return f"{number} {start} to {self.high:.10g}"
        return f"{number} {'greater than' if self.above else 'of at least'} {self.low:g}"

    def allows(self, value: float) -> bool:
        above_low = value > self.low if self.above else value >= self.low
        return above_low and value <= self.high and not (self.whole and value % 1)


_FRICTION = _Quantity("a friction", low=setting_of("friction").low, high=setting_of("friction").high)
_RATE = _Quantity("an update rate", above=True)
USUAL_RATE = 100
"""A fix writes this update rate (Hz), as do the quick fixes that create policies."""
_RATIO = _Quantity("a gear ratio", above=True)
_PIXELS = _Quantity("a number of pixels", low=1.0, whole=True)
_SPEED = _Quantity("a speed limit", above=True)
_WHOLE_TURN = {"deg": 360.0, "rad": 2 * pi}
_REPEAT = _Quantity("the number of repetitions", low=1.0, whole=True)
_SEED = _Quantity("a seed", high=setting_of("seed").high, whole=True)
_NOISE = _Quantity("noise")
_SIGMA = _Quantity("a number of standard deviations", above=True)
_EDGE = _Quantity("an edge of a box", above=True)
_TIMEOUT = _Quantity("a timeout", above=True)
_Measured = tuple[tree.Number | None, _Quantity]


def number_range(site: Site) -> Iterator[Diagnostic]:
    """Report each number of a declaration that is out of range, and the reversed bounds of a distance."""
    for number, quantity in _measured(site.placed.declaration):
        text = written_text(site, number)
        message = f"{quantity.words} cannot be {text}: write {quantity.wanted}"
        fixes = _fixes(site, number, quantity)
        yield finding(site, number, Severity.ERROR, CODE, message, fixes=fixes)
    match site.tree:
        case tree.Policy(rule=tree.Evaluation(evaluator=tree.LinearDistance(condition=tree.Between() as between))):
            yield from _swapped(site, between.lower, between.upper)
        case tree.Provider(source=tree.GroundTruth(view=tree.SensorView() as view)):
            yield from _swapped(site, view.nearest, view.farthest)
        case tree.SceneInstance() | tree.KinematicTree():
            yield from _reversed_limits(site, site.tree)
        case _:
            pass


@kept_with_key
def _measured(declaration: Declaration) -> tuple[tuple[tree.Number, _Quantity], ...]:
    """Return the numbers of a declaration that are out of range."""
    if declaration.tree is None:
        return ()
    return tuple(
        (number, quantity)
        for node in walk(declaration.tree)
        for number, quantity in _quantities(node)
        if number is not None and not quantity.allows(number.value)
    )


def _quantities(node: tree.Node) -> Iterator[_Measured]:
    match node:
        case tree.PairFriction():
            yield node.value, _FRICTION
        case tree.Policy():
            yield from ((node.horizon, _Quantity("a horizon")), (node.sigma, _SIGMA))
        case tree.GroundTruth():
            yield from ((node.rate, _RATE), (node.noise, _NOISE), (node.latency, _Quantity("a latency")))
            yield node.misses, _Quantity("a share of missed observations", high=100.0)
        case tree.SensorView():
            yield node.angle, _Quantity("a field of view", high=360.0, above=True)
        case tree.Camera():
            yield node.rate, _RATE
            yield node.fov, _Quantity("a field of view", high=_WHOLE_TURN[node.fov_unit], above=True)
            yield from ((number, _PIXELS) for number in _numbers(node.resolution))
        case tree.RosTopic():
            yield node.noise, _NOISE
        case tree.Transforms():
            yield from ((node.rate, _RATE), (node.noise, _NOISE))
        case tree.SimulatedStates() | tree.Sensor():
            yield node.rate, _RATE
        case tree.Inertia():
            yield node.mass, _Quantity("a mass")
        case tree.Actuation():
            yield node.ratio, _RATIO
        case tree.Gripper():
            yield node.stroke, _Quantity("a stroke", above=True)
        case tree.Model() if node.velocity is not None:
            yield from ((number, _SPEED) for number in _numbers(node.velocity))
        case tree.WorkspaceBox():
            yield from ((number, _EDGE) for number in _numbers(node.size))
        case tree.LinearDistance():
            yield node.max_time_offset, _Quantity("a time offset")
        case tree.Distance():
            yield node.value, _Quantity("a distance")
        case tree.Execution():
            yield from ((node.repeat, _REPEAT), (node.seed, _SEED), (node.timeout, _TIMEOUT))
        case _:
            pass


def _numbers(vector: tree.Vector) -> Iterator[tree.Number]:
    yield from (number for number in vector.values if isinstance(number, tree.Number))


def _fixes(site: Site, number: tree.Number, quantity: _Quantity) -> tuple[Fix, ...]:
    """Return the fix that removes the sign or, if there is none, writes the usual number or removes an optional entry.

    There are no other fixes, because the intended number is uncertain.
    """
    if number.value < 0 and quantity.allows(-number.value):
        positive = written_text(site, number).lstrip("-")
        return (change(site, f"Change to {positive}", number, positive),)
    if quantity is _TIMEOUT:
        return _without_timeout(site, number)
    usual = None
    if quantity is _RATE:
        usual = USUAL_RATE
    elif quantity.whole:
        usual = floor(min(max(number.value, quantity.low), quantity.high))
    return () if usual is None else (change(site, f"Change to {usual}", number, str(usual)),)


def _without_timeout(site: Site, number: tree.Number) -> tuple[Fix, ...]:
    """Return the fix that removes ``timeout: 0 seconds``: the default then applies."""
    text, span = site.file.document.text, site.span(number)
    start = text.rindex("timeout", 0, span.start)
    end = text.find("seconds", span.end)
    if end < 0:
        return ()
    return (removal(site.file.document, "Remove the timeout: the default applies", Span(start, end + len("seconds"))),)


def _reversed_limits(site: Site, root: tree.SceneInstance | tree.KinematicTree) -> Iterator[Diagnostic]:
    for node in walk(root):
        bounds = list(_numbers(node.range)) if isinstance(node, tree.Limit) else []
        if len(bounds) == 2 and bounds[0].value > bounds[1].value:
            yield _reversed(site, bounds[0], bounds[1])


def _reversed(site: Site, low: tree.Node, high: tree.Node) -> Diagnostic:
    edits = tuple(Edit(site.uri, site.span(old), written_text(site, new)) for old, new in ((low, high), (high, low)))
    message = "the bounds are reversed: the lower one comes first"
    return finding(site, low, Severity.ERROR, CODE, message, fixes=(Fix("Swap the bounds", edits),))


def _swapped(site: Site, low: tree.Distance, high: tree.Distance) -> Iterator[Diagnostic]:
    if _metres(low) > _metres(high):
        yield _reversed(site, low, high)


def _metres(distance: tree.Distance) -> float:
    return distance.value.value * LENGTHS[distance.unit]
