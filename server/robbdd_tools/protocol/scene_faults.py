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
    """A reason for which every run of a scene instance would refuse it, and its source position.

    ``entry`` is the entry of the model at that position that is wrong, if a single one is.
    """

    kind: str
    reason: str
    origin: Origin | None
    entry: ModelEntry | None = None
