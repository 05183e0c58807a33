"""The nodes that pytest collects: a model file, its stories, and a test for each execution of a scenario."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby, product
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar, cast

import pytest

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.graph.acceptance_model import behaviour_clauses
from robbdd_tools.graph.verified_requirements import names_by_variant
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.pytest_plugin.failure_text import Failure, failure
from robbdd_tools.pytest_plugin.node_names import local_name, scenario_names
from robbdd_tools.pytest_plugin.plugin_options import OPTIONS
from robbdd_tools.pytest_plugin.session_run import Executor
from robbdd_tools.workbench.model import NO_SCENARIO, load
from robbdd_tools.workbench.plan import Plan
from robbdd_tools.workbench.scene_choice import SceneChoiceError

if TYPE_CHECKING:
    from robbdd_tools.protocol.specs import ScenarioSpec
    from robbdd_tools.workbench.model import Model, ModelFile
    from robbdd_tools.workbench.on_demand import Executed

EXECUTOR = pytest.StashKey[Executor]()
VERDICT = "robbdd_verdict"
"""Name of the report property for the verdict."""


N = TypeVar("N", bound=pytest.Collector | pytest.Item)


def make_node(kind: type[N], parent: pytest.Collector, **arguments: Any) -> N:
    """Return a child node; pytest's ``from_parent`` is untyped."""
    return cast(Any, kind).from_parent(parent, **arguments)


class ModelWarning(UserWarning):
    """A warning about a model, with its place."""


class ModelNode(pytest.File):
    """A model file. Its errors are reported as collection errors."""

    file: ModelFile | None = None
    """The collected model, if it is free of errors and has scenarios."""
    unselected: SelectionError | None = None
    """The reason why the selection excludes the whole model; ``None`` if it does not."""

    def collect(self) -> Iterator[StoryNode]:
        """Yield the stories that have a selected scenario."""
        try:
            self.file = file = self._sound_file(load(self.path))
            specs = () if file is None else self._selected(file)
        except (RobbddError, OSError) as error:
            raise self.CollectError(str(error)) from error
        for story, executions in groupby(specs, key=lambda spec: spec.story):
            assert file is not None
            node = make_node(StoryNode, self, name=local_name(story))
            node.specs, node.file = list(executions), file
            yield node

    def _sound_file(self, model: Model) -> ModelFile | None:
        """Return the model if it has scenarios. Raises ``CollectError`` if it has errors."""
        errors = [str(finding) for finding in model.diagnostics if finding.is_error]
        if errors:
            raise self.CollectError("\n".join(errors))
        for finding in model.diagnostics:
            if finding.severity is Severity.WARNING:
                self.warn(ModelWarning(str(finding)))
        (file,) = model.files
        if file.has_scenarios:
            return file
        if self.session.isinitpath(self.path):
            raise self.CollectError(f"{self.path}: {NO_SCENARIO}")
        return None

    def _selected(self, file: ModelFile) -> tuple[ScenarioSpec, ...]:
        options = self.config.stash[OPTIONS]
        try:
            plan = Plan.of_files(str(self.path), self.path, (file,), options.selection)
            with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
                return plan.prepare(Path(folder), repeat=options.repeat).scenarios
        except SelectionError as error:
            self.unselected = error
            return ()
        except SceneChoiceError as error:
            raise self.CollectError(f"{self.path}: {error}") from None


class StoryNode(pytest.Collector):
    """A user story of a model."""

    specs: list[ScenarioSpec]
    file: ModelFile

    def collect(self) -> Iterator[ScenarioItem]:
        """Yield a test for each execution of the story's scenarios."""
        for name, spec in zip(scenario_names(self.specs), self.specs, strict=True):
            # Newer versions of pytest separate values from names in an explicit id, and compare such ids.
            item = make_node(ScenarioItem, self, name=name, nodeid=f"{self.nodeid}::{name}")
            item.describe(spec, self.file)
            yield item


class ScenarioItem(pytest.Item):
    """The test of one execution of a scenario.

    The setup executes the scenario, so that missing evidence is an error of the test. The call checks the verdict, so
    that a violated clause is a failure of the test.
    """

    spec: ScenarioSpec
    file: ModelFile
    funcargs: Mapping[str, Any] = MappingProxyType({})
    """Empty; plugins for test functions, such as pytest-lsp, fail on an item without it."""
    _executed: Executed | None = None

    def describe(self, spec: ScenarioSpec, file: ModelFile) -> None:
        """Set the execution that the test represents."""
        self.spec = spec
        self.file = file
        for mark in _marks(spec, file):
            self.add_marker(mark)
        if spec.tree is not None and self.config.pluginmanager.hasplugin("xdist"):
            # Scenarios of one behaviour tree share its execution within a process.
            self.add_marker(pytest.mark.xdist_group(spec.tree.name))

    def setup(self) -> None:
        """Execute the scenario. Raises ``Unknown`` if evidence is missing."""
        executor = self.config.stash[EXECUTOR]
        self._executed = executed = executor.execute(self.spec)
        result = executed.result
        self.user_properties = [(VERDICT, str(result.verdict)), ("seed", result.seed)]
        if result.substitution is not None:
            self.user_properties.append(("substitution", str(result.substitution)))
        if result.scene_instance is not None:
            self.user_properties.append(("scene instance", str(result.scene_instance)))
        self.user_properties += [
            (f"margin {clause.name} ({clause.unit})", clause.margin)
            for clause in result.clauses
            if clause.margin is not None and clause.unit
        ]
        verified = names_by_variant(self.file.requirements).get(self.spec.variant, ())
        self.user_properties += [("requirement", name) for name in verified]
        if executed.output:
            self.add_report_section("setup", "stdout", "\n".join(executed.output))
        if result.verdict is Outcome.UNKNOWN:
            raise failure(executed, self.file, executor.place)

    def runtest(self) -> None:
        """Raise ``Violated`` unless all clauses hold."""
        assert self._executed is not None, "the setup has not executed the scenario"
        if self._executed.result.verdict is not Outcome.HOLDS:
            raise failure(self._executed, self.file, self.config.stash[EXECUTOR].place)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the text that pytest prints about an exception.

        It has the clauses of a failure or the reason of a usage error. For any other exception, it is a traceback.
        """
        error = excinfo.value
        if not isinstance(error, (Failure, RobbddError, OSError)):
            return super().repr_failure(excinfo, style)
        shown = excinfo.getrepr(style="value", chain=False)
        crash = shown.reprcrash
        place = error.place if isinstance(error, Failure) else self.file.place(self.spec.variant)
        if crash is not None:
            crash.message = error.summary if isinstance(error, Failure) else str(error)
            crash.path, crash.lineno = (str(self.path), 1) if place is None else (place.file, place.line)
        return shown

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return the file and the line (from 0) of the scenario, and the name for headings."""
        place = self.file.place(self.spec.variant)
        heading = f"{local_name(self.spec.story)}: {self.name}"
        if place is None or place.path is None:
            return self.path, None, heading
        return place.path, place.line - 1, heading


class UnselectedItem(pytest.Item):
    """A test that fails because the selection is not possible or empty, so that a typing error is noticed."""

    error: SelectionError
    funcargs: Mapping[str, Any] = MappingProxyType({})

    def setup(self) -> None:
        """Raise the error in the selection."""
        raise self.error

    def runtest(self) -> None:
        """Do nothing, because the setup already fails."""

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the reason of the failure without a traceback."""
        del style
        return str(excinfo.value)


def _marks(spec: ScenarioSpec, file: ModelFile) -> Iterable[pytest.MarkDecorator]:
    """Yield a mark for each agent and each behaviour of a scenario, for ``-m "robbdd(agent='panda')"``."""
    variant = next(one for story in file.acceptance.stories for one in story.variants if one.iri == spec.variant)
    agents = [local_name(agent) for agent in spec.scene.agents if agent not in spec.scene.unused]
    clauses = behaviour_clauses((*variant.template.clauses, *variant.clauses))
    behaviours = dict.fromkeys(clause.behaviour for clause in clauses)
    for agent, behaviour in product(agents or [""], behaviours or [""]):
        yield pytest.mark.robbdd(
            story=local_name(spec.story),
            scenario=local_name(spec.variant),
            template=local_name(variant.template.iri),
            execution="" if spec.execution is None else local_name(spec.execution.iri),
            agent=agent,
            behaviour=behaviour,
        )
