"""Faults of scene instances, as the process that finds them reports them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from robbdd_tools.catalog.executable import ModelEntry, Origin


class FaultKind(StrEnum):
    """The part of a scene that is wrong: a model, a pose, or several poses that overlap."""

    MODEL = "model"
    POSE = "pose"
    OVERLAP = "overlap"


@dataclass(frozen=True, slots=True)
class SceneFault:
    """A reason why every run would refuse a scene instance, and its source position.

    If a single entry of the model at that position is wrong, ``entry`` is this entry.
    """

    kind: str
    reason: str
    origin: Origin | None
    entry: ModelEntry | None = None
