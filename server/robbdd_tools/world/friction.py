"""Friction of a pair of surfaces: the smaller of the two coefficients counts.

By default, the engine takes the larger coefficient, so rough pads would hold a part as slippery as ice. If a file
gives one geom a higher ``priority``, the engine takes only the coefficient of this geom.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import Friction
    from robbdd_tools.world.staging import DeclaredPair


STIFF = (0.005, 1.0), (0.95, 0.99, 0.001, 0.5, 2.0)
"""Parameters of stiff contacts (``solref``, ``solimp``), the same as for the pads of the catalog's grippers."""


ROUGHEST = 2.0
"""Largest coefficient of a gripping face and a part, as in a configuration. Rubber on dry rubber has about 1.2."""


def rank_by_friction(spec: Any, pads: Iterable[str]) -> None:
    """Replace the priorities of the files, so that the smoother geom of each contact determines the friction.

    This geom supplies all contact parameters. So it gets the largest ``condim`` and the largest torsional and rolling
    friction (m) of the rougher geoms, as the engine would have combined them: a ball also comes to rest on a smooth
    board. The parameters of ``pads`` (names of geoms) are not passed on.
    """
    own = set(pads)
    levels: defaultdict[float, list[Any]] = defaultdict(list)
    for geom in spec.geoms:
        if geom.contype or geom.conaffinity:
            levels[float(geom.friction[0])].append(geom)
    condim, torsion, rolling = 1, 0.0, 0.0
    for priority, sliding in enumerate(sorted(levels, reverse=True)):
        rougher = condim, torsion, rolling
        for geom in levels[sliding]:
            if geom.name not in own:
                condim = max(condim, int(geom.condim))
                torsion = max(torsion, float(geom.friction[1]))
                rolling = max(rolling, float(geom.friction[2]))
        for geom in levels[sliding]:
            geom.priority = priority
            geom.condim = max(int(geom.condim), rougher[0])
            geom.friction = [sliding, max(geom.friction[1], rougher[1]), max(geom.friction[2], rougher[2])]


def pair_pads(spec: Any, pads: Iterable[str], parts: Iterable[str]) -> None:
    """Declare the contacts of gripping faces with the parts that they may grip, all given as names of geoms.

    The sliding friction is the smaller of the two. The torsional friction (m) is this value times the radius of the
    pad's contact patch, which is the ratio of the pad's coefficients. The pad gives the stiffness: on soft pads, a
    light part slips out.
    """
    faces: list[Any] = [spec.geom(name) for name in pads]
    gripped: list[Any] = [spec.geom(name) for name in parts]
    for pad, part in product(faces, gripped):
        sliding = min(float(pad.friction[0]), float(part.friction[0]))
        patch = float(pad.friction[1]) / float(pad.friction[0]) if pad.friction[0] else 0.0
        rolling = max(float(pad.friction[2]), float(part.friction[2]))
        pair = spec.add_pair(geomname1=pad.name, geomname2=part.name)
        pair.condim = max(int(pad.condim), int(part.condim))
        pair.friction = [sliding, sliding, sliding * patch, rolling, rolling]
        pair.solref, pair.solimp = pad.solref, pad.solimp
        pair.gap = pad.gap


def too_rough(spec: Any, pads: Iterable[str], parts: Iterable[str]) -> float:
    """Return the coefficient between gripping faces and a part if no surfaces of real grippers have it, else 0."""
    surfaces = [max(float(spec.geom(name).friction[0]) for name in names) for names in (list(pads), list(parts))]
    coefficient = min(surfaces)
    return coefficient if coefficient > ROUGHEST else 0.0


def pair_stiff(spec: Any, jaws: Iterable[str], parts: Iterable[str]) -> None:
    """Declare contacts of things with moving parts (``jaws``) and loose parts, as stiff as contacts of gripping faces.

    The engine's own stiffness grows with the mass: a light part that is too large and jams between a drawer and its
    chest would yield by millimetres under the force of a gripper.
    """
    for jaw, part in product(jaws, parts):
        pair = _pair_of(spec, jaw, part)
        pair.solref, pair.solimp = STIFF


def pair_declared(spec: Any, pairs: Iterable[tuple[str, str, DeclaredPair]]) -> None:
    """Declare contacts between pairs of geoms, by name, as given in a model of the whole scene."""
    for first, second, declared in pairs:
        pair = spec.add_pair(geomname1=first, geomname2=second)
        for name, value in declared.parameters.items():
            setattr(pair, name, value)


def pair_given(spec: Any, frictions: Iterable[Friction], geoms: Mapping[str, list[str]]) -> None:
    """Give pairs of elements the sliding friction that a scene instance states.

    ``geoms`` are the names of the geoms of each element that is present; for an agent, these are its gripping faces.
    The torsional friction (m) keeps its ratio to the sliding friction. The pads, or else the smoother geom, give the
    stiffness.
    """
    declared: dict[frozenset[str], Any] = {frozenset((pair.geomname1, pair.geomname2)): pair for pair in spec.pairs}
    for friction in frictions:
        for names in product(geoms.get(friction.first, ()), geoms.get(friction.second, ())):
            pair = declared.get(frozenset(names))
            if pair is None:
                pair = declared[frozenset(names)] = _pair_of(spec, *names)
            sliding, _, torsion, *rolling = pair.friction
            patch = torsion / sliding if sliding else 0.0
            pair.friction = [friction.coefficient, friction.coefficient, friction.coefficient * patch, *rolling]


def _pair_of(spec: Any, first: str, second: str) -> Any:
    smoother, rougher = sorted((spec.geom(first), spec.geom(second)), key=lambda geom: float(geom.friction[0]))
    pair = spec.add_pair(geomname1=first, geomname2=second)
    pair.condim = max(int(smoother.condim), int(rougher.condim))
    sliding = float(smoother.friction[0])
    torsion, rolling = (max(float(smoother.friction[i]), float(rougher.friction[i])) for i in (1, 2))
    pair.friction = [sliding, sliding, torsion, rolling, rolling]
    pair.solref, pair.solimp = smoother.solref, smoother.solimp
    return pair
