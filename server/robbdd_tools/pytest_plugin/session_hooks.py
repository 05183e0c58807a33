"""Hooks of a pytest session that collects models."""

from __future__ import annotations

import json
import shutil
import tempfile
from collections.abc import Generator, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_text
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.base.printable import printable
from robbdd_tools.base.writing import replace_file
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.monitor.verdict import Outcome
from robbdd_tools.pytest_plugin.plugin_options import OPTIONS, read_options
from robbdd_tools.pytest_plugin.scenario_nodes import (
    EXECUTOR,
    VERDICT,
    ModelNode,
    ScenarioItem,
    UnselectedItem,
    make_node,
)
from robbdd_tools.pytest_plugin.session_run import Executor, Owner, key_of, model_files, session_plan
from robbdd_tools.run.store import StoredRun
from robbdd_tools.workbench.scene_choice import SceneChoiceError, refuse_unused
from robbdd_tools.workbench.substitution import refuse_unknown

if TYPE_CHECKING:
    from robbdd_tools.run.results import RunResults
    from robbdd_tools.workbench.model import ModelFile

MODELS = (".bdd", ".bddx")
"""File name endings that are collected in folders; graphs are collected only when named."""
POINTER, LOCK = "run.json", "lock"
AGENTS_OF_A_WORKER = 1000
"""Each worker of pytest-xdist gets this many numbers for its agents. The numbers name logs."""
WORDS = {("setup", "unknown"): ("error", "E", "UNKNOWN"), ("call", "violated"): ("failed", "F", "VIOLATED")}
"""Phase and verdict → pytest's category, letter and word."""
MARKER = (
    "robbdd(story, scenario, template, execution, agent, behaviour): set on each execution of a scenario; "
    "select by it: -m \"robbdd(agent='panda')\""
)


class Hooks:
    """Collects models, executes their scenarios and ends the run."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._options = config.stash[OPTIONS] = read_options(config)
        self._worker: dict[str, Any] | None = getattr(config, "workerinput", None)
        self._owner = Owner(self._options.keeping)
        self._shared: Path | None = None
        self._summary: list[str] = []
        self._models: list[ModelNode] = []
        config.addinivalue_line("markers", MARKER)

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> ModelNode | None:
        """Collect models.

        Graphs are collected only if they are named, because folders also contain other JSON files.
        """
        named = graph_format(file_path.name) and parent.session.isinitpath(file_path)
        if file_path.suffix not in MODELS and not named:
            return None
        node = make_node(ModelNode, parent, path=file_path)
        self._models.append(node)
        return node

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Skip the executions that another model of the session also contains, as ``robbdd run`` does for a folder."""
        scenarios = [item for item in items if isinstance(item, ScenarioItem)]
        self._refuse_unknown_choices()
        for node in self._models:
            if node.unselected is not None and not scenarios:
                item = make_node(UnselectedItem, node, name="selection")
                item.error = node.unselected
                items.append(item)
                break
        doubled = set(self._doubled(scenarios))
        if doubled:
            self._config.hook.pytest_deselected(items=[item for item in items if item in doubled])
            items[:] = [item for item in items if item not in doubled]

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Prepare to execute the collected items."""
        items = [item for item in session.items if isinstance(item, ScenarioItem)]
        specs, files = [item.spec for item in items], self._files
        if self._worker is None:
            executor = Executor(self._options, specs, files, lambda: self._owner.open(Path(files[0].name)))
        else:
            shared = Path(self._worker["robbdd_shared"])
            first = AGENTS_OF_A_WORKER * int("".join(filter(str.isdecimal, self._worker["workerid"]))) + 1
            count = int(self._worker["workercount"])
            executor = Executor(self._options, specs, files, lambda: _read_pointer(shared), shared / LOCK, first, count)
        self._config.stash[EXECUTOR] = executor

    @pytest.hookimpl(optionalhook=True)
    def pytest_configure_node(self, node: Any) -> None:
        """Send the place of the run to a worker of pytest-xdist."""
        self._shared = self._shared or Path(tempfile.mkdtemp(prefix="robbdd-"))
        node.workerinput["robbdd_shared"] = str(self._shared)

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, ids: Sequence[str]) -> None:
        """Create the run folder before any worker gets a test."""
        models = [Path(name.partition("::")[0]) for name in ids]
        model = next((path for path in models if path.suffix in MODELS or graph_format(path.name)), None)
        if model is not None and self._shared is not None and not (self._shared / POINTER).exists():
            _write_pointer(self._shared, self._owner.open(self._config.rootpath / model))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        """Report errors of the setup as errors of the call. Otherwise pytest would print them with a traceback."""
        report = yield
        if isinstance(item, ScenarioItem | UnselectedItem) and report.failed and call.excinfo is not None:
            report.longrepr = item.repr_failure(call.excinfo)
        return report

    def pytest_report_teststatus(self, report: pytest.CollectReport | pytest.TestReport) -> tuple[str, str, str] | None:
        """Report a violated scenario as VIOLATED and one without evidence as UNKNOWN."""
        properties: list[tuple[str, object]] = getattr(report, "user_properties", [])
        verdict = next((value for name, value in properties if name == VERDICT), None)
        return WORDS.get((str(report.when), str(verdict))) if report.failed else None

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self) -> None:
        """End the agent. After the workers of pytest-xdist have ended, end the run."""
        executor = self._config.stash.get(EXECUTOR, None)
        if executor is not None:
            executor.close()
        remark = self._owner.remark
        try:
            ended = self._owner.end()
        except (OSError, RobbddError) as error:
            self._summary = [f"the run cannot be ended: {error}"]
        else:
            self._summary = [] if ended is None else [remark, *_summary(*ended)]

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Print the number of scenarios with each verdict, the clauses that prove little, and the place of the run."""
        lines = [printable(line) for line in self._summary if line]
        if lines:
            terminalreporter.write_sep("=", "RobBDD")
            for line in lines:
                terminalreporter.write_line(line)

    def pytest_unconfigure(self) -> None:
        """Remove the files that are shared with workers."""
        if self._shared is not None:
            shutil.rmtree(self._shared, ignore_errors=True)

    def _refuse_unknown_choices(self) -> None:
        """Raise ``UsageError`` if ``--robbdd-bhv`` has an unknown name, or ``--robbdd-scenex`` fits no scenario."""
        selection, models = self._options.selection, [file.acceptance for file in self._files]
        try:
            refuse_unknown(models, selection.default_substitutions)
        except SelectionError as error:
            raise pytest.UsageError(f"--robbdd-bhv: {error}") from None
        try:
            refuse_unused(models, selection.default_instances)
        except SceneChoiceError as error:
            raise pytest.UsageError(f"--robbdd-scenex: {error}") from None

    @property
    def _files(self) -> tuple[ModelFile, ...]:
        return model_files(node.file for node in self._models if node.file is not None)

    def _doubled(self, items: Sequence[ScenarioItem]) -> Iterator[ScenarioItem]:
        """Yield the tests whose scenarios the common plan of all models takes from a different model."""
        files = self._files
        if len(files) < 2 or not items:
            return
        with tempfile.TemporaryDirectory(prefix="robbdd-") as folder:
            plan = session_plan(files, self._options).prepare(Path(folder), repeat=self._options.repeat)
        planned = {key_of(spec) for spec in plan.scenarios}
        yield from (item for item in items if key_of(item.spec) not in planned)


def _write_pointer(shared: Path, place: StoredRun) -> None:
    fields = {"number": place.number, "folder": str(place.folder), "database": str(place.database), "kept": place.kept}
    replace_file(shared / POINTER, json.dumps(fields))


def _read_pointer(shared: Path) -> StoredRun:
    fields = json.loads(load_text(shared / POINTER))
    return StoredRun(fields["number"], Path(fields["folder"]), Path(fields["database"]), fields["kept"])


def _summary(place: StoredRun, results: RunResults) -> Iterator[str]:
    names = results.titles()
    yield from results.choices()
    yield from (f"{names[iri]} proves little: {reason}" for iri, reason in results.vacuous().items())
    total = len(results.scenarios)
    counts = f"{results.count(Outcome.HOLDS)} hold, {results.count(Outcome.VIOLATED)} violated"
    counts += f", {results.count(Outcome.UNKNOWN)} unknown"
    where = f"kept as run {place.number} in {place.folder}" if place.kept else "not kept"
    yield f"{total} scenario{'' if total == 1 else 's'}: {counts} (seed {results.manifest.seed}); {where}"
    if not results.complete and place.kept:
        yield f"resume the run with: robbdd run --resume {place.number or place.folder}"
