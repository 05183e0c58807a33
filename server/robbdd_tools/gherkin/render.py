"""Compile feature templates and render them block by block.

Built-in templates are rendered in this process, users' templates in a separate process (see ``user_template``).
"""

from __future__ import annotations

import re
import traceback
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from robbdd_tools.base.files import load_text

if TYPE_CHECKING:
    from jinja2 import Template

OURS = ("default", "compact", "de")
"""Names of the built-in templates."""
BLOCKS = ("feature", "variant", "scenario", "end")
"""Blocks that a template may define; ``scenario`` is required."""
ENDING = ".feature.jinja"
LONGEST_MESSAGE = 2000
"""Maximum number of characters of an error message, because expressions of a template determine its length."""


class TemplateProblem(Exception):
    """A template cannot be used. The message begins with the file of the template and, if known, the line (from 1)."""

    def __init__(self, file: str, line: int, message: str) -> None:
        super().__init__(f"{file}:{line}: {message}" if line else f"{file}: {message}")
        self.file = file
        self.line = line
        self.message = message


class Sheet(Protocol):
    """A template ready to be rendered."""

    def has(self, block: str) -> bool:
        """Return whether the template has a block."""
        ...

    def render(self, block: str, values: Mapping[str, object]) -> str:
        """Return the text of one block; empty if the template has no such block. Raises ``TemplateProblem``."""
        ...


@dataclass(frozen=True, slots=True)
class CompiledSheet:
    """A compiled template together with the templates that it extends.

    A block of more than ``largest`` bytes is an error.
    """

    file: str
    chain: tuple[Template, ...]
    largest: int | None = None

    def has(self, block: str) -> bool:
        """Return whether the template has a block."""
        return any(block in template.blocks for template in self.chain)

    def render(self, block: str, values: Mapping[str, object]) -> str:
        """Return the text of one block, empty if the template lacks it; raises ``TemplateProblem``."""
        context = self.chain[0].new_context(dict(values))
        for parent in self.chain[1:]:
            for name, render in parent.blocks.items():
                context.blocks.setdefault(name, []).append(render)
        found = context.blocks.get(block)
        if not found:
            return ""
        try:
            return "".join(found[0](context) if self.largest is None else _limited(found[0](context), self.largest))
        except Exception as error:  # Expressions of a template can raise anything.
            raise _problem(self, error) from None


class _TooLong(Exception):
    """A block exceeds its size limit."""

    def __init__(self, largest: int) -> None:
        super().__init__(f"the block makes more than {largest} bytes of text (limit template-output)")


def _limited(pieces: Iterator[str], largest: int) -> Iterator[str]:
    size = 0
    for piece in pieces:
        size += len(piece.encode("utf-8"))
        if size > largest:
            raise _TooLong(largest)
        yield piece


@cache
def our_sheet(name: str = OURS[0]) -> Sheet:
    """Return a built-in template."""
    return compiled(f"{name}{ENDING}", _our_source(f"{name}{ENDING}") or "")


def _our_source(name: str) -> str | None:
    known = [f"{own}{ENDING}" for own in OURS]
    return load_text(Path(__file__).parent / "templates" / name) if name in known else None


def compiled(file: str, source: str, largest: int | None = None) -> CompiledSheet:
    """Compile a template. Raises ``TemplateProblem``.

    ``source`` is the text of a built-in template or of a user's. Each block of a user's template may have at most
    ``largest`` bytes.
    """
    from jinja2 import (
        Environment,
        FunctionLoader,
        StrictUndefined,
        TemplateError,
        TemplateNotFound,
        TemplateSyntaxError,
    )
    from jinja2.nodes import Const, Extends
    from jinja2.sandbox import SandboxedEnvironment

    def load(name: str) -> tuple[str, str, None] | None:
        text = source if name == file else _our_source(name)
        return None if text is None else (text, name, None)

    # Feature files are plain text: HTML escaping would corrupt names. Ours need no sandbox, which is slow.
    environment = (Environment if largest is None else SandboxedEnvironment)(
        loader=FunctionLoader(load), undefined=StrictUndefined, autoescape=False, keep_trailing_newline=True
    )
    chain: list[Template] = []
    name: str | None = file
    line = 0
    try:
        while name is not None:
            chain.append(environment.get_template(name))
            text = load(name)
            extends = environment.parse(text[0] if text else "").find(Extends)
            line = extends.lineno if extends else 0
            name = extends.template.value if extends and isinstance(extends.template, Const) else None
            if len(chain) > len(OURS) + 1:
                raise TemplateProblem(file, line, "the template extends itself")
    except TemplateSyntaxError as error:
        raise TemplateProblem(error.filename or file, error.lineno, error.message or "is not valid") from None
    except TemplateNotFound as error:
        known = ", ".join(f"{own}{ENDING}" for own in OURS)
        raise TemplateProblem(file, line, f"there is no template '{error.name}' to extend; there are {known}") from None
    except TemplateError as error:
        raise TemplateProblem(file, 0, str(error)) from None
    except (MemoryError, OverflowError, RecursionError, SyntaxError) as error:
        # Jinja evaluates constant expressions and compiles the rest to Python, which nests less deeply.
        said = " ".join(str(error).split())[:LONGEST_MESSAGE]
        raise TemplateProblem(file, 0, f"the template cannot be compiled ({type(error).__name__}: {said})") from None
    found = CompiledSheet(file, tuple(chain), largest)
    if not found.has("scenario"):
        raise TemplateProblem(file, 0, f"the template has no block 'scenario' (blocks: {', '.join(BLOCKS)})")
    return found


def _problem(sheet: CompiledSheet, error: Exception) -> TemplateProblem:
    """Convert an error of a template to a problem at the innermost template line in the traceback."""
    templates = {template.filename: template for template in sheet.chain}
    places = [entry for entry in traceback.extract_tb(error.__traceback__) if entry.filename in templates]
    file, line = sheet.file, 0
    if places:
        # These frames belong to the Python code compiled from a template.
        file = places[-1].filename
        line = templates[file].get_corresponding_lineno(places[-1].lineno or 0)
    if isinstance(error, MemoryError):
        return TemplateProblem(file, line, "the template needs more memory than the limit template-memory")
    is_plain = isinstance(error, _TooLong) or type(error).__module__.startswith("jinja2")
    kind = "" if is_plain else f"{type(error).__name__}: "
    return TemplateProblem(file, line, kind + re.sub(r"\s+", " ", str(error)[:LONGEST_MESSAGE]))
