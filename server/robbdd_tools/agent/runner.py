"""Runs behave in this process on a prepared run folder."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.agent.channel import Channel, Lines, use_channel
from robbdd_tools.agent.engine import version
from robbdd_tools.agent.session import Session
from robbdd_tools.run.protocol import LogLine, RunFinished, RunStarted, read_manifest

if TYPE_CHECKING:
    from robbdd_tools.run.protocol import Manifest

QUIET = ("--format=null", "--no-summary", "--no-capture", "--no-capture-stderr", "--no-logcapture", "--no-snippets")


def run_folder(name: str, descriptor: int) -> int:
    """Execute a run folder and write its messages to a file descriptor; returns the exit code."""
    channel = Lines(descriptor)
    use_channel(channel)
    folder = Path(name)
    try:
        manifest = read_manifest(folder)
    except (OSError, ValueError, KeyError, TypeError) as error:
        channel.send(LogLine("error", f"the manifest of {folder} cannot be read: {error}"))
        channel.send(RunFinished(False))
        return 2
    channel.send(RunStarted(len(manifest.scenarios), version()))
    problem = _behave(folder, manifest)
    if problem:
        channel.send(LogLine("error", problem))
        _give_up(folder, manifest, channel, problem)
    channel.send(RunFinished(not problem))
    return 1 if problem else 0


def _behave(folder: Path, manifest: Manifest) -> str:
    """Run behave on the manifest's features in their order; returns what kept it from running, else nothing."""
    features = [str(folder / feature) for feature in dict.fromkeys(spec.feature for spec in manifest.scenarios)]
    if not features:
        return ""
    configuration = import_module("behave.configuration").Configuration
    runner = import_module("behave.runner").Runner(configuration([*QUIET, *features], load_config=False))
    try:
        runner.run()
    except Exception as error:  # behave's own failures (a broken feature or steps file) are of many types
        return f"behave cannot run the features: {' '.join(str(error).split())}"
    return ""


def _give_up(folder: Path, manifest: Manifest, channel: Channel, reason: str) -> None:
    Session(folder, manifest, channel).close(reason)
