"""Collect run messages into results, and write them as the documented JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from robbdd_tools.catalog.coordination import TreeSpec
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.monitor.verdict import Cause, Outcome
from robbdd_tools.protocol.messages import (
    ClauseJudged,
    MarginRanges,
    Output,
    RunFinished,
    RunMessage,
    UserCodeFailed,
    never_judged,
)
from robbdd_tools.protocol.messages import ScenarioFinished as Finished
from robbdd_tools.protocol.specs import ClauseSpec, Manifest, ScenarioSpec, plain_name
from robbdd_tools.run.consequences import Causes
from robbdd_tools.run.readable import clause_title
from robbdd_tools.run.vacuous_clauses import Vacuity


@dataclass(slots=True)
class ScenarioResult:
    """The verdicts that one scenario has so far, by feature line."""

    spec: ScenarioSpec
    judged: dict[int, ClauseJudged] = field(default_factory=dict[int, ClauseJudged])
    finished: Finished | None = None
    printed: str = ""
    """Output of users' code, lines with their line ends."""

    @property
    def verdict(self) -> Outcome:
        """The verdict: violated if any clause is violated, else unknown if any clause is unknown, else holds."""
        outcomes = {self.judged[c.line].verdict if c.line in self.judged else "unknown" for c in self.spec.clauses}
        if Outcome.VIOLATED in outcomes:
            return Outcome.VIOLATED
        return Outcome.UNKNOWN if Outcome.UNKNOWN in outcomes or not outcomes else Outcome.HOLDS


@dataclass(slots=True)
class RunResults:
    """All results of a run that are known so far. Pass its messages to ``apply`` in the order of arrival.

    ``ending`` is the reason why scenarios are open, and ``cause`` is the type of that reason.
    """

    manifest: Manifest
    scenarios: list[ScenarioResult] = field(init=False)
    complete: bool = False
    ending: str = ""
    cause: Cause | None = None
    faults: dict[str, Fault] = field(default_factory=dict[str, Fault])
    """Errors in users' code by their ``id``."""
    shared_faults: set[str] = field(default_factory=set[str])
    """The ``id`` of errors in code that all scenarios load."""
    _vacuity: Vacuity = field(default_factory=Vacuity)

    def __post_init__(self) -> None:
        self.scenarios = [ScenarioResult(spec) for spec in self.manifest.scenarios]

    def apply(self, message: RunMessage) -> None:
        """Update the results with a message."""
        match message:
            case ClauseJudged():
                self.scenarios[message.index].judged[message.line] = message
                self._vacuity.judged(self._clause(message.index, message.line), message)
            case MarginRanges(index, line, ranges, held_before):
                self._vacuity.varied(self._clause(index, line), ranges)
                self._vacuity.held(self._clause(index, line), held_before)
            case UserCodeFailed(index, fault):
                self.faults[fault.id] = fault
                if index is None:
                    self.shared_faults.add(fault.id)
            case Output(int(index), text):
                self.scenarios[index].printed += f"{text}\n"
            case Finished():
                self.scenarios[message.index].finished = message
            case RunFinished(ok):
                self.complete = ok
            case _:
                pass

    def close(self, reason: str, cause: Cause = Cause.NOT_EXECUTED) -> list[ClauseJudged]:
        """Set the verdict of every open clause to *unknown* with the given reason; return these judgements."""
        self.ending, self.cause = reason, cause
        closing = [
            never_judged(index, clause.line, reason, cause)
            for index, scenario in enumerate(self.scenarios)
            for clause in scenario.spec.clauses
            if clause.line not in scenario.judged
        ]
        for message in closing:
            self.apply(message)
        return closing

    def drop_unfinished(self) -> None:
        """Drop the verdicts of unfinished executions."""
        for scenario in self.scenarios:
            if scenario.finished is None:
                scenario.judged.clear()
                scenario.printed = ""

    def faults_of(self, scenario: ScenarioResult) -> list[Fault]:
        """Return the distinct errors in users' code that left clauses of a scenario unknown."""
        named = dict.fromkeys(one.fault for one in scenario.judged.values())
        found = [self.faults[name] for name in named if name in self.faults]
        if scenario.finished is None:
            found += [self.faults[name] for name in sorted(self.shared_faults - set(named))]
        return found

    def vacuous(self) -> Mapping[str, str]:
        """Map the IRI of each clause that could not have failed in this run to the reason why it could not."""
        return self._vacuity.reasons()

    def policies(self) -> Mapping[str, str]:
        """Map the IRI of each clause or part of a clause that a policy judges to the names of its policies."""
        found: dict[str, dict[str, None]] = {}
        for scenario in self.scenarios:
            for policy in () if scenario.spec.execution is None else scenario.spec.execution.policies:
                found.setdefault(policy.clause, {})[plain_name(policy.iri)] = None
        return {clause: ", ".join(names) for clause, names in found.items()}

    def titles(self) -> Mapping[str, str]:
        """Map the IRI of each clause to its title. A title that is a sentence has the values of the first scenario."""
        every = (clause for scenario in reversed(self.scenarios) for clause in reversed(scenario.spec.clauses))
        found = {clause.iri: clause_title(clause) for clause in every}
        return dict(reversed(found.items()))

    def _clause(self, index: int, line: int) -> ClauseSpec:
        return next(clause for clause in self.scenarios[index].spec.clauses if clause.line == line)

    def first_failure(self) -> int | None:
        """Return the number of the first finished scenario with a clause that does not hold."""
        for index, scenario in enumerate(self.scenarios):
            if scenario.finished is not None and any(one.verdict != Outcome.HOLDS for one in scenario.judged.values()):
                return index
        return None

    def count(self, outcome: Outcome) -> int:
        """Return the number of scenarios whose verdict is ``outcome``."""
        return sum(scenario.verdict is outcome for scenario in self.scenarios)

    def as_json(self) -> dict[str, Any]:
        """Return the results as a document that follows ``docs/schemas/run.schema.json``."""
        return {
            "seed": self.manifest.seed,
            "model": self.manifest.model,
            "complete": self.complete,
            "finished": sum(scenario.finished is not None for scenario in self.scenarios),
            "ending": self.ending,
            "scenarios": list(self._scenarios()),
        }

    def choices(self) -> Iterable[str]:
        """Return the user's choices that the models do not state, each once."""
        return dict.fromkeys(words for scenario in self.scenarios for words in scenario.spec.choices)

    def scenario_json(self, index: int) -> dict[str, Any]:
        """Return the entry of one scenario in the list ``scenarios`` of the document of ``as_json``."""
        return _scenario(self.scenarios[index], self.vacuous())

    def _scenarios(self) -> Iterable[dict[str, Any]]:
        vacuous = self.vacuous()
        return (_scenario(scenario, vacuous) for scenario in self.scenarios)


def unjudged(clause: ClauseSpec) -> ClauseJudged:
    """Return the verdict *unknown* of a clause that no message has judged."""
    return never_judged(0, clause.line, "the clause was never judged", Cause.NOT_EXECUTED)


def finished_in(document: Mapping[str, Any]) -> frozenset[int]:
    """Return the numbers of the scenarios that a results document lists as finished."""
    return frozenset(i for i, entry in enumerate(document["scenarios"]) if entry.get("duration") is not None)


def _scenario(scenario: ScenarioResult, vacuous: Mapping[str, str]) -> dict[str, Any]:
    spec = scenario.spec
    return {
        "story": spec.story,
        "variant": spec.variant,
        "variation": spec.variation,
        "name": spec.name,
        "values": dict(spec.values),
        "seed": spec.seed,
        "model": spec.model,
        "execution": None if spec.execution is None else spec.execution.name,
        "substitution": None if spec.substitution is None else asdict(spec.substitution),
        "scene_instance": None if spec.chosen_scene is None else asdict(spec.chosen_scene),
        **({"world": spec.world} if spec.world else {}),
        "repetition": spec.repetition,
        "shared": None if spec.tree is None else _shared(spec.tree, spec.node),
        "duration": None if scenario.finished is None else scenario.finished.simulated,
        "resampled": 0 if scenario.finished is None else scenario.finished.resampled,
        "contacts": [] if scenario.finished is None else [asdict(one) for one in scenario.finished.contacts],
        "verdict": str(scenario.verdict),
        "clauses": list(_clauses(scenario, vacuous)),
    }


def _shared(tree: TreeSpec, node: str) -> dict[str, Any]:
    """Return JSON that names the behaviour-tree execution from which a scenario was judged, and the scenario's node."""
    return {"execution": tree.name, "tree": tree.tree, "node": node}


def _clauses(scenario: ScenarioResult, vacuous: Mapping[str, str]) -> Iterator[dict[str, Any]]:
    causes = Causes()
    for position, clause in enumerate(scenario.spec.clauses):
        judged = scenario.judged.get(clause.line) or unjudged(clause)
        because = causes.add(position, clause_title(clause), judged)
        found = _clause(clause, judged, vacuous.get(clause.iri, ""))
        yield {**found, "because": None if because is None else because.position}


def _clause(clause: ClauseSpec, judged: ClauseJudged, vacuous: str) -> dict[str, Any]:
    return {
        "iri": clause.iri,
        "name": clause.name,
        "role": clause.role,
        "sentence": clause.sentence,
        "verdict": judged.verdict,
        "robustness": judged.robustness,
        "unit": judged.unit,
        "at": judged.at,
        "reason": judged.reason,
        "worst_at": judged.worst_at,
        "vacuous": vacuous,
        "cause": judged.cause,
        "operand": judged.operand,
    }
