"""Models as text to features, and features as the two parsers read them."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

from kit import MODEL, SCENE, fixture
from robbdd_tools.gherkin.feature import FeaturePiece, feature_pieces
from robbdd_tools.gherkin.user_template import sheet
from robbdd_tools.graph.acceptance_model import AcceptanceModel
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph


@dataclass(frozen=True)
class Read:
    """A scenario as a parser reads it, outlines expanded.

    ``steps`` are (role, text), ``tables`` the first columns, ``tags`` sorted.
    """

    name: str
    tags: tuple[str, ...]
    steps: tuple[tuple[str, str], ...]
    tables: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]


def model_of(text: str, scene: str = SCENE) -> AcceptanceModel:
    case = fixture(f"//- main.bdd\n{text}\n//- lab.scene\n{scene}")
    assert case.snapshot.file(case.uri) is not None
    return read_model(build_graph(case.snapshot, case.uri).graph)


def pieces(text: str, template: str = "default", scene: str = SCENE) -> list[FeaturePiece]:
    model = model_of(text, scene)
    return [piece for story in model.stories for piece in feature_pieces(model, story, sheet=sheet(template))]


def feature(text: str, template: str = "default", scene: str = SCENE) -> str:
    return "".join(piece.text for piece in pieces(text, template, scene))


def steps(text: str, number: int = 0) -> list[str]:
    scenario = [piece.scenario for piece in pieces(text) if piece.scenario][number]
    return [f"{step.keyword} {step.text}" for step in scenario.steps]


def edited(old: str, new: str, model: str = MODEL) -> str:
    assert old in model
    return model.replace(old, new, 1)


def read_by_behave(text: str) -> list[Read]:
    """Return the scenarios of a feature as parsed by behave; background steps first."""
    parsed: Any = import_module("behave.parser").parse_feature(text)
    assert parsed is not None
    found: list[Read] = []
    for scenario in parsed.walk_scenarios():
        every = list(scenario.all_steps)
        tables = tuple(tuple(row[0] for row in step.table.rows) for step in every if step.table is not None)
        written = tuple((str(step.step_type), str(step.name)) for step in every)
        lines = tuple(int(step.line) for step in every)
        tags = tuple(sorted(map(str, scenario.effective_tags)))
        found.append(Read(str(scenario.name), tags, written, tables, lines))
    return found


def read_officially(text: str) -> list[Read]:
    """Return the scenarios (pickles) of a feature as the official parser and compiler see them."""
    document: Any = import_module("gherkin.parser").Parser().parse(text)
    document["uri"] = "x.feature"
    pickles: Any = import_module("gherkin.pickles.compiler").Compiler().compile(document)
    kinds = {"Context": "given", "Action": "when", "Outcome": "then"}
    found: list[Read] = []
    for pickle in pickles:
        written = tuple((kinds[step["type"]], str(step["text"])) for step in pickle["steps"])
        arguments = [step.get("argument") for step in pickle["steps"]]
        rows = [argument["dataTable"]["rows"][1:] for argument in arguments if argument]
        tables = tuple(tuple(row["cells"][0]["value"] for row in table) for table in rows)
        tags = tuple(sorted(tag["name"].removeprefix("@") for tag in pickle["tags"]))
        found.append(Read(pickle["name"], tags, written, tables, ()))
    return found
