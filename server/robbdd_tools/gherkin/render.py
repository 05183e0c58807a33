"""Feature templates: ours and the user's, in a sandbox, rendered block by block."""

from __future__ import annotations

import re
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import UnreadableFile, load_text

if TYPE_CHECKING:
    from jinja2 import Template

OURS = ("default", "compact", "de")
"""Names of the templates that come with us."""
BLOCKS = ("feature", "variant", "scenario", "end")
"""What a template may define; ``scenario`` is the one that it must."""
ENDING = ".feature.jinja"


class TemplateProblem(Exception):
    """A template cannot be used; the message begins with its file and, where one is to blame, the line (from 1)."""

    def __init__(self, file: str, line: int, message: str) -> None:
        super().__init__(f"{file}:{line}: {message}" if line else f"{file}: {message}")
        self.file = file
        self.line = line


@dataclass(frozen=True, slots=True)
class Sheet:
    """A template ready to be rendered, with those that it extends."""

    file: str
    chain: tuple[Template, ...]

    def has(self, block: str) -> bool:
        """Tell whether the template has a block."""
        return any(block in template.blocks for template in self.chain)

    def render(self, block: str, values: Mapping[str, object]) -> str:
        """Return the text of one block, nothing when the template lacks it; raises ``TemplateProblem``."""
        context = self.chain[0].new_context(dict(values))
        for parent in self.chain[1:]:
            for name, render in parent.blocks.items():
                context.blocks.setdefault(name, []).append(render)
        found = context.blocks.get(block)
        if not found:
            return ""
        try:
            return "".join(found[0](context))
        except Exception as error:  # whatever the expressions of a template do wrong
            raise _problem(self, error) from None


def sheet(name: str) -> Sheet:
    """Return one of our templates by its name, or a user's by its path; raises ``TemplateProblem``."""
    return our_sheet(name) if name in OURS else _user_sheet(name)


@cache
def our_sheet(name: str = OURS[0]) -> Sheet:
    """Return one of our templates."""
    return _sheet(f"{name}{ENDING}", _our_source(f"{name}{ENDING}") or "", user=False)


def _user_sheet(file: str) -> Sheet:
    try:
        source = load_text(Path(file))
    except UnreadableFile as error:
        known = ", ".join(OURS)
        raise TemplateProblem(file, 0, f"{error} (templates that come along: {known})") from None
    return _sheet(file, source, user=True)


def _our_source(name: str) -> str | None:
    known = [f"{own}{ENDING}" for own in OURS]
    return load_text(Path(__file__).parent / "templates" / name) if name in known else None


def _sheet(file: str, source: str, *, user: bool) -> Sheet:
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

    # Feature files are plain text: HTML escaping would corrupt the names. Ours need no sandbox, which costs time.
    environment = (SandboxedEnvironment if user else Environment)(
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
        raise TemplateProblem(file, line, f"there is no template '{error.name}' to extend, only {known}") from None
    except TemplateError as error:
        raise TemplateProblem(file, 0, str(error)) from None
    found = Sheet(file, tuple(chain))
    if not found.has("scenario"):
        raise TemplateProblem(file, 0, f"the template has no block 'scenario' (blocks: {', '.join(BLOCKS)})")
    return found


def _problem(sheet: Sheet, error: Exception) -> TemplateProblem:
    """Blame the innermost line of a template on the way to an error."""
    templates = {template.filename: template for template in sheet.chain}
    places = [entry for entry in traceback.extract_tb(error.__traceback__) if entry.filename in templates]
    file, line = sheet.file, 0
    if places:
        # The frames are those of the Python code that a template is compiled to.
        file = places[-1].filename
        line = templates[file].get_corresponding_lineno(places[-1].lineno or 0)
    kind = "" if type(error).__module__.startswith("jinja2") else f"{type(error).__name__}: "
    return TemplateProblem(file, line, kind + re.sub(r"\s+", " ", str(error)))
