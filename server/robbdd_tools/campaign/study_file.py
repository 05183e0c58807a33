"""Load a ``.study`` file with the models that it imports, and find everything that would prevent its execution."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Document, Span
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import path_to_uri, read_text
from robbdd_tools.campaign.designs import design_points
from robbdd_tools.campaign.rates import StatisticsNotInstalled
from robbdd_tools.campaign.stopping import RatioTest, StopRule, UntilWidth
from robbdd_tools.campaign.study_ranges import form_faults, range_faults
from robbdd_tools.graph.verified_requirements import counted_links, merged_links
from robbdd_tools.run.prepare import DEFAULT_SEED
from robbdd_tools.run.run_policy import TIMEOUT
from robbdd_tools.syntax.study_content import STUDY, Factor, StudyText, Word
from robbdd_tools.syntax.study_text import read_study
from robbdd_tools.workbench.diagnostics import Finding, Place
from robbdd_tools.workbench.model import Model, ModelErrors, ModelFile, load, load_all, read_instances
from robbdd_tools.workbench.named_files import NotAModel
from robbdd_tools.workbench.plan import Plan, Selection
from robbdd_tools.workbench.points import block_seeds

if TYPE_CHECKING:
    from robbdd_tools.campaign.study_ranges import Fault
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.graph.verified_requirements import LinkedRequirement
    from robbdd_tools.workbench.points import Points

SUFFIX = f".{STUDY}"
BATCH = 500
"""Default number of executions after which results are moved to the study's store."""
MOST_CELLS = 1000
"""Maximum number of combinations of levels."""


@dataclass(frozen=True, slots=True)
class Cell:
    """One combination of the levels of a study's factors: pairs of a factor and its level, in words.

    Scenarios and their repetitions are executed in each cell with the same seeds.
    """

    levels: Mapping[str, str]
    plan: Plan

    @property
    def words(self) -> str:
        """The levels in words; empty without factors."""
        return ", ".join(f"{factor}={level}" for factor, level in self.levels.items())


@dataclass(frozen=True)
class Study:
    """A loaded study. ``findings`` has its errors and those of its models."""

    path: Path
    document: Document
    content: StudyText
    findings: tuple[Finding, ...]
    model: Model | None
    cells: tuple[Cell, ...]

    @property
    def name(self) -> str:
        """The name of the study."""
        return self.content.name

    @property
    def repeat(self) -> int | None:
        """The number of repetitions of each scenario; ``None`` if the executions of the model state it."""
        return self.content.whole("repeat")

    @property
    def batch(self) -> int:
        """The number of executions that are executed before their results are moved to the study's store."""
        return self.content.whole("batch") or BATCH

    @property
    def timeout(self) -> float:
        """The limit of wall time for one scenario in s; 0 for no limit."""
        return self.content.numbers.get("timeout", TIMEOUT)

    @property
    def stop(self) -> StopRule | None:
        """The rule that ends the study early."""
        numbers = self.content.numbers
        if "stop width" in numbers:
            return UntilWidth(numbers["stop width"])
        return RatioTest(numbers["stop rate"], numbers["stop against"]) if "stop rate" in numbers else None

    @property
    def requirements(self) -> tuple[LinkedRequirement, ...]:
        """The requirements of the models. All cells have the same models."""
        links = merged_links(file.requirements for file in self.cells[0].plan.files)
        # The values of a range replace those of the model, and so change the number of scenarios.
        return counted_links(links, {}) if self.content.ranges else links

    @cached_property
    def scene_files(self) -> tuple[ModelFile, ...]:
        """The ``.scenex`` files that are levels, in their order. They are loaded at the first access.

        Raises the errors of ``load``.
        """
        return tuple(file for word in self.content.scenes for file in load(self.path.parent / word.text).files)

    @cached_property
    def digest(self) -> str:
        """The SHA-256 of everything that defines the executions: settings, graphs of models and scene instances.

        Comments and layout do not count. Raises the errors of ``load``.
        """
        content = self.content
        words = [
            repr([word.text for word in content.scenarios]),
            "" if content.where is None else content.where.text,
            repr(sorted(content.numbers.items())),
            *(cell.words for cell in self.cells),
            *(cell.plan.digest for cell in self.cells),
            *(file.digest for file in self.scene_files),
            *(["block"] if content.is_blocked else []),
            *([] if self.cells[0].plan.selection.points is None else [repr(self.cells[0].plan.selection.points)]),
        ]
        return hashlib.sha256("\n".join(words).encode()).hexdigest()


class StudyModels(Protocol):
    """A source of a study's models."""

    def load(self, paths: Sequence[Path]) -> Model:
        """Return the models. Raises ``NotAModel``."""
        ...

    def instances(self, paths: Sequence[Path]) -> tuple[SceneInstance, ...]:
        """Return the scene instances of files, as ``read_instances`` does."""
        ...


class ModelsOnDisk(StudyModels):
    """Reads the models from the disk."""

    def load(self, paths: Sequence[Path]) -> Model:
        """Return the models."""
        return load_all(paths)

    def instances(self, paths: Sequence[Path]) -> tuple[SceneInstance, ...]:
        """Return the scene instances of files."""
        return read_instances(paths)


def load_study(path: Path) -> Study:
    """Load a study. Its errors are findings. Raises ``NotAModel`` if there is no such file."""
    if path.suffix != SUFFIX:
        raise NotAModel(f"{path} is not a {SUFFIX} file")
    text = read_text(path)
    if not isinstance(text, str):
        raise NotAModel(f"{path} cannot be read: {text.reason}")
    document = Document(path_to_uri(path), 0, text)
    content, faults = read_study(document)
    loader = StudyLoader(path, document, content, ModelsOnDisk(), is_complete=not faults)
    cells = tuple(loader.cells())
    own = sorted((*faults, *loader.faults), key=lambda fault: fault.span.start)
    findings = (*(_found(document, fault) for fault in own), *loader.broken)
    return Study(path, document, content, findings, loader.model, () if findings else cells)


class StudyLoader:
    """Finds the combinations of levels of a study.

    ``faults`` are the errors of the study, and ``broken`` the errors of its models. ``model`` has the models, if they
    can be run. ``is_complete`` is false if a part of the text could not be read: then what was read is checked, and no
    setting is reported as missing.
    """

    def __init__(
        self, path: Path, document: Document, content: StudyText, models: StudyModels, *, is_complete: bool = True
    ) -> None:
        self._folder = path.parent
        self._document = document
        self._content = content
        self._models = models
        self._is_complete = is_complete
        self.faults: list[Diagnostic] = []
        self.broken: tuple[Finding, ...] = ()
        self.model: Model | None = None

    def cells(self) -> Iterator[Cell]:
        """Yield the cells. With errors, the cells are incomplete."""
        self.model = self._model()
        if self.model is None:
            return
        selection = Selection(
            [word.text for word in self._content.scenarios],
            self._content.where and self._content.where.text,
            self._content.whole("first"),
            self._content.whole("sample"),
            self._content.whole("pairwise"),
            self._content.whole("seed"),
            default_seed=DEFAULT_SEED,
        )
        if self._is_complete:
            self._report_all(form_faults(self._content))
        self._report_all(range_faults((file.acceptance for file in self.model.runnable), self._content.ranges))
        if self._content.ranges and self._is_complete and not self.faults:
            selection = replace(selection, points=self._points())
        if self._plan(replace(selection, names=()), self._content.where, "where") is None:
            if self._content.where is None:
                return
            selection = replace(selection, where=None)
        # Levels are checked with the scenarios that exist, so that an unknown name is reported once.
        named = [word.text for word in self._content.scenarios if self._has(selection, word)]
        combinations = self._combinations(replace(selection, names=named))
        if not self.faults:
            for levels, chosen in combinations:
                plan = self._plan(chosen, self._content.factors[0].levels[0] if levels else None, "factor")
                if plan is not None:
                    yield Cell(levels, self._blocked(plan) if self._content.is_blocked else plan)

    def _has(self, selection: Selection, scenario: Word) -> bool:
        return self._plan(replace(selection, names=[scenario.text]), scenario, "scenarios") is not None

    def _blocked(self, plan: Plan) -> Plan:
        seeded = block_seeds(plan.requests[0].seed)
        return replace(plan, requests=tuple(replace(one, completed=seeded) for one in plan.requests))

    def _points(self) -> Points | None:
        design = self._content.design
        assert design is not None
        seed = self._content.whole("seed")
        try:
            return design_points(design, self._content.ranges, DEFAULT_SEED if seed is None else seed)
        except StatisticsNotInstalled:
            self._report(design.span, f"the design '{design.kind}' needs SciPy: install robbdd-tools[statistics]")
        return None

    def _model(self) -> Model | None:
        if not self._content.imports and not self._is_complete:
            return None
        if not self._content.imports:
            self._report(Span(0, 0), 'a study imports its models: begin with import "MODEL.bdd"')
            return None
        paths = [self._folder / word.text for word in self._content.imports]
        for word, path in zip(self._content.imports, paths, strict=True):
            if not path.is_file():
                self._report(word.span, f"there is no file {word.text}")
        if self.faults:
            return None
        try:
            model = self._models.load(paths)
            _ = model.runnable
        except ModelErrors as error:
            self.broken = error.findings
            return None
        except RobbddError as error:
            self._report(self._content.imports[0].span, str(error))
            return None
        return model

    def _combinations(self, selection: Selection) -> Sequence[tuple[Mapping[str, str], Selection]]:
        factors = self._content.factors
        number = 1
        for factor in factors:
            number *= len(factor.levels)
        if number > MOST_CELLS:
            self._report(factors[0].levels[0].span, f"{number} combinations of levels are more than {MOST_CELLS}")
            return []
        levels = [
            [(factor, level) for level in factor.levels if self._fits(selection, factor, level)] for factor in factors
        ]
        return [(_levels(cell), self._selected(selection, cell)) for cell in product(*levels)]

    def _fits(self, selection: Selection, factor: Factor, level: Word) -> bool:
        """Check one level alone, so that a finding points to this level."""
        if factor.implementation is None and not (self._folder / level.text).is_file():
            self._report(level.span, f"there is no file {level.text}")
            return False
        try:
            chosen = self._selected(selection, [(factor, level)])
        except RobbddError as error:
            self._report(level.span, str(error))
            return False
        return self._plan(chosen, level, "factor") is not None

    def _selected(self, selection: Selection, cell: Sequence[tuple[Factor, Word]]) -> Selection:
        scenes = [self._folder / level.text for factor, level in cell if factor.implementation is None]
        substitutions = {
            factor.implementation.text: level.words for factor, level in cell if factor.implementation is not None
        }
        return replace(selection, substitutions=substitutions, instances=self._models.instances(scenes))

    def _plan(self, selection: Selection, word: Word | None, setting: str) -> Plan | None:
        assert self.model is not None
        try:
            return Plan.of(self.model, selection)
        except RobbddError as error:
            place = self._content.places.get(setting, Span(0, 0)) if word is None else word.span
            self._report(place, str(error).replace("--where", "where", 1))
            return None

    def _report_all(self, faults: Iterable[Fault]) -> None:
        for span, message in faults:
            self._report(span, message)

    def _report(self, span: Span, message: str) -> None:
        fault = Diagnostic(self._document.uri, span, Severity.ERROR, "study", message)
        if fault not in self.faults:
            self.faults.append(fault)


def _found(document: Document, fault: Diagnostic) -> Finding:
    start, end = document.position(fault.span.start), document.position(fault.span.end)
    place = Place(document.uri, start.line + 1, start.column + 1, end.line + 1, end.column + 1)
    return Finding(place, fault.severity, fault.code, fault.message)


def _levels(cell: Sequence[tuple[Factor, Word]]) -> Mapping[str, str]:
    return {
        "scene" if factor.implementation is None else factor.implementation.text: level.words for factor, level in cell
    }
