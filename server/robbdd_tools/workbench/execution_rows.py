"""Results of executions as plain data for programs: one object per execution, one row per clause."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, cast

from robbdd_tools.catalog.executable import ChosenScene, Substitution
from robbdd_tools.monitor.contact import Contact
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.specs import NO_PHYSICS


@dataclass(frozen=True, slots=True)
class ClauseResult:
    """The verdict on one clause of one execution.

    - ``role``: ``given``, ``when`` or ``then``.
    - ``margin``: the robustness in ``unit`` (SI); positive if the clause holds; ``None`` if unknown or not measurable.
    - ``at``: the instant of the violation (s, simulated).
    - ``worst_at``: the instant of the smallest margin (s, simulated).
    - ``reason``: why the clause is violated or unknown.
    - ``cause``: the type of the reason of an unknown verdict.
    - ``vacuous``: why the clause could not have been violated.
    - ``operand``: the number (from 0, in the order of the sentence) of the fluent that decides the verdict.
    """

    name: str
    iri: str
    role: str
    sentence: str
    verdict: Outcome
    margin: float | None
    unit: str
    at: float | None
    worst_at: float | None
    reason: str
    vacuous: str
    cause: Cause | None = None
    operand: int | None = None


@dataclass(frozen=True, slots=True)
class ExecutionResult:
    """The result of one execution of a scenario.

    - ``index``: the position of the execution in the run (from 0).
    - ``variation``: the number of the scenario in its variant (from 1).
    - ``repetition``: the number of the repetition of the scenario (from 1).
    - ``values``: maps variables to CURIEs, literals or lists of them.
    - ``execution``: the CURIE of the ``.bddx`` execution; empty without one.
    - ``duration``: simulated time in s; ``None`` if the execution did not finish.
    - ``substitution``: the catalog behaviour that was executed instead of the model's implementation, or ``None``.
    - ``scene_instance``: the scene instance of a ``.scenex`` that the user chose, or ``None``.
    - ``world``: ``kinematic``, or empty for physics.
    - ``contacts``: contacts of agents that no clause is about; none in the results of a study.
    """

    index: int
    name: str
    story: str
    variant: str
    variation: int
    repetition: int
    execution: str
    model: str
    values: Mapping[str, Any]
    seed: int
    verdict: Outcome
    duration: float | None
    clauses: tuple[ClauseResult, ...]
    substitution: Substitution | None = None
    scene_instance: ChosenScene | None = None
    world: str = ""
    contacts: tuple[Contact, ...] = ()

    @property
    def choices(self) -> tuple[str, ...]:
        """The user's choices that the model does not state, in words."""
        choices = (self.substitution, self.scene_instance, NO_PHYSICS if self.world else None)
        return tuple(str(one) for one in choices if one is not None)

    def rows(self) -> Iterator[dict[str, Any]]:
        """Yield one flat dictionary for each clause. The values of variables are in columns called ``value.NAME``."""
        own: dict[str, Any] = {
            "index": self.index,
            "scenario": self.name,
            "variant": self.variant,
            "variation": self.variation,
            "repetition": self.repetition,
            "execution": self.execution,
            "substitution": "" if self.substitution is None else str(self.substitution),
            "scene_instance": "" if self.scene_instance is None else str(self.scene_instance),
            "world": self.world or "physics",
            "seed": self.seed,
            "duration": self.duration,
            "scenario_verdict": str(self.verdict),
        }
        values = {f"value.{name}": _cell(value) for name, value in self.values.items()}
        for clause in self.clauses:
            yield {
                **own,
                **values,
                "clause": clause.name,
                "role": clause.role,
                "verdict": str(clause.verdict),
                "margin": clause.margin,
                "unit": clause.unit,
                "at": clause.at,
                "reason": clause.reason,
            }


def execution_result(index: int, entry: Mapping[str, Any]) -> ExecutionResult:
    """Return an entry of ``scenarios`` in ``docs/schemas/run.schema.json`` as an object.

    ``index`` is the position of the entry.
    """
    return ExecutionResult(
        index,
        entry["name"],
        entry["story"],
        entry["variant"],
        entry["variation"],
        entry["repetition"],
        entry["execution"] or "",
        entry["model"],
        entry["values"],
        entry["seed"],
        Outcome(entry["verdict"]),
        entry["duration"],
        tuple(map(_clause, entry["clauses"])),
        Substitution(**entry["substitution"]) if entry.get("substitution") else None,
        ChosenScene(**entry["scene_instance"]) if entry.get("scene_instance") else None,
        entry.get("world", ""),
        tuple(Contact(**one) for one in entry.get("contacts", ())),
    )


def execution_results(document: Mapping[str, Any]) -> tuple[ExecutionResult, ...]:
    """Return all ``scenarios`` of a document that follows ``docs/schemas/run.schema.json``."""
    return tuple(execution_result(index, entry) for index, entry in enumerate(document["scenarios"]))


def rows_of(executions: Iterable[ExecutionResult]) -> list[dict[str, Any]]:
    """Return the rows of several executions, for ``pandas.DataFrame(rows)`` or ``polars.from_dicts(rows)``."""
    return [row for execution in executions for row in execution.rows()]


def _clause(entry: Mapping[str, Any]) -> ClauseResult:
    return ClauseResult(
        entry["name"],
        entry["iri"],
        entry["role"],
        entry["sentence"],
        Outcome(entry["verdict"]),
        entry["robustness"],
        entry["unit"],
        entry["at"],
        entry.get("worst_at"),
        entry["reason"],
        entry.get("vacuous", ""),
        Cause(entry["cause"]) if entry.get("cause") else None,
        entry.get("operand"),
    )


def _cell(value: Any) -> Any:
    return ", ".join(map(str, cast(list[object], value))) if isinstance(value, list) else value
