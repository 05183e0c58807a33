"""Models as users handle them: a file, a folder or a text, with its findings and scenarios."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import path_to_uri, uri_to_path
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.features.diagnostics import all_diagnostics, text_diagnostics
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.workbench.diagnostics import Finding, Place, Places, findings
from robbdd_tools.workbench.named_files import NotAModel, named_files, refuse_other_files
from robbdd_tools.workbench.scene_choice import SceneChoiceError

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.graph.acceptance_model import AcceptanceModel
    from robbdd_tools.graph.verified_requirements import LinkedRequirement
    from robbdd_tools.graph.write.built import BuiltGraph
    from robbdd_tools.workbench.plan import Plan

NO_SCENARIO = "the model has no scenario to run"


class ModelErrors(RobbddError):
    """A model has errors. ``findings`` are its errors; there is at least one."""

    def __init__(self, found: tuple[Finding, ...]) -> None:
        super().__init__("\n".join(map(str, found)))
        self.findings = found


class NothingToRun(RobbddError):
    """None of the models has a scenario."""


@dataclass(frozen=True, eq=False)
class ModelFile:
    """One model of a snapshot. ``name`` is its name in reports: the path as given by the user, or its URI."""

    snapshot: Snapshot
    uri: str
    name: str

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All diagnostics of the file and its imports, including those of shapes."""
        return tuple(all_diagnostics(self.snapshot, self.uri))

    @cached_property
    def graph(self) -> BuiltGraph:
        """The knowledge graph of the file and its imports; raises ``ModelErrors``."""
        from robbdd_tools.graph.write.build import build_graph

        errors = [one for one in self.diagnostics if one.severity is Severity.ERROR]
        if errors:
            raise ModelErrors(findings(self.snapshot, errors))
        return build_graph(self.snapshot, self.uri)

    @cached_property
    def acceptance(self) -> AcceptanceModel:
        """The acceptance criteria as plain data; raises ``ModelErrors``."""
        from robbdd_tools.graph.places import placed_model

        return placed_model(self.graph, self.snapshot)

    @cached_property
    def requirements(self) -> tuple[LinkedRequirement, ...]:
        """The requirements of the model with the scenarios and clauses that verify them; raises ``ModelErrors``."""
        from robbdd_tools.gherkin.variations import count
        from robbdd_tools.graph.verified_requirements import counted_links, requirement_links

        links = requirement_links(self.acceptance)
        variants = (variant for story in self.acceptance.stories if links for variant in story.variants)
        return counted_links(links, {one.iri: count(one.variation) for one in variants})

    def place(self, iri: str) -> Place | None:
        """Return the place where an element is declared, or ``None`` if this model does not declare it.

        Raises ``ModelErrors``.
        """
        location = self.graph.sources.node(iri)
        return None if location is None else Places(self.snapshot).of(location.uri, location.span)

    @cached_property
    def digest(self) -> str:
        """The SHA-256 of the model's graph. Raises ``ModelErrors``."""
        from robbdd_tools.graph.write.digest import graph_digest

        return graph_digest(self.graph)

    @property
    def is_unreadable(self) -> bool:
        """Whether a file of the model has no text: it is missing, too large or not text."""
        parts = (self.uri, *self.snapshot.joined.get(self.uri, ()))
        return any(self.snapshot.unreadable(uri) is not None for uri in parts)

    @property
    def has_scenarios(self) -> bool:
        """Whether the model has scenarios to run. Raises ``ModelErrors``."""
        return any(story.variants for story in self.acceptance.stories)


class DraftFile(ModelFile):
    """A model that is being edited. Its shapes are not validated, because that takes longer than building its graph.

    An editor validates them at the same time, and a run refuses a model that violates one.
    """

    @cached_property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The diagnostics of the file and its imports, without those of shapes."""
        return tuple(text_diagnostics(self.snapshot, self.uri))


@dataclass(frozen=True, eq=False)
class Model:
    """The models that were loaded together.

    They were loaded from ``path``, which is a file, a folder or the name of a text, or from several ``paths``.
    """

    path: Path
    files: Sequence[ModelFile]
    paths: Sequence[Path] = ()

    @cached_property
    def diagnostics(self) -> tuple[Finding, ...]:
        """All findings, without duplicates, ordered by file and place."""
        found: dict[Finding, None] = {}
        known: set[str] = set()
        for file in self.files:
            cycle = file.snapshot.reachability.cycle(file.uri)
            if len(cycle) == 1 or len(self.files) == 1:
                found |= dict.fromkeys(findings(file.snapshot, file.diagnostics))
            elif file.uri not in known:
                # Each of these files imports all others: one validation has the findings of them all.
                known.update(cycle)
                found |= dict.fromkeys(findings(file.snapshot, all_diagnostics(file.snapshot, file.uri, cycle)))
        return tuple(found)

    @cached_property
    def scene_findings(self) -> tuple[Finding, ...]:
        """The findings about models and given poses of executable scenes that a run would refuse.

        A process sets these scenes up, without users' code, so this takes about a second if there are any.
        """
        from robbdd_tools.workbench.scene_findings import SceneChecker

        checker, found = SceneChecker(), dict[Finding, None]()
        scenes = {
            one.document.uri: file.snapshot
            for file in self.files
            for one in file.snapshot.closure(file.uri)
            if one.document.uri.endswith(".scenex")
        }
        for uri, snapshot in scenes.items():
            found |= dict.fromkeys(findings(snapshot, checker.findings(snapshot, uri)))
        return tuple(found)

    @property
    def is_valid(self) -> bool:
        """Whether there is no error among the findings, so that the model can be run."""
        return not any(finding.is_error for finding in self.diagnostics)

    @cached_property
    def runnable(self) -> tuple[ModelFile, ...]:
        """The models that have scenarios; those that have executions are first.

        Raises ``ModelErrors`` and ``NothingToRun``.
        """
        errors = tuple(finding for finding in self.diagnostics if finding.is_error)
        if errors:
            raise ModelErrors(errors)
        # An execution configures how its scenario runs, so the plain scenario need not run as well.
        ordered = sorted(self.files, key=lambda file: not file.uri.endswith(".bddx"))
        found = tuple(file for file in ordered if file.has_scenarios)
        if not found and len(self.files) == 1:
            start = Place(self.files[0].uri, 1, 1, 1, 1)
            raise ModelErrors((Finding(start, Severity.ERROR, "no-scenario", NO_SCENARIO),))
        if not found:
            raise NothingToRun(f"{self.path}: {NO_SCENARIO}")
        return found

    @property
    def digest(self) -> str:
        """The digest of the graphs of all runnable models. Raises the same errors as ``runnable``."""
        from robbdd_tools.graph.write.digest import joint_digest

        return joint_digest(file.digest for file in self.runnable)

    def graph(self, form: str = "ttl") -> str:
        """Return the knowledge graph of the only file as text.

        ``form`` is ``ttl``, ``json-ld``, ``json-ld-expanded``, ``nt`` or ``xml``. Raises ``ModelErrors``, and
        ``ValueError`` if there are several files.
        """
        from robbdd_tools.graph.rdf.serialize import serialize

        if len(self.files) != 1:
            raise ValueError(
                f"{self.path} has {len(self.files)} models, and they cannot be loaded together: load one of them"
            )
        return serialize(self.files[0].graph.graph, form)

    def scenarios(
        self,
        *names: str,
        where: str | None = None,
        first: int | None = None,
        sample: int | None = None,
        pairwise: int | None = None,
        seed: int | None = None,
        substitutions: Mapping[str, str] | None = None,
        scenex: str | os.PathLike[str] | None = None,
    ) -> Plan:
        """Select scenarios to run.

        ``names`` are variants or executions (local name, CURIE or IRI; all without any). ``where`` is a condition on
        the values (``"robot=panda and target=~cube.*"``). At most one of these reduces the matches: the ``first`` N, a
        random ``sample`` of N, or a small set that covers all combinations of values of any 2 or 3 variables
        (``pairwise``). ``seed`` is the seed of the sample, and of the run unless the run has its own.
        ``substitutions`` maps behaviour implementations of a ``.bddx`` to the catalog behaviours to execute instead
        (``{"my-server": "pick-place"}``). ``scenex`` is a file: scenarios without an execution run in the scene
        instance that it declares for their scene.

        Raises ``ModelErrors``, ``NothingToRun``, ``SelectionError`` for an invalid selection, and ``NotAModel`` or
        ``SceneChoiceError`` for a ``scenex`` that does not fit.
        """
        from robbdd_tools.workbench.plan import Plan, Selection

        given = {"first": first, "sample": sample, "pairwise": pairwise}
        reducing = [name for name, value in given.items() if value is not None]
        if len(reducing) > 1:
            raise ValueError(f"give only one of {' and '.join(reducing)}")
        selection = Selection(
            names,
            where,
            first,
            sample,
            pairwise,
            seed,
            substitutions=dict(substitutions or {}),
            instances=() if scenex is None else read_instances([Path(scenex)]),
        )
        return Plan.of(self, selection)


def load(path: str | os.PathLike[str], *more: str | os.PathLike[str], text: str | None = None) -> Model:
    """Load a model (``.bdd``, ``.bddx``, ``.scene`` …, ``.ttl``, ``.json``, ``.jsonld``) or all models in a folder.

    ``more`` are further models; all graph files together are one model. ``text`` replaces the content of a single file,
    which need not exist; imports are relative to ``path``. Errors in the model are findings, not exceptions. Raises
    ``NotAModel``.
    """
    start = Path(path)
    if text is None:
        return load_all([start, *map(Path, more)])
    if more:
        raise ValueError("a text replaces one file: load it alone")
    refuse_other_files([start], must_exist=False)
    project = Project()
    project.open(path_to_uri(start), 0, text)
    return _model(start, project, [start])


def load_all(paths: Sequence[Path]) -> Model:
    """Load files, and all models in folders, into one project; the model is named after the first path.

    All graph files together are one model, named after the first of them. Raises ``NotAModel``.
    """
    files = named_files(paths)
    project = Project()
    distinct: dict[str, Path] = {}
    for file in files:
        distinct.setdefault(project.spellings.of(path_to_uri(file)), file)
    files = list(distinct.values())
    for uri in distinct:
        project.load(uri)
    first, *others = [file for file in files if graph_format(file.name)] or [Path()]
    if others:
        project.join(path_to_uri(first), list(map(path_to_uri, others)))
    return replace(_model(paths[0], project, [file for file in files if file not in others]), paths=paths)


def read_instances(paths: Iterable[Path], load_one: Callable[[Path], Model] | None = None) -> tuple[SceneInstance, ...]:
    """Return the scene instances that ``.scenex`` files declare, without those that they import.

    ``load_one`` loads a file, by default from the disk. Raises ``NotAModel``, ``ModelErrors`` and ``SceneChoiceError``.
    """
    from robbdd_tools.graph.places import placed_instances

    found: list[SceneInstance] = []
    for path in dict.fromkeys(paths):
        if path.suffix != ".scenex":
            raise NotAModel(f"{path} is not a .scenex file")
        (file,) = (load_one or load)(path).files
        every = placed_instances(file.graph, file.snapshot)
        own = str(uri_to_path(file.uri))
        declared = [one for one in every if one.origin is not None and one.origin.file == own]
        if not declared:
            raise SceneChoiceError(f"{path} declares no scene inst")
        found += declared
    return tuple(found)


def _model(path: Path, project: Project, files: Iterable[Path]) -> Model:
    snapshot = project.snapshot()
    return Model(path, tuple(ModelFile(snapshot, path_to_uri(file), str(file)) for file in files))
