"""Errors for missing evidence: something was not observed when it was needed."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from robbdd_tools.catalog.api import FloatArray


class Unobserved(Exception):
    """There is no observation on which to judge. The message gives the reason."""


class Unplaced(Unobserved):
    """At no sample is it known where a workspace is."""

    def __init__(self, workspace: str) -> None:
        super().__init__(f"where {workspace} is, is not known: state its box in a .scenex")


def no_grip(agent: str, unseen: str) -> str:
    """Return why it is unknown what an agent holds; ``unseen`` names the body with missing poses, if any."""
    holder, thing = agent.rpartition(":")[2], unseen.rpartition(":")[2]
    if unseen:
        words = f"the log does not say where {unseen} is, and so not whether {agent} holds it"
        return f"{words}: add --frame {thing}=FRAME, or --grip {holder}/{thing}=SIGNAL"
    return (
        f"the log does not say what {agent} holds: add --grip {holder}=SIGNAL of its gripper, "
        f"or record texts on /{holder}/holds"
    )


def path_of_errors(name: str, length: float, away: float) -> str:
    """Return why the length (m) of a path is unknown; ``away`` is the largest distance (m) from its begin."""
    went = f"the observed positions of {name} add up to a path of {length:.2f} m"
    words = f"{went}, but it was never more than {1000 * away:.0f} mm from where it began"
    return f"{words}: state the errors of the measurements, as in --uncertainty '{name.rpartition(':')[2]}=3 mm'"


def gap_around(times: FloatArray, unseen: NDArray[np.bool_], time: float) -> str:
    """Return in words the gap in observations that contains a time (s); ``times`` (n,) s and ``unseen`` (n,)."""
    known = times[~unseen]
    before, after = known[known < time], known[known > time]
    if before.size and after.size:
        return f"between {before[-1]:.2f} s and {after[0]:.2f} s"
    if before.size:
        return f"after {before[-1]:.2f} s"
    return f"before {after[0]:.2f} s" if after.size else "at any time"
