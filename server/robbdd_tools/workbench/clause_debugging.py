"""Debug one execution of a scenario: its clauses as places for breakpoints, and a run that pauses at them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.names.clause_places import clauses_in
from robbdd_tools.names.variant_places import variants_of
from robbdd_tools.protocol.specs import plain_name, scenario_key
from robbdd_tools.run.debugging import check_debugger, debugged, free_port, pausing
from robbdd_tools.run.json_documents import scenario_entry
from robbdd_tools.run.report import plain_sentence
from robbdd_tools.run.run_policy import Policy
from robbdd_tools.workbench.diagnostics import Place, Places
from robbdd_tools.workbench.folder import Keeping, new_folder
from robbdd_tools.workbench.model import load_all, read_instances
from robbdd_tools.workbench.plan import NO_SCENARIO_FITS, NothingSelected, Plan, Selection
from robbdd_tools.workbench.run import Run

if TYPE_CHECKING:
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.protocol.specs import ClauseSpec, ScenarioSpec


class NoClause(RobbddError):
    """The execution has no clause at this place. The message gives the reason."""


@dataclass(frozen=True, slots=True)
class DebugRequest:
    """The execution to debug: the first of the selected ones.

    ``variation`` and ``repetition`` are its numbers (from 1). With ``python``, a debugger of Python code can connect.
    """

    path: Path
    selection: Selection = field(default_factory=Selection)
    variation: int | None = None
    repetition: int | None = None
    scenex: tuple[Path, ...] = ()
    keeping: Keeping = field(default_factory=Keeping)
    python: bool = False


@dataclass(frozen=True, slots=True)
class NamedPlace:
    """A clause, a scenario or a template with its place in the text, if it has one."""

    name: str
    place: Place | None


class DebuggedScenario:
    """The selected execution before it begins.

    Raises ``ModelErrors``, ``NotAModel``, ``NothingToRun``, ``SelectionError``, ``SceneChoiceError`` and
    ``NoDebugger``.
    """

    def __init__(self, request: DebugRequest) -> None:
        if request.python:
            check_debugger()
        self._request = request
        model = load_all([request.path])
        selection = replace(request.selection, instances=read_instances(request.scenex))
        specs = [spec for spec in Plan.of(model, selection).specs() if _is_asked(spec, request)]
        if not specs:
            raise NothingSelected(NO_SCENARIO_FITS)
        self.spec: ScenarioSpec = specs[0]
        self.selected = len(specs)
        key = scenario_key(self.spec)

        def is_chosen(spec: ScenarioSpec) -> bool:
            return scenario_key(spec) == key

        chosen = replace(selection, is_wanted=is_chosen)
        self._plan = Plan.of(model, chosen)
        self._places: dict[str, NamedPlace] = {}
        self._clauses: dict[str, list[tuple[Place, str]]] = {}
        self._templates: dict[str, NamedPlace] = {}
        for file in self._plan.files:
            self._collect(file.snapshot, file.uri)

    def begin(self) -> Run:
        """Prepare the run, to be used as a context manager. Raises ``OSError`` and ``UserCodeRefused``."""
        place = new_folder(self._request.path, self._request.keeping)
        policy = pausing(Policy())
        if self._request.python:
            policy = debugged(policy, free_port())
        return Run.begin(self._plan, place.place, policy, on_close=place.remove)

    def clauses_at(self, path: Path, line: int) -> tuple[Place, frozenset[str]]:
        """Return the place and the IRIs of the clauses on a line (from 1), or of the innermost one that contains it.

        Raises ``NoClause`` if the line has none or the execution does not judge it.
        """
        uri = path_to_uri(path)
        if uri not in self._clauses:
            raise NoClause(f"{path.name} is not part of the model {self._request.path.name}")
        here = [(place, iri) for place, iri in self._clauses[uri] if place.line <= line <= place.end_line]
        if not here:
            raise NoClause("there is no clause on this line")
        first = [(place, iri) for place, iri in here if place.line == line] or here[-1:]
        judged = _iris(self.spec)
        found = [(place, iri) for place, iri in first if iri in judged]
        if not found:
            raise NoClause(f"{_local(self.spec.name)} does not judge this clause")
        return found[0][0], frozenset(iri for _, iri in found)

    def clause_lines(self, path: Path) -> list[int]:
        """Return the lines (from 1) of a file on which clauses of the execution begin."""
        judged = _iris(self.spec)
        return sorted({place.line for place, iri in self._clauses.get(path_to_uri(path), ()) if iri in judged})

    def title(self, clause: ClauseSpec) -> str:
        """Return the name of a clause or its behaviour in the model; if it has no name, its sentence."""
        found = self._places.get(clause.iri)
        return plain_sentence(clause.sentence) if found is None else found.name

    def place(self, iri: str) -> Place | None:
        """Return the place of a clause or a scenario."""
        found = self._places.get(iri)
        return None if found is None else found.place

    def template(self) -> NamedPlace | None:
        """Return the template of the scenario."""
        return self._templates.get(self.spec.variant)

    def _collect(self, snapshot: Snapshot, uri: str) -> None:
        """Find the clauses, variants and templates of a model and its imports."""
        places = Places(snapshot)
        for file in snapshot.closure(uri):
            name = file.document.uri
            known = self._clauses.setdefault(name, [])
            for clause in clauses_in(snapshot, name):
                place = places.of(name, clause.span)
                self._places[clause.iri] = NamedPlace(clause.name, places.of(name, clause.head))
                if (place, clause.iri) not in known:
                    known.append((place, clause.iri))
            for variant in variants_of(snapshot, name):
                definition, template = variant.definition, variant.template
                self._places[variant.iri] = NamedPlace(definition.symbol.name, places.of(name, definition.span))
                if template is not None:
                    there = NamedPlace(template.symbol.name, places.of(template.uri, template.span))
                    self._templates[variant.iri] = there


def clause_places(spec: ScenarioSpec, iris: frozenset[str]) -> Iterator[tuple[int, int | None]]:
    """Yield the feature line of each clause in ``iris``; for a fluent of a group in ``iris``, also its number there."""
    for clause in spec.clauses:
        if clause.iri in iris:
            yield clause.line, None
        else:
            yield from ((clause.line, number) for number, part in enumerate(clause.parts) if part in iris)


def scenario_values(spec: ScenarioSpec) -> dict[str, object]:
    """Return the values of a scenario by the plain names of its variables."""
    return {plain_name(name): value for name, value in spec.values.items()}


def scene_document(run: Run, written: Mapping[str, Any], line: int | None = None) -> dict[str, Any]:
    """Return the debugged execution so far in the form of ``docs/schemas/trace.schema.json``.

    The clauses have no places. ``written`` is the output of ``WriteScene``, and ``line`` is the feature line of the
    clause at which the execution has paused.
    """
    (spec,), parts = run.manifest.scenarios, written["parts"]
    entries = run.progress.scenario_json(0)["clauses"]
    judged = run.progress.scenarios[0].judged
    return {
        "run": run.number,
        "folder": path_to_uri(run.folder.absolute()),
        "scenario": scenario_entry(0, spec, "unknown", trace=True),
        **{name: value for name, value in written.items() if name != "parts"},
        "clauses": [
            {
                **entry,
                "reason": entry["reason"] if clause.line in judged else "not judged yet",
                "sentence": plain_sentence(clause.sentence),
                "source": None,
                "stale": False,
                "parts": parts.get(str(clause.line), []),
            }
            for clause, entry in zip(spec.clauses, entries, strict=True)
        ],
        "paused_at": next((number for number, clause in enumerate(spec.clauses) if clause.line == line), None),
        "source": None,
    }


def _is_asked(spec: ScenarioSpec, request: DebugRequest) -> bool:
    numbers = ((request.variation, spec.variation), (request.repetition, spec.repetition))
    return all(asked in (None, number) for asked, number in numbers)


def _iris(spec: ScenarioSpec) -> set[str]:
    return {iri for clause in spec.clauses for iri in (clause.iri, *clause.parts)}


def _local(name: str) -> str:
    return name.rpartition(":")[2]
