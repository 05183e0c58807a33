"""The example notebook runs, and its stored outputs are correct."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from workbench.notebook import NOTEBOOK, executed, written

NUMBER = re.compile(r"\d+(?:\.\d+)?")


def outputs(notebook: dict[str, Any]) -> list[str]:
    """Return what each cell put out, numbers left out: their last digits may differ between machines."""
    return [NUMBER.sub("N", json.dumps(cell.get("outputs", []))) for cell in notebook["cells"]]


@pytest.mark.physics
def test_the_notebook_has_the_outputs_of_its_cells() -> None:
    stored = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert outputs(executed()) == outputs(stored), "run .venv/bin/python tests/workbench/notebook.py"


def test_the_notebook_is_stored_as_jupyter_writes_it() -> None:
    text = NOTEBOOK.read_text(encoding="utf-8")
    notebook = json.loads(text)
    assert written(notebook) == text
    assert (notebook["nbformat"], notebook["metadata"]["kernelspec"]["name"]) == (4, "python3")
    cells = notebook["cells"]
    assert len({cell["id"] for cell in cells}) == len(cells)
    assert [cell["execution_count"] for cell in cells if cell["cell_type"] == "code"] == [
        *range(1, sum(cell["cell_type"] == "code" for cell in cells) + 1)
    ]


def test_the_notebook_names_no_path_of_a_machine() -> None:
    stored = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    found = "".join(output for cell in stored["cells"] for output in map(json.dumps, cell.get("outputs", [])))
    assert not re.search(r"(?:/home|/tmp|/root|/Users|[A-Z]:\\)", found)
