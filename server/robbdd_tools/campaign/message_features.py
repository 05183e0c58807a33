"""Features and scenarios of a run as Cucumber Messages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.files import load_text
from robbdd_tools.base.limits import RESULT_SIZE
from robbdd_tools.base.printable import printable

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.protocol.specs import ScenarioSpec


class NoMessages(RobbddError):
    """The run cannot be written as Cucumber Messages; the message gives the reason."""


def message_types() -> Any:
    """Return the package of the message types, which has no type information. Raises ``NoMessages``."""
    try:
        return import_module("cucumber_messages")
    except ImportError as error:
        raise NoMessages("Cucumber Messages need two more packages: install robbdd-tools[cucumber]") from error


class MessageFeature:
    """A feature in which each execution is a scenario of its own, as the reference parser of Gherkin reads it.

    Reports show a scenario once, so a scenario of the run's feature is repeated for each of its repetitions.
    """

    def __init__(self, folder: Path, name: str, specs: Sequence[ScenarioSpec], ids: Any) -> None:
        from gherkin.errors import ParserError

        try:
            self.text, moved = _repeated(load_text(folder / name, RESULT_SIZE), specs)
            parsed = _parsed(self.text, ids)
        except (OSError, ParserError) as error:
            raise NoMessages(f"the run has no feature {name} that Gherkin reads: {error}") from error
        self.name = name
        self.document: dict[str, Any] = {**parsed, "uri": name}
        pickles: list[dict[str, Any]] = _compiled(self.document, ids)
        inside = [one.get("background") or one["scenario"] for one in self.document["feature"]["children"]]
        lines = {step["id"]: step["location"]["line"] for one in inside for step in one["steps"]}
        self.cases = [
            MessageCase(spec, pickle, {step: line - by for step, line in lines.items()}, ids)
            for spec, pickle, by in zip(specs, pickles, moved, strict=True)
        ]

    def envelopes(self) -> Iterator[Any]:
        """Yield the text and the syntax tree of the feature."""
        messages = message_types()
        kind = messages.SourceMediaType.text_x_cucumber_gherkin_plain
        yield messages.Envelope(source=messages.Source(self.text, kind, self.name))
        yield {"gherkinDocument": self.document}


def _parsed(text: str, ids: Any) -> dict[str, Any]:
    """Return the syntax tree of a feature. Raises ``ParserError``."""
    from gherkin.ast_builder import AstBuilder
    from gherkin.parser import Parser

    found: Any = Parser(AstBuilder(ids)).parse(text)
    return found


def _compiled(document: dict[str, Any], ids: Any) -> list[dict[str, Any]]:
    from gherkin.pickles.compiler import Compiler

    compile_: Any = Compiler(ids).compile
    return compile_(document)


def _repeated(text: str, specs: Sequence[ScenarioSpec]) -> tuple[str, list[int]]:
    """Return a feature with a scenario for each execution, and by how many lines each of them has moved.

    Raises ``NoMessages`` and ``ParserError``.
    """
    from gherkin.stream.id_generator import IdGenerator

    lines = text.rstrip("\n").split("\n")
    children = _parsed(text, IdGenerator())["feature"]["children"]
    scenarios = [one["scenario"] for one in children if "scenario" in one]
    starts_ = [min(part["location"]["line"] for part in (one, *one["tags"])) for one in scenarios]
    ends = [*(start - 1 for start in starts_[1:]), len(lines)]
    blocks = {one["location"]["line"]: (start, end) for one, start, end in zip(scenarios, starts_, ends, strict=True)}
    written = lines[: starts_[0] - 1] if starts_ else lines
    moved: list[int] = []
    for spec in specs:
        if spec.line not in blocks:
            raise NoMessages(f"the feature {spec.feature} has no scenario in line {spec.line}")
        start, end = blocks[spec.line]
        moved.append(len(written) + 1 - start)
        head = lines[spec.line - 1].partition(":")[0]
        written += [*lines[start - 1 : spec.line - 1], f"{head}: {printable(spec.name)}", *lines[spec.line : end]]
        written += [""] if written[-1].strip() else []
    return "\n".join(written) + "\n", moved


class MessageCase:
    """An execution as a pickle and a test case. ``steps`` are its steps with their lines in the run's feature."""

    def __init__(self, spec: ScenarioSpec, pickle: dict[str, Any], lines: Mapping[str, int], ids: Any) -> None:
        self.spec = spec
        self.pickle = pickle
        self.identifier: str = ids.get_next_id()
        self.steps: list[tuple[str, int]] = [
            (ids.get_next_id(), lines[step["astNodeIds"][0]]) for step in pickle["steps"]
        ]

    def test_case(self, started: str) -> Any:
        """Return the test case; ``started`` is the identifier of the run."""
        messages = message_types()
        steps = [
            messages.TestStep(step, pickle_step_id=own["id"], step_definition_ids=[], step_match_arguments_lists=[])
            for (step, _), own in zip(self.steps, self.pickle["steps"], strict=True)
        ]
        return messages.TestCase(self.identifier, self.pickle["id"], steps, started)
