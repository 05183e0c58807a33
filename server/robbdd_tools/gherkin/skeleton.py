"""Write stubs of step functions for another robot or simulator, one for each distinct sentence of a model."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from keyword import iskeyword
from pathlib import Path

from robbdd_tools.base.files import load_text
from robbdd_tools.base.step_files import defined_steps
from robbdd_tools.base.writing import replace_file
from robbdd_tools.catalog.phrases_in_text import predicates_in_text
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.gherkin import text
from robbdd_tools.gherkin.background_tables import scene_tables
from robbdd_tools.gherkin.steps import StepWriter
from robbdd_tools.graph.acceptance_model import (
    AcceptanceModel,
    BehaviourClause,
    Clause,
    Condition,
    EventClause,
    Exists,
    Fluent,
    ForAll,
    Junction,
    TextClause,
    TextFluent,
)
from robbdd_tools.monitor.time import Before, During
from robbdd_tools.protocol.clauses import MEANWHILE
from robbdd_tools.protocol.time_words import instant_words, interval_words

HEAD = '''"""Steps of {name} for a robot or simulator of your own."""

from behave import given, register_type, then, when
from behave.runner import Context
from parse import with_pattern


@with_pattern(r'(?:[^"\\\\]|\\\\.)*')
def _quoted(text: str) -> str:
    """Text between double quotes, backslashes included."""
    return text


register_type(Quoted=_quoted)
'''
_ROLES = ("given", "when", "then")
_QUOTED_SLOT = re.compile(r'(?<=")\{(\w[\w-]*)\}(?=")|\{(\w[\w-]*)\}')


@dataclass(frozen=True, slots=True)
class Pattern:
    """A sentence in the form of behave's ``parse`` matcher. ``parameters`` are pairs of a name and its Python type."""

    role: str
    text: str
    parameters: tuple[tuple[str, str], ...]


def patterns(model: AcceptanceModel) -> list[Pattern]:
    """Return the distinct sentences of a model, first from the scene and then from the clauses in order."""
    found: dict[Pattern, None] = {}
    writer = StepWriter(model, load_catalog())
    for story in model.stories:
        for variant in story.variants:
            tables = (table.title for table in scene_tables(writer, variant.scene))
            for title in (*tables, "variable scene elements", "the scene is set up"):
                found[Pattern("given", title, ())] = None
    for story in model.stories:
        for variant in story.variants:
            found.update(dict.fromkeys(_all((*variant.template.clauses, *variant.clauses))))
    return list(found)


def free_patterns(model: AcceptanceModel) -> list[Pattern]:
    """Return the distinct sentences of a model that are free text, except phrases of the catalog."""
    clauses = (
        c
        for story in model.stories
        for variant in story.variants
        for c in (*variant.template.clauses, *variant.clauses)
    )
    return list(dict.fromkeys(_all(clauses, free_only=True)))


def add_steps(wanted: Collection[Pattern], target: Path, name: str) -> int:
    """Add the missing steps to a file of steps, and return the number of new functions.

    ``target`` is created if it is missing. Raises ``OSError``, and ``SyntaxError`` if the file is not Python.
    """
    existing = load_text(target) if os.path.lexists(target) else None
    text, new = skeleton(wanted, existing, name)
    if new:
        target.parent.mkdir(parents=True, exist_ok=True)
        replace_file(target, text)
    return new


def skeleton(wanted: Iterable[Pattern], existing: str | None, name: str) -> tuple[str, int]:
    """Return the text of a file of steps, and the number of new functions in it.

    ``existing`` is the current text of the file or ``None``. Its definitions are kept. Raises ``SyntaxError`` if it is
    not Python.
    """
    defined, names = defined_steps(existing or "")
    grouped: dict[tuple[str, tuple[tuple[str, str], ...]], list[str]] = {}
    for pattern in wanted:
        if not defined & {(pattern.role, pattern.text), ("step", pattern.text)}:
            grouped.setdefault((pattern.text, pattern.parameters), []).append(pattern.role)
    functions = [_function(sentence, parameters, roles, names) for (sentence, parameters), roles in grouped.items()]
    head = HEAD.format(name=text.line(name)) if existing is None else existing.rstrip("\n") + "\n"
    return "\n\n".join((head, *functions)), len(functions)


def _all(clauses: Iterable[Clause], *, free_only: bool = False) -> Iterator[Pattern]:
    for clause in clauses:
        match clause:
            case ForAll() | Exists():
                yield from _all(clause.clauses, free_only=free_only)
            case Junction(operator="and"):
                yield from _all(clause.operands, free_only=free_only)
            case Junction() | EventClause() | BehaviourClause() | Fluent() if free_only:
                pass
            case TextFluent() if free_only and predicates_in_text(clause.template, clause.arguments):
                pass
            case Junction(operator="not"):
                yield Pattern(clause.role, "not ( {clause} )", (("clause", "str"),))
            case Junction():
                yield Pattern(clause.role, "( {alternatives} )", (("alternatives", "str"),))
            case EventClause():
                yield _pattern("when", 'event "{event}" occurs')
            case BehaviourClause():
                lead = "" if clause.together is None else MEANWHILE
                yield _pattern("when", f"{lead}{load_catalog().behaviours[clause.behaviour].sentence}")
            case Fluent():
                yield _pattern(clause.role, f"{_sentence(clause)}{_condition(clause)} {_time(clause)}")
            case TextFluent():
                yield _pattern(clause.role, f"{text.free(clause.template)}{_condition(clause)} {_time(clause)}")
            case TextClause():
                literal = text.free(clause.text).replace("{", "{{").replace("}", "}}")
                yield _pattern(clause.role, f"{literal} {_time(clause)}")


def _sentence(clause: Fluent | Condition) -> str:
    predicate = clause.named or load_catalog().predicates[clause.predicate]
    return predicate.sentence


def _condition(clause: Fluent | TextFluent) -> str:
    sentences = list(map(_sentence, clause.conditions))
    return f" whenever {' and '.join(sentences)}" if sentences else ""


def _time(clause: Fluent | TextFluent | TextClause) -> str:
    constraint = clause.time
    if isinstance(constraint, During):
        return interval_words("{start}", "{end}", constraint.some_time)
    relation = "before" if isinstance(constraint, Before) else "after"
    seconds = None if constraint.horizon is None and clause.seconds is None else "{seconds:g}"
    return instant_words(relation, "{event}", seconds, constraint.some_time, constraint.which)


def _pattern(role: str, sentence: str) -> Pattern:
    parameters: list[tuple[str, str]] = []

    def slot(match: re.Match[str]) -> str:
        name = _parameter(match[1] or match[2], [taken for taken, _ in parameters])
        parameters.append((name, "str"))
        return f"{{{name}:Quoted}}" if match[1] else f"{{{name}}}"

    template = _QUOTED_SLOT.sub(slot, sentence)
    if "{seconds:g}" in template:
        parameters.append(("seconds", "float"))
    return Pattern(role, template, tuple(parameters))


def _parameter(slot: str, taken: Collection[str]) -> str:
    """Return a valid, unused parameter name for a slot."""
    base = re.sub(r"\W|^(?=\d)", "_", slot)
    base = f"{base}_" if iskeyword(base) or base == "context" else base
    name, number = base, 2
    while name in taken:
        name, number = f"{base}{number}", number + 1
    return name


def _function(sentence: str, parameters: tuple[tuple[str, str], ...], roles: list[str], names: set[str]) -> str:
    decorators = "".join(f"@{role}({sentence!r})\n" for role in _ROLES if role in roles)
    arguments = "".join(f", {name}: {kind}" for name, kind in parameters)
    # The generated function must not pass before the user has written it.
    return (
        f"{decorators}def {_name(sentence, names)}(context: Context{arguments}) -> None:\n"
        "    raise NotImplementedError\n"
    )


def _name(sentence: str, taken: set[str]) -> str:
    """Return a function name that is made of the words of a sentence and not yet taken."""
    words = re.findall(r"[a-z0-9]+", re.sub(r"\{(\w+)[^}]*\}", r" \1 ", sentence).lower())
    base = "_".join(words)[:60].strip("_") or "step"
    base = base if not base[0].isdigit() else f"step_{base}"
    name, number = base, 2
    while name in taken:
        name, number = f"{base}_{number}", number + 1
    taken.add(name)
    return name
