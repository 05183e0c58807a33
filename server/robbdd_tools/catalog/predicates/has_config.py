"""A target has a configuration value, which is set before the scenario, read back from the world, and compared."""

from __future__ import annotations

from math import isclose
from typing import TYPE_CHECKING

from robbdd_tools.catalog.api import Arguments, Evidence, Kind, Predicate, Slot
from robbdd_tools.catalog.geometry import carriers_of
from robbdd_tools.catalog.settings import Numbers, setting_of

if TYPE_CHECKING:
    from robbdd_tools.catalog.api import FloatArray

TOLERANCE = 1e-6
"""Relative differences up to this are attributed to floating-point rounding."""


def margin(evidence: Evidence, arguments: Arguments) -> FloatArray:
    """Return 1 where the value that was read back is the wanted value and -1 elsewhere, shape (n,).

    Raises ``SettingError`` for an unknown name or an invalid value.
    """
    import numpy as np

    name = str(arguments["name"])
    setting = setting_of(name)
    wanted = setting.read(str(arguments["value"]))
    elements = carriers_of(evidence, str(arguments["target"]))
    same = all(_same(wanted, setting.read(evidence.setting(element, name))) for element in elements)
    return np.full(len(evidence.times), 1.0 if same else -1.0)


def _same(one: Numbers, other: Numbers) -> bool:
    return all(isclose(a, b, rel_tol=TOLERANCE, abs_tol=1e-12) for a, b in zip(one, other, strict=True))


HAS_CONFIG = Predicate(
    name="has-config",
    phrase="<target> has config $name = <value>",
    rdf_type="bdd:HasConfigPredicate",
    slots=(
        Slot("target", Kind.ANY, "bdd:config-target"),
        Slot("name", Kind.NAME, "bdd:config-name"),
        Slot("value", Kind.VALUE, "bdd:config-variable"),
    ),
    sentence='"{target}" has config "{name}" = "{value}"',
    unit="",
    doc=(
        "The target is set up with one of these configurations: position_range, position_ahead, position_left (m), "
        "height_scale, width_scale, size_scale, ee_speed, approach_speed (m/s), travel_height, carry_clearance (m), "
        "grip_force (N), grip_time, release_time, contact_time (s), mass (kg), friction or seed; or it is judged by "
        "it: max_speed (m/s), displacement_limit (m), force_limit (N), whole_object, exactly_one."
    ),
    measured="nothing",
    evaluate=margin,
    set_up=True,
)
