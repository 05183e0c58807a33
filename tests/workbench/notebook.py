"""Executes the example notebook and stores its outputs: ``.venv/bin/python tests/workbench/notebook.py``."""

from __future__ import annotations

import ast
import io
import json
import os
from contextlib import chdir, redirect_stdout
from pathlib import Path
from typing import Any

NOTEBOOK = Path(__file__).parents[2] / "examples" / "notebook" / "tall_bins.ipynb"


def executed(path: Path = NOTEBOOK) -> dict[str, Any]:
    """Return a notebook with the current outputs of its code cells; exceptions of cells pass through."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    names: dict[str, Any] = {"__name__": "__main__"}
    count = 0
    with chdir(path.parent):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                count += 1
                cell["execution_count"] = count
                cell["outputs"] = _outputs("".join(cell["source"]), names, count)
    return notebook


def _outputs(source: str, names: dict[str, Any], count: int) -> list[dict[str, Any]]:
    """Execute a cell as Jupyter does; return its output and the value of an expression at its end."""
    body = ast.parse(source).body
    end = body[-1]
    last = end.value if isinstance(end, ast.Expr) else None
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(compile(ast.Module(body if last is None else body[:-1], []), "<cell>", "exec"), names)
        value = None if last is None else eval(compile(ast.Expression(last), "<cell>", "eval"), names)
    outputs: list[dict[str, Any]] = []
    if printed.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": _lines(printed.getvalue())})
    if value is not None:
        data = {"text/plain": _lines(repr(value))}
        outputs.append({"data": data, "execution_count": count, "metadata": {}, "output_type": "execute_result"})
    return outputs


def _lines(text: str) -> list[str]:
    return text.splitlines(keepends=True)


def written(notebook: dict[str, Any]) -> str:
    """Return the text of a notebook as Jupyter writes it."""
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    os.environ.pop("ROBBDD_NO_USER_CODE", None)
    NOTEBOOK.write_text(written(executed()), encoding="utf-8")
