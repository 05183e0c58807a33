"""Results of runs for each scenario, with digests of the text that was judged."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.plain import from_plain
from robbdd_tools.catalog.executable import ChosenScene, Substitution
from robbdd_tools.features.executions import executions_of, relevant_declarations
from robbdd_tools.monitor.fault import Fault
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.variant_places import variants_of

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.executions import PlacedExecution
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.variant_places import PlacedVariant

_TOKEN = re.compile(r"\"(?:\\.|[^\"\\])*\"|'(?:\\.|[^'\\])*'|//[^\n]*|\s+|.", re.DOTALL)
MAX_DIGESTS = 20_000


@dataclass(frozen=True, slots=True)
class Judgement:
    """One verdict on a clause.

    - ``outcome``: ``holds``, ``violated``, ``unknown``, or ``undefined`` if no step can judge the clause.
    - ``margin``: the margin as text.
    - ``said``: the verdict as text, with its instant and its reason.
    - ``failure``: why the clause is violated or unknown, the reason first; empty if it holds.
    - ``rank``: the worst of several verdicts has the smallest rank.
    - ``digest``: the digest of the clause's text when it was judged.
    - ``line``: the line of the clause's step in the feature.
    - ``vacuous``: why the clause could not have failed in the whole run; empty if it could.
    - ``fault``: the ``id`` of the error in users' code that made the clause unknown.
    - ``because``: the IRI of another clause of the execution that caused this verdict; empty if there is none.
    - ``because_words``: a text that names this other clause.
    """

    name: str
    outcome: str
    margin: str
    rank: float
    said: str
    digest: str
    line: int = 0
    vacuous: str = ""
    operand: int | None = None
    fault: str = ""
    failure: str = ""
    because: str = ""
    because_words: str = ""


@dataclass(slots=True)
class JudgedScenario:
    """One execution of a scenario, with its values in words and the verdicts on its clauses by IRI.

    The scenario is number ``variation`` of a variant.

    - ``digest``: the digest of the text of the variant and its template.
    - ``row``: the digest of the scenario's table row; empty if it has none.
    - ``run``: the number of the stored run; 0 if unknown.
    - ``index``: the number of the scenario in that run.
    - ``execution``: the IRI of the ``.bddx`` execution; empty without one.
    - ``execution_digest``: the digest of the text of that execution; empty without one.
    - ``faults``: the errors in users' code.
    - ``repetition``: the number of this execution of the scenario in the run (from 1).
    - ``repetitions``: how often the run was to execute the scenario.
    - ``seed``: the seed that the user gave for the run, or ``None``.
    - ``substitution``: the catalog behaviour that was executed instead of the model's.
    - ``scene_instance``: the scene instance that the user chose.
    - ``world``: the description of a world without physics in the results; ``None`` for a world with physics.
    - ``project``: the root folder of the model's project. Models of different projects may have the same IRIs.
    """

    model: str
    variant: str
    variation: int
    values: str
    digest: str
    row: str
    clauses: dict[str, Judgement] = field(default_factory=dict[str, Judgement])
    finished: bool = False
    run: int = 0
    index: int = 0
    execution: str = ""
    execution_digest: str = ""
    faults: tuple[Fault, ...] = ()
    repetition: int = 1
    repetitions: int = 1
    seed: int | None = None
    substitution: Substitution | None = None
    scene_instance: ChosenScene | None = None
    world: str | None = None
    project: str = ""

    @property
    def scenario_key(self) -> ScenarioKey:
        """The identity of the scenario among all results."""
        return self.project, self.variant, self.variation

    @property
    def outcome(self) -> str:
        """Violated if any clause is violated, else unknown if any is unknown or none was judged, else holds."""
        outcomes = {judgement.outcome for judgement in self.clauses.values()}
        if "violated" in outcomes:
            return "violated"
        return "holds" if self.finished and outcomes == {"holds"} else "unknown"

    def judge(self, iri: str, judgement: Judgement) -> None:
        """Add a verdict on a clause. A clause that is repeated within the scenario keeps its worst verdict."""
        known = self.clauses.get(iri)
        if known is None or judgement.rank < known.rank:
            self.clauses[iri] = judgement

    def mark_vacuous(self, reasons: Mapping[str, str]) -> None:
        """Record the reasons why clauses could not have failed in the run, by the IRI of the clause."""
        for iri in self.clauses.keys() & reasons.keys():
            self.clauses[iri] = replace(self.clauses[iri], vacuous=reasons[iri])


ScenarioKey = tuple[str, str, int]
"""The project, the variant's IRI and the number of a scenario."""
Judged = tuple[JudgedScenario, Judgement]


@dataclass(frozen=True, slots=True)
class RejudgedExecution:
    """The edited clauses of a stored execution by IRI, re-judged on its trace.

    If the trace is no evidence for the edited scenario, ``reason`` is the reason, and no clause is judged.
    """

    reason: str = ""
    clauses: Mapping[str, Judgement] = field(default_factory=dict[str, Judgement])


@dataclass(frozen=True, slots=True)
class RejudgedClause:
    """A clause of a stored execution after an edit.

    - ``judgement``: the verdict of the trace on the edited clause; ``None`` if the trace is no evidence.
    - ``before``: the verdict of the run, if it judged the clause.
    - ``reason``: the reason why the trace is no evidence.
    """

    scenario: JudgedScenario
    judgement: Judgement | None
    before: Judgement | None
    reason: str = ""


RejudgedExecutions = Mapping[str, Mapping[tuple[int, int], RejudgedExecution]]
"""Model → the executions that its edits concern, by the number of the run and the number of the execution."""


@dataclass(frozen=True, slots=True)
class Findings:
    """The results at one moment: verdicts for each clause, and scenarios for each variant.

    ``rejudged`` are the verdicts of stored traces on clauses that were edited since their run.
    """

    clauses: Mapping[str, tuple[Judged, ...]]
    variants: Mapping[str, tuple[JudgedScenario, ...]]
    rejudged: Mapping[str, tuple[RejudgedClause, ...]] = field(default_factory=dict[str, tuple[RejudgedClause, ...]])


NOTHING = Findings({}, {})


class Results:
    """The latest result of every scenario. A new result replaces the previous one."""

    def __init__(self, scenarios: Iterable[JudgedScenario] = ()) -> None:
        self._scenarios: dict[ScenarioKey, list[JudgedScenario]] = {}
        self.add(scenarios)

    def __iter__(self) -> Iterator[JudgedScenario]:
        """Iterate over all scenarios."""
        return (scenario for several in self._scenarios.values() for scenario in several)

    def add(self, scenarios: Iterable[JudgedScenario]) -> None:
        """Add scenarios without replacing others, because a scenario may be executed several times."""
        for scenario in scenarios:
            self._scenarios.setdefault(scenario.scenario_key, []).append(scenario)

    def drop(self, key: ScenarioKey, execution: str = "", repetition: int | None = None) -> None:
        """Remove the results of a scenario that is executed again.

        Results by executions other than ``execution`` stay. If a ``repetition`` is given, the results of other
        repetitions stay, too.
        """
        known = self._scenarios.pop(key, [])
        self.add(one for one in known if not _is_replaced(one, execution, repetition))

    def merge(self, scenarios: Iterable[JudgedScenario], newest: int, *, some_repetitions: bool = False) -> None:
        """Add the results of one stored run. A scenario that has results of the same or a later run is skipped.

        ``newest`` is the number of the latest run in the store. ``some_repetitions`` is true if the run executed only
        some of the repetitions; the others then keep their results.
        """
        groups: dict[tuple[ScenarioKey, str, int | None], list[JudgedScenario]] = {}
        for one in scenarios:
            repetition = one.repetition if some_repetitions else None
            groups.setdefault((one.scenario_key, one.execution, repetition), []).append(one)
        for (key, execution, repetition), group in groups.items():
            known = self._scenarios.get(key, ())
            replaced = [one for one in known if _is_replaced(one, execution, repetition)]
            if not any(newest >= one.run >= group[0].run for one in replaced):
                self.drop(key, execution, repetition)
                self.add(group)

    def discard(self, scenario: JudgedScenario) -> None:
        """Remove the result of one execution of a scenario."""
        known = self._scenarios.pop(scenario.scenario_key, [])
        self.add(one for one in known if one is not scenario)

    def drop_others(self, project: str, variant: str, kept: Collection[int]) -> None:
        """Remove the results of scenarios that a variant of a project no longer has."""
        for key in [key for key in self._scenarios if key[:2] == (project, variant) and key[2] not in kept]:
            del self._scenarios[key]

    def drop_deleted(self, model: str, variants: Collection[str], executions: Collection[str] = ()) -> None:
        """Remove the results of variants and executions that a model no longer contains."""
        own = (entry for entry in self if entry.model == model)
        gone = {(entry.project, entry.variant) for entry in own if entry.variant not in variants}
        for key in [key for key in self._scenarios if key[:2] in gone]:
            del self._scenarios[key]
        known = {"", *executions}
        for entry in [entry for entry in self if entry.model == model and entry.execution not in known]:
            self.discard(entry)


def _is_replaced(known: JudgedScenario, execution: str, repetition: int | None) -> bool:
    """Return whether a new result of ``execution`` replaces a known one.

    If ``repetition`` is ``None``, the new result replaces all repetitions, otherwise only that repetition.
    """
    by_other = execution != "" and known.execution not in ("", execution)
    return not by_other and repetition in (None, known.repetition)


@dataclass(frozen=True, slots=True)
class Digests:
    """Digests of the text that runs judge.

    Digests of clauses and variants are stored by IRI, digests of table rows by variant and number. ``executions`` are
    the digests of the executions that the file itself declares, by IRI.
    """

    clauses: Mapping[str, str]
    variants: Mapping[str, str]
    rows: Mapping[tuple[str, int], str]
    executions: Mapping[str, str]


def digests_of(snapshot: Snapshot, uri: str) -> Digests:
    """Return the digests of a file and its imports."""
    clauses: dict[str, str] = {}
    variants: dict[str, str] = {}
    rows: dict[tuple[str, int], str] = {}
    for file in snapshot.closure(uri):
        name = file.document.uri
        clauses |= {clause.iri: digest(snapshot, name, clause.span) for clause in clauses_in(snapshot, name)}
        for variant in variants_of(snapshot, name):
            variants[variant.iri] = variant_digest(snapshot, variant)
            for number, row in enumerate(variant.rows, start=1):
                rows[variant.iri, number] = digest(snapshot, name, row)
    executions = {one.iri: execution_digest(snapshot, one) for one in executions_of(snapshot, uri)}
    return Digests(clauses, variants, rows, executions)


def digest(snapshot: Snapshot, uri: str, span: Span) -> str:
    """Return the digest of the text in a span. It does not depend on comments and layout."""
    file = snapshot.file(uri)
    return "" if file is None else _digest(file.document.text[span.start : span.end])


def variant_digest(snapshot: Snapshot, variant: PlacedVariant) -> str:
    """Return the digest of a variant and its template."""
    parts: tuple[Definition | None, ...] = (variant.definition, variant.template)
    return " ".join(digest(snapshot, part.uri, part.extent) for part in parts if part is not None)


def execution_digest(snapshot: Snapshot, execution: PlacedExecution) -> str:
    """Return the digest of an execution, its dependencies and its variant."""
    own = (digest(snapshot, site.uri, site.placed.span) for site in relevant_declarations(execution))
    return " ".join((*own, variant_digest(snapshot, execution.variant)))


_digests: dict[bytes, str] = {}
"""Cached digests by the hash of the text. If the texts themselves were cached, memory would grow with each edit."""


def _digest(text: str) -> str:
    key = hashlib.sha256(_bytes(text)).digest()
    found = _digests.get(key)
    if found is None:
        if len(_digests) >= MAX_DIGESTS:
            _digests.clear()
        tokens = (match[0] for match in _TOKEN.finditer(text))
        words = ("" if token.startswith("//") or token.isspace() else token for token in tokens)
        found = hashlib.sha256(_bytes("\0".join(word for word in words if word))).hexdigest()[:16]
        _digests[key] = found
    return found


def _bytes(text: str) -> bytes:
    return text.encode("utf-8", "surrogatepass")


def as_json(scenario: JudgedScenario) -> dict[str, Any]:
    """Return a scenario as plain data."""
    return asdict(scenario)


def from_json(data: object) -> JudgedScenario:
    """Return the scenario that plain data describes.

    Raises ``KeyError``, ``TypeError`` or ``AttributeError`` if the data has another form.
    """
    return from_plain(JudgedScenario, data)
