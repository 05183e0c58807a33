"""Friction of a pair of surfaces: the smaller coefficient of the two counts.

Left to itself the engine takes the larger coefficient, so that rough pads would hold a part that is as slippery as ice,
and where a file gives one geom a higher ``priority`` it takes that geom's alone.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from itertools import product
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robbdd_tools.world.staging import DeclaredPair


def rank_by_friction(spec: Any, pads: Iterable[str]) -> None:
    """Let the smoother geom of each contact decide it, by priorities that replace those of the files.

    The one that decides brings all parameters of the contact. So it gets the largest ``condim`` and the largest
    torsional and rolling friction (m) of the rougher ones, which the engine would have combined: a ball comes to rest
    on a smooth board, too. Those of ``pads`` (names of geoms) stay their own.
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
    """Declare the contacts of gripping faces with what they may grip, all names of geoms.

    Sliding friction is the smaller one of the two. Torsional friction (m) is that times the radius of the pad's
    contact patch, which is the ratio of the pad's coefficients. Stiffness is the pad's: on soft ones a light part
    slips out.
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


def pair_declared(spec: Any, pairs: Iterable[tuple[str, str, DeclaredPair]]) -> None:
    """Declare contacts between two geoms, by name, as a model of the whole scene does."""
    for first, second, declared in pairs:
        pair = spec.add_pair(geomname1=first, geomname2=second)
        for name, value in declared.parameters.items():
            setattr(pair, name, value)
