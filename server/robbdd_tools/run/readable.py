"""Format the reasons and clauses of a run for people: local names, the error first and its place last."""

from __future__ import annotations

import re
from collections.abc import Mapping, Set
from dataclasses import replace
from pathlib import PurePath
from typing import TYPE_CHECKING

from robbdd_tools.run.report import plain_sentence

if TYPE_CHECKING:
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.protocol.messages import ClauseJudged
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec

_CURIE = re.compile(r"[\w.-]+:[\w-]+(?:\.[\w-]+)*")
_PLACE = re.compile(r"(?P<file>[^\s:]+\.\w+):(?P<line>\d+):\d+: (?P<words>.+)", re.DOTALL)
_NO_FAULTS: Mapping[str, Fault] = {}


def clause_title(clause: ClauseSpec) -> str:
    """Return a title of a clause: its name in the model, *the behaviour*, or its sentence in quotes."""
    return title(clause.name, clause.sentence)


def title(name: str, sentence: str) -> str:
    """Return the ``clause_title`` of a clause with this name and sentence.

    A clause without a name in the model has a generated one, which is a path.
    """
    if "." not in name:
        return name
    return "the behaviour" if name.startswith("when-bhv-") else f"'{plain_sentence(sentence)}'"


def readable(judged: ClauseJudged, spec: ScenarioSpec, faults: Mapping[str, Fault] = _NO_FAULTS) -> ClauseJudged:
    """Return a verdict whose reason has local names instead of CURIEs, and its place in a file at its end.

    ``faults`` are the known errors in users' code by their ``id``. If the verdict has one, it replaces the reason.
    """
    fault = faults.get(judged.fault)
    if fault is not None:
        return replace(judged, reason=_fault_words(fault))
    known = _names(spec)
    reason = _CURIE.sub(lambda found: found[0].rpartition(":")[2] if found[0] in known else found[0], judged.reason)
    placed = _PLACE.fullmatch(reason)
    if placed is not None:
        reason = f"{placed['words']} ({placed['file']}, line {placed['line']})"
    return judged if reason == judged.reason else replace(judged, reason=reason)


def _fault_words(fault: Fault) -> str:
    place = fault.place
    return fault.summary if place is None else f"{fault.summary} ({PurePath(place.file).name}, line {place.line})"


def _names(spec: ScenarioSpec) -> Set[str]:
    scene = spec.scene
    return {*scene.objects, *scene.agents, *scene.workspaces, *scene.contains, *scene.places.values(), *spec.events}
