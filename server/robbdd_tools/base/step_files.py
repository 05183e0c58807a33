"""Files with users' own steps: their path for a model, and the sentences that they define."""

from __future__ import annotations

import ast
import re
from functools import lru_cache
from typing import TYPE_CHECKING

from robbdd_tools.base.files import UnreadableFile
from robbdd_tools.base.source_texts import load_source, source_state

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.base.files import FileState

_SLOT = re.compile(r"\\\{[^{}]*\\\}")


def steps_file(model: Path) -> Path:
    """Return the path of the file with a model's own steps. The file need not exist."""
    return model.parent / "steps" / f"{model.stem.replace('-', '_')}_steps.py"


def defined_steps(source: str) -> tuple[set[tuple[str, str]], set[str]]:
    """Return the steps that a file defines, each as (keyword, sentence), and the names of its functions.

    Raises ``SyntaxError`` if the file is not Python.
    """
    steps: set[tuple[str, str]] = set()
    names: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            names.add(node.name)
            for decorator in node.decorator_list:
                match decorator:
                    case ast.Call(
                        func=ast.Name(id=keyword) | ast.Attribute(attr=keyword),
                        args=[ast.Constant(value=str() as sentence), *_],
                    ):
                        steps.add((keyword, sentence))
                    case _:
                        pass
    return steps, names


def may_define(model: Path, sentence: str) -> bool:
    """Return whether a model's own steps may match a sentence of a feature.

    A parameter of a step matches any text. A step with another matcher than ``parse`` may match any sentence, and so
    may the steps of an unreadable file.
    """
    state = source_state(steps_file(model))
    return state is not None and any(pattern.fullmatch(sentence) for pattern in _patterns(state))


@lru_cache(maxsize=16)
def _patterns(state: FileState) -> tuple[re.Pattern[str], ...]:
    try:
        source = load_source(state.path)
        sentences = {sentence for _, sentence in defined_steps(source)[0]}
    except (UnreadableFile, OSError, SyntaxError, ValueError):
        return (re.compile(".*"),)
    if "use_step_matcher" in source:
        return (re.compile(".*"),)
    return tuple(re.compile(_SLOT.sub(".+", re.escape(sentence))) for sentence in sorted(sentences))
