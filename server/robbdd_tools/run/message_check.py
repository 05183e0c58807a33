"""Detect well-formed messages that other code, not the agent, wrote to its channel."""

from __future__ import annotations

from collections.abc import Sequence

from robbdd_tools.protocol.messages import RunMessage
from robbdd_tools.protocol.specs import ScenarioSpec


def misfit(message: RunMessage, specs: Sequence[ScenarioSpec], executed: int | None) -> str:
    """Return the reason why the agent of scenario ``executed`` cannot have sent a message.

    The reason is empty if the agent can have sent it. ``specs`` are the scenarios of the manifest.
    """
    index: int | None = getattr(message, "index", None)
    line: int | None = getattr(message, "line", None)
    kind = type(message).__name__
    if index is None:
        return ""
    if index != executed or not 0 <= index < len(specs):
        return f"ignored {kind} of scenario {index}, which the agent does not execute"
    if line is not None and all(line != clause.line for clause in specs[index].clauses):
        return f"ignored {kind} of line {line}, where scenario {index} has no clause"
    return ""
