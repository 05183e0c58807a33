"""The configurations that ``has config`` can set, their units and permitted values."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

from robbdd_tools.base.quantity_units import UNITS, si_factor, split_quantity

if TYPE_CHECKING:
    from collections.abc import Mapping

Numbers = tuple[float, ...]
"""A value: one number, or the four numbers of a range."""


class SettingError(ValueError):
    """An unknown configuration or an invalid value; the message lists the valid ones."""


@dataclass(frozen=True, slots=True)
class Setting:
    """One configuration: the ``unit`` of its numbers, the ``target`` to which it applies, the bounds of each number.

    ``words`` are names for common values; ``count`` is how many numbers a value has; ``whole`` allows no fractions.
    ``judges`` is the kind of element (agent or object) if the configuration changes how an evaluator judges it instead
    of the world.
    """

    name: str
    unit: str
    target: str
    low: float
    high: float
    doc: str
    count: int = 1
    whole: bool = False
    words: tuple[tuple[str, Numbers], ...] = ()
    judges: str = ""

    def read(self, text: str) -> Numbers:
        """Return the value written as a text, in ``unit``; raises ``SettingError``."""
        named = dict(self.words).get(text.strip())
        if named is not None:
            return named
        try:
            numbers = _numbers(text, self.unit)
        except ValueError:
            numbers = ()
        fits = all(self.low <= number <= self.high and not (self.whole and number % 1) for number in numbers)
        ordered = all(low < high for low, high in zip(numbers[::2], numbers[1::2], strict=False))
        if len(numbers) != self.count or not fits or not ordered:
            raise SettingError(f"'{self.name}' cannot be '{text}': it must be {self.wanted}")
        return numbers

    @property
    def wanted(self) -> str:
        """The permitted values, in words."""
        kind = "a whole number" if self.whole else "a number"
        if self.count > 1:
            kind = f"{self.count} numbers, each lower bound before its upper one,"
        unit = f" {self.unit}" if self.unit else ""
        words = "".join(f", or {word}" for word, _ in self.words)
        return f"{kind} from {self.low:g} to {self.high:g}{unit}{words}"


def _numbers(text: str, unit: str) -> Numbers:
    """Return numbers in a unit. Each may have a unit of the same dimension: 25 cm. Raises ``ValueError``."""
    dimension = UNITS.get(unit or "%", ("",))[0]
    numbers: list[float] = []
    is_measured = True
    for word in (part for one in text.split() for part in split_quantity(one) or (one,)):
        if word not in UNITS:
            numbers.append(float(word))
        elif is_measured or UNITS[word][0] != dimension:
            raise ValueError(text)
        else:
            numbers[-1] *= si_factor(word) / si_factor(unit)
        is_measured = word in UNITS
    return tuple(numbers)


NORMAL: Numbers = (0.25, 0.60, -0.40, 0.40)
DENSE: Numbers = (0.35, 0.60, -0.30, 0.30)
"""Ranges (m) of the paper's experiment: nearest and farthest ahead of the robot, rightmost and leftmost."""
YES_NO: tuple[tuple[str, Numbers], ...] = (("yes", (1.0,)), ("no", (0.0,)))
_EVERY = (
    Setting(
        name="position_range",
        unit="m",
        target="an object, or an agent for all objects placed in front of it",
        low=-2.0,
        high=2.0,
        doc="initial position of the object relative to the base of the acting robot: x from, x to, y from, y to",
        count=4,
        words=(("normal", NORMAL), ("dense", DENSE)),
    ),
    Setting(
        "drop_height",
        "m",
        "a loose object, or an agent for all objects placed in front of it",
        0.0,
        2.0,
        "heights in the world frame, from and to, at which the object is released in a random orientation, whatever "
        "lies near",
        count=2,
    ),
    Setting(
        "position_ahead",
        "m",
        "a loose object laid out on a table",
        -2.0,
        2.0,
        "initial position of the object ahead of the base of the acting robot; replaces both limits of position_range",
    ),
    Setting(
        "position_left",
        "m",
        "a loose object laid out on a table",
        -2.0,
        2.0,
        "initial position of the object to the left of the base of the acting robot, negative to its right",
    ),
    Setting("height_scale", "", "a bin, tray or shelf", 0.2, 3.0, "height as a multiple of the catalog's"),
    Setting(
        "width_scale", "", "a bin, tray or shelf", 0.2, 3.0, "length, width and walls as a multiple of the catalog's"
    ),
    Setting("size_scale", "", "an object of the catalog to grasp", 0.2, 3.0, "size as a multiple of the catalog's"),
    Setting("opening", "", "a thing with a joint", 0.0, 1.0, "how far it is open at the start: 0 closed, 1 fully open"),
    Setting("belt_speed", "m/s", "a conveyor", 0.01, 0.5, "speed of its belt"),
    Setting("ee_speed", "m/s", "an agent", 0.01, 3.0, "largest speed of the tool along its planned path"),
    Setting("approach_speed", "m/s", "an agent", 0.01, 3.0, "largest speed of the tool as it descends or lowers"),
    Setting(
        "follow_speed",
        "m/s",
        "an agent",
        0.01,
        3.0,
        "speed at which the tool follows a distant target of 'timed-pick-place'",
    ),
    Setting(
        "attach_distance",
        "m",
        "an agent with a suction cup; 0 for one without",
        0.0,
        0.05,
        "distance up to which a vacuum pulls",
    ),
    Setting(
        "grip_force",
        "N",
        "an agent",
        0.1,
        200.0,
        "largest force of each finger, or pull of a cup's vacuum",
    ),
    Setting(
        "contact_time",
        "s",
        "an object, or an agent for its gripping faces",
        0.004,
        0.1,
        "time constant of its contacts: a smaller one is stiffer",
    ),
    Setting("travel_height", "m", "an agent", 0.15, 1.0, "height in the world frame at which the tool travels"),
    Setting("carry_clearance", "m", "an agent", 0.0, 0.5, "room below a carried object on its way; 0: not considered"),
    Setting("grip_time", "s", "an agent", 0.016, 5.0, "how long a grip is checked before the arm moves"),
    Setting("release_time", "s", "an agent", 0.0, 5.0, "how long the open gripper waits before it retracts"),
    Setting("mass", "kg", "a loose object", 0.001, 50.0, "mass of the whole object"),
    Setting(
        "friction",
        "",
        "an object",
        0.01,
        2.0,
        "coefficient of sliding friction; the smaller one of two surfaces counts",
    ),
    Setting(
        "max_speed",
        "m/s",
        "an agent",
        0.01,
        10.0,
        "speed of the tool up to which the agent moves safely",
        judges="agent",
    ),
    Setting(
        "displacement_limit",
        "m",
        "an object or a workspace",
        0.001,
        10.0,
        "path length that it may be pushed before it counts as collided with",
        judges="object",
    ),
    Setting(
        "force_limit",
        "N",
        "an object or a workspace",
        0.1,
        10000.0,
        "contact force up to which it does not count as collided with; replaces displacement_limit; 140 for "
        "fixed objects",
        judges="object",
    ),
    Setting(
        "whole_object",
        "",
        "an object",
        0,
        1,
        "whether the whole object, not only its position, must lie within the sides and below the top of a workspace",
        whole=True,
        words=YES_NO,
        judges="object",
    ),
    Setting(
        "exactly_one",
        "",
        "an object or a workspace",
        0,
        1,
        "whether it counts as sorted only if it (or, for a workspace, its objects) lies in no second workspace",
        whole=True,
        words=YES_NO,
        judges="object",
    ),
    Setting("seed", "", "any element", 0, 2**32 - 1, "seed of all randomness in the scenario", whole=True),
)
SETTINGS: Mapping[str, Setting] = MappingProxyType(
    {setting.name: setting for setting in sorted(_EVERY, key=lambda s: s.name)}
)


def setting_of(name: str) -> Setting:
    """Return a configuration by name; raises ``SettingError`` with the known names."""
    if name not in SETTINGS:
        raise SettingError(f"there is no configuration '{name}'; the known ones are {', '.join(SETTINGS)}")
    return SETTINGS[name]


def written(numbers: Numbers) -> str:
    """Return a value as text that parses back to the same numbers."""
    return " ".join(repr(int(number)) if number.is_integer() else repr(number) for number in numbers)
