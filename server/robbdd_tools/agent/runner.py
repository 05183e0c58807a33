"""Run behave in this process on scenarios of a prepared run folder, one after the other, as the parent orders them."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator
from contextlib import redirect_stdout
from copy import copy
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robbdd_tools.agent import hooks, stack_dumps
from robbdd_tools.agent.channel import Channel, Reports, use_channel
from robbdd_tools.agent.debugger import await_debugger
from robbdd_tools.agent.hooks import EXECUTION
from robbdd_tools.agent.printed_output import Printed, finish_output
from robbdd_tools.agent.session import UNKNOWN_SCENARIO
from robbdd_tools.agent.steps import load_steps
from robbdd_tools.base.descendants import end_descendants
from robbdd_tools.monitor.verdict import Cause
from robbdd_tools.protocol.fault_places import original, sources_in
from robbdd_tools.protocol.manifest_file import read_manifest
from robbdd_tools.protocol.messages import (
    LogLine,
    RunFinished,
    RunStarted,
    ScenarioFinished,
    ScenarioStarted,
    UserCodeFailed,
    decode_request,
    never_judged,
)
from robbdd_tools.protocol.run_folder import OWN_STEPS
from robbdd_tools.user_code.calls import fault_of
from robbdd_tools.user_code.modules import folder_of, search
from robbdd_tools.world.engine import version

if TYPE_CHECKING:
    from robbdd_tools.catalog.coordination import TreeSpec
    from robbdd_tools.protocol.specs import Manifest

QUIET = ("--format=null", "--no-summary", "--no-capture", "--no-capture-stderr", "--no-logcapture", "--no-snippets")


def run_folder(name: str, orders: Iterable[str], descriptor: int) -> int:
    """Execute scenarios of a run folder and write messages to a file descriptor. Return the exit code."""
    channel = Reports(descriptor)
    use_channel(channel)
    folder = Path(name)
    try:
        manifest = read_manifest(folder)
    except (OSError, ValueError, KeyError, TypeError) as error:
        channel.send(LogLine("error", f"the manifest of {folder} cannot be read: {error}"))
        channel.send(RunFinished(False))
        return 2
    channel.send(RunStarted(len(manifest.scenarios), version()))
    debugged = await_debugger(channel)
    with redirect_stdout(Printed(channel, sys.stdout)):
        problem = _behave(Features(folder, manifest, channel, debugged=debugged), orders)
        finish_output()
    if problem:
        channel.send(LogLine("error", problem))
    channel.send(RunFinished(not problem))
    return 1 if problem else 0


def _behave(features: Features, orders: Iterable[str]) -> str:
    """Execute the ordered scenarios with behave. Return the reason why behave could not work; empty if it could."""
    configuration: Any = import_module("behave.configuration").Configuration
    behave: Any = import_module("behave.runner")
    config = configuration([*QUIET, str(features.folder / "features")], load_config=False)
    runner = behave.Runner(config)
    if not any((features.folder / "features").rglob("*.feature")):
        return f"behave cannot run the features: No feature files in {features.folder / 'features'}"
    try:
        # By itself, behave would load every Python file in the folder, and put the folder before the standard library
        # in the search path.
        runner.base_dir = config.base_dir = str(features.folder / "features")
        runner.context = behave.Context(runner)
        runner.hooks.update((name, getattr(hooks, name)) for name in hooks.__all__)
        try:
            load_steps(features.own_steps(), features.shown_files())
        except (Exception, SystemExit) as error:
            return features.report_broken_steps(error)
        stack_dumps.rest()
        runner.run_model(features.ordered(orders, config.userdata))
    except Exception as error:  # behave's own failures (a broken hooks or steps file) have many types
        return f"behave cannot run the features: {' '.join(str(error).split())}"
    return ""


class Features:
    """The features of a run folder. Each feature is parsed at its first use.

    If the process is ``debugged``, users' steps have the names of the files that users edit, and the debugger, a child
    process, continues to run after a scenario.
    """

    def __init__(self, folder: Path, manifest: Manifest, channel: Reports, *, debugged: bool = False) -> None:
        self.folder = folder
        self._debugged = debugged
        self._manifest = manifest
        self._channel = channel
        self._tree: TreeSpec | None = None
        self._parsed: dict[str, tuple[Any, dict[int, Any]] | Exception] = {}

    def own_steps(self) -> list[Path]:
        """Return the files of user-defined steps, and let them import modules from the folders of the models.

        Raises ``UserCodeError`` if users' code must not be run.
        """
        found = sorted((self.folder / "features" / "steps").glob(OWN_STEPS))
        for model in dict.fromkeys(spec.model for spec in self._manifest.scenarios) if found else ():
            search(folder_of(model))
        return found

    def shown_files(self) -> dict[str, str]:
        """Map the absolute paths of the copied files of steps to the files that a debugger shows instead."""
        return sources_in(self.folder, self._manifest.sources) if self._debugged else {}

    def ordered(self, orders: Iterable[str], userdata: dict[str, str]) -> Iterator[Any]:
        """Yield one feature for each order. The feature contains only the ordered scenario.

        Each order has its own report.
        """
        for line in orders:
            index = decode_request(line).index
            spec = self._manifest.scenarios[index]
            tree = spec.tree
            if self._tree is not None and self._tree != tree:
                self._end_descendants()
            self._tree = tree
            self._channel.finished.discard(index)
            userdata[EXECUTION] = str(index)
            try:
                yield self._feature(index)
            except Exception as error:  # an unreadable file, or a feature that is not Gherkin: behave's own types
                reason = f"behave cannot run the features: {' '.join(str(error).split())}"
                self._channel.send(LogLine("error", reason))
                self._unknown(index, reason)
            if index not in self._channel.finished:
                self._unknown(index, "behave did not execute the scenario")
            # The execution of a behaviour tree continues in the next scenario judged from it.
            if tree is None:
                self._end_descendants()

    def _end_descendants(self) -> None:
        """End the processes that users' code has started in a scenario."""
        if not self._debugged:
            end_descendants()

    def report_broken_steps(self, error: BaseException) -> str:
        """Report that the users' steps cannot be loaded. Return the reason."""
        fault = original(fault_of(error, "steps"), sources_in(self.folder, self._manifest.sources))
        place = fault.place
        if place is not None and place.own:
            self._channel.send(UserCodeFailed(None, fault))
            return f"the steps cannot be loaded: {fault.summary} ({place.file}:{place.line})"
        return f"behave cannot run the features: {fault.summary}"

    def _feature(self, index: int) -> Any:
        spec = self._manifest.scenarios[index]
        if spec.feature not in self._parsed:
            self._parsed[spec.feature] = self._parse(spec.feature)
        found = self._parsed[spec.feature]
        if isinstance(found, Exception):
            raise found
        feature, scenarios = found
        scenario = scenarios.get(spec.line)
        if scenario is None:
            raise ValueError(f"{Path(spec.feature).name}:{spec.line}: {UNKNOWN_SCENARIO}")
        # A repetition executes the same scenario once more.
        scenario.reset()
        alone = copy(feature)
        alone.run_items = alone.scenarios = [scenario]
        return alone

    def _parse(self, name: str) -> tuple[Any, dict[int, Any]] | Exception:
        try:
            feature: Any = import_module("behave.parser").parse_file(str(self.folder / name))
        except Exception as error:
            return error
        return feature, {int(scenario.line): scenario for scenario in feature.walk_scenarios()}

    def _unknown(self, index: int, reason: str) -> None:
        give_up(self._channel, self._manifest, index, reason)


def give_up(channel: Channel, manifest: Manifest, index: int, reason: str) -> None:
    """Report a scenario that cannot be executed."""
    channel.send(ScenarioStarted(index))
    for clause in manifest.scenarios[index].clauses:
        channel.send(never_judged(index, clause.line, reason, Cause.NOT_EXECUTED))
    channel.send(ScenarioFinished(index, 0.0, 0.0, 0.0))
