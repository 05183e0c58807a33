"""The requirements of the models that a run executed. They are stored in the run folder for its reports."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import cast

from robbdd_tools.base.files import UnreadableFile, load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.graph.verified_requirements import LinkedRequirement

FILE = "requirements.json"


def requirements_text(found: Sequence[LinkedRequirement]) -> str:
    """Return requirements as JSON."""
    return printable_json([asdict(one) for one in found])


def requirements_from(text: str) -> tuple[LinkedRequirement, ...]:
    """Return the requirements in a text written by ``requirements_text``; none if it has another form."""
    try:
        document: object = json.loads(text)
        entries = cast("list[object]", document) if isinstance(document, list) else []
        return tuple(from_plain(LinkedRequirement, one) for one in entries)
    except (ValueError, KeyError, TypeError, AttributeError):
        return ()


def write_requirements(found: Sequence[LinkedRequirement], folder: Path) -> None:
    """Write the requirements of a run into its folder, if there are any. Raises ``OSError``."""
    if found:
        replace_file(folder / FILE, requirements_text(found) + "\n")


def read_requirements(folder: Path) -> tuple[LinkedRequirement, ...]:
    """Return the requirements of a run; none if its models have none."""
    try:
        return requirements_from(load_text(folder / FILE, RESULT_SIZE))
    except (OSError, UnreadableFile):
        return ()
