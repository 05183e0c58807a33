"""Save results, so that they survive a restart: one file in ``.robbdd/`` of each workspace folder."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

from robbdd_tools.base.files import load_text, uri_to_path
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.writing import replace_file
from robbdd_tools.features.run_verdicts import JudgedScenario, as_json, from_json
from robbdd_tools.workbench.found_runs import Seen

FOLDER = ".robbdd"
FILE = "results.json"
VERSION = 3
_LOG = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class KeptResults:
    """The results of earlier sessions. ``seen`` maps the folder of each store to the last run that was read from it."""

    scenarios: tuple[JudgedScenario, ...] = ()
    seen: Mapping[str, Seen] = field(default_factory=dict[str, Seen])


def load_results(folders: Iterable[Path]) -> KeptResults:
    """Return the results that are saved in workspace folders. Unreadable files are skipped."""
    found = [_read(folder / FOLDER / FILE) for folder in folders]
    scenarios = tuple(scenario for kept in found for scenario in kept.scenarios)
    return KeptResults(scenarios, {store: run for kept in found for store, run in kept.seen.items()})


def save_results(folders: Iterable[Path], scenarios: Iterable[JudgedScenario], seen: Mapping[str, Seen]) -> None:
    """Save each scenario in the innermost workspace folder that contains its model. Unwritable folders are skipped."""
    every = list(scenarios)
    last = {store: asdict(run) for store, run in seen.items()}
    for folder, own in _by_folder(sorted(folders, key=lambda path: -len(path.parts)), every):
        document = {"version": VERSION, "seen": last, "scenarios": [as_json(entry) for entry in own]}
        text = json.dumps(document, ensure_ascii=False)
        try:
            _write(folder / FOLDER, text)
        except OSError as error:
            _LOG.info("results are not kept in %s: %s", folder, error)


def _by_folder(folders: list[Path], scenarios: list[JudgedScenario]) -> Iterator[tuple[Path, list[JudgedScenario]]]:
    for folder in folders:
        inside = [_lies_in(scenario.model, folder) for scenario in scenarios]
        yield folder, [scenario for scenario, within in zip(scenarios, inside, strict=True) if within]
        scenarios = [scenario for scenario, within in zip(scenarios, inside, strict=True) if not within]


def _lies_in(uri: str, folder: Path) -> bool:
    path = uri_to_path(uri)
    return path is not None and path.is_relative_to(folder)


def _read(path: Path) -> KeptResults:
    try:
        data = json.loads(load_text(path, RESULT_SIZE))
        if data["version"] != VERSION:
            return KeptResults()
        seen = {str(store): from_plain(Seen, run) for store, run in data["seen"].items()}
        return KeptResults(tuple(from_json(entry) for entry in data["scenarios"]), seen)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        _LOG.info("results in %s cannot be read: %s", path, error)
        return KeptResults()


def _write(folder: Path, text: str) -> None:
    """Replace the file atomically. If nothing was run, do not create it."""
    folder.mkdir(exist_ok=True)
    ignored = folder / ".gitignore"
    if not ignored.exists():
        replace_file(ignored, "*\n")
    replace_file(folder / FILE, text)
