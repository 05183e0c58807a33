"""The columns of a table: the known ones, and the units of their numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from robbdd_tools.base.quantity_units import UNITS, si_factor
from robbdd_tools.logs.log_contents import UnreadableLog

POSITION, TURN, ANGLES = ("x", "y", "z"), ("qw", "qx", "qy", "qz"), ("roll", "pitch", "yaw")
DIMENSIONS = {
    "time": "time",
    **dict.fromkeys(("frame", *TURN, "parent", "event"), ""),
    **dict.fromkeys(POSITION, "length"),
    **dict.fromkeys(ANGLES, "angle"),
}
"""Known columns → dimension of their numbers; empty for texts and numbers without a unit."""
CLOCKS = {"us": 1e-6, "µs": 1e-6, "ns": 1e-9}
"""Further units of times, and their sizes in s."""
OF_JOINTS = ("angle", "length")
_WITH_UNIT = re.compile(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\])]+)[\])]")


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: its title in the file, and its unit. An empty unit is the SI unit."""

    title: str
    unit: str = ""

    @property
    def factor(self) -> float:
        """The factor that converts the unit to the SI unit."""
        return CLOCKS.get(self.unit) or si_factor(self.unit)


@dataclass(frozen=True, slots=True)
class Columns:
    """The ``known`` columns of a table by name, and possible columns of ``joints`` by title without unit."""

    known: Mapping[str, Column]
    joints: Mapping[str, Column]


def columns_of(place: str, titles: Sequence[str], stated: Mapping[str, str]) -> Columns:
    """Return the columns of a table.

    A title may have a unit in brackets (``elbow [deg]``). ``stated`` maps names of known columns to titles, with or
    without the unit. ``place`` is the place of the first line, for messages. Raises ``UnreadableLog`` for a name or a
    title that does not exist, and for a unit of a known column that measures something else.
    """
    every = dict(map(_split, titles))
    known = _known(every)
    for name, title in stated.items():
        if name not in DIMENSIONS:
            raise UnreadableLog(f"'{name}' is no column of a table; the columns are {', '.join(DIMENSIONS)}")
        bare, column = _split(title)
        if bare not in every:
            raise UnreadableLog(f"{place}: there is no column '{title}'; it has: {', '.join(every)}")
        known[name] = replace(every[bare], unit=every[bare].unit or column.unit)
    known = _oriented(known, stated, place)
    if "time" not in known:
        words = "there is no column 'time': name the columns in the first line, or say --column time=COLUMN"
        raise UnreadableLog(f"{place}: {words}; it has: {', '.join(every)}")
    for name, column in known.items():
        if column.unit and not _is_unit(column.unit, DIMENSIONS[name]):
            raise UnreadableLog(f"{place}: '{column.unit}' is no unit of column '{name}'")
    used = {column.title for column in known.values()}
    joints = {name: column for name, column in every.items() if column.title not in used and _is_of_joint(column)}
    return Columns(known, joints)


def _known(every: Mapping[str, Column]) -> dict[str, Column]:
    """Return the known columns by name. Titles may have capital letters if no other title has the same letters."""
    found: dict[str, Column] = {}
    for name in DIMENSIONS:
        alike = [title for title in every if title.casefold() == name]
        if name in every or len(alike) == 1:
            found[name] = every[name if name in every else alike[0]]
    return found


def _oriented(known: dict[str, Column], stated: Mapping[str, str], place: str) -> dict[str, Column]:
    """Return the columns without roll, pitch and yaw if these are not the orientation of a pose.

    They are one only together, with their units and without a quaternion; they may be joints of an arm. Raises
    ``UnreadableLog`` if only some of them are stated.
    """
    is_turned = "frame" in known and not any(name in known for name in TURN)
    if is_turned and all(name in known and known[name].unit for name in ANGLES):
        return known
    named = [name for name in ANGLES if name in stated]
    if named and is_turned:
        missing = next((name for name in ANGLES if name not in known), None)
        words = (
            f"no column '{missing}'" if missing else "no unit of an angle: write it in the title, as in 'roll [deg]'"
        )
        raise UnreadableLog(f"{place}: an orientation needs roll, pitch and yaw with their units; there is {words}")
    return {name: column for name, column in known.items() if name not in ANGLES}


def _is_unit(unit: str, dimension: str) -> bool:
    return (dimension == "time" and unit in CLOCKS) or (unit in UNITS and UNITS[unit][0] == dimension)


def _is_of_joint(column: Column) -> bool:
    return not column.unit or (column.unit in UNITS and UNITS[column.unit][0] in OF_JOINTS)


def _split(title: str) -> tuple[str, Column]:
    match = _WITH_UNIT.fullmatch(title)
    return (match["name"], Column(title, match["unit"])) if match else (title, Column(title))
