"""Foreign models give the scenarios that the reference generates, and those that it omits."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from gherkin_kit import Read, read_by_behave
from kit import corpus
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.gherkin.feature import feature_pieces
from robbdd_tools.gherkin.variations import count
from robbdd_tools.graph.acceptance_model import AcceptanceModel
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project

Seen = tuple[frozenset[tuple[str, frozenset[str]]], tuple[tuple[str, str], ...]]
ANY_PLACE = 'and places it at "any of '
OBJECTS = "a set of objects"


def model_of(path: Path) -> AcceptanceModel:
    project = Project()
    uri = path_to_uri(path)
    project.load(uri)
    return read_model(build_graph(project.snapshot(), uri).graph)


def tables(scenario: Read) -> dict[str, frozenset[str]]:
    titles = (text for _, text in scenario.steps)
    return {title: frozenset(rows) for title, rows in zip(titles, scenario.tables, strict=False)}


def seen(scenario: Read) -> Seen:
    """Scene tables as sets, then the clauses in order.

    Not compared are horizons, which the reference loses, the target of a configuration, which it leaves as a variable,
    and the objects of the scene, of which it drops some that belong to several sets. A set as a place is "any of" it in
    ours.
    """
    written = scenario.steps[[text for _, text in scenario.steps].index("the scene is set up") + 1 :]
    written = [(role, text.replace(ANY_PLACE, ANY_PLACE.removesuffix("any of "))) for role, text in written]
    steps = tuple((role, re.sub(r'^"[^"]*"(?= has config )| for \S+ seconds', "", text)) for role, text in written)
    return frozenset((title, rows) for title, rows in tables(scenario).items() if title != OBJECTS), steps


def by_variant(scenarios: list[Read]) -> dict[str, Counter[Seen]]:
    found: dict[str, Counter[Seen]] = {}
    for scenario in scenarios:
        name = scenario.name.rpartition(" -- ")[0]
        found.setdefault(name, Counter()).update([seen(scenario)])
    return found


def pairs() -> list[tuple[Path, Path]]:
    models = [path for path in corpus(".bdd") if path.parent.name == "current"]
    features = [(path, path.parent.parent / "features" / f"{path.stem}.feature") for path in models]
    return [(model, feature) for model, feature in features if feature.is_file()]


def test_scenarios_are_those_of_the_reference() -> None:
    compared = 0
    for path, reference in pairs():
        model = model_of(path)
        told = "".join(piece.text for story in model.stories for piece in feature_pieces(model, story))
        ours, theirs = read_by_behave(told), read_by_behave(reference.read_text(encoding="utf-8"))
        objects = [frozenset[str]().union(*(tables(one)[OBJECTS] for one in every)) for every in (ours, theirs)]
        assert objects[0] >= objects[1]
        written = by_variant(ours)
        for name, scenarios in by_variant(theirs).items():
            assert written[name] == scenarios, f"{path.name}: {name}"
            compared += scenarios.total()
    assert compared > 0


@pytest.mark.parametrize("template", ["default", "compact", "de"])
def test_every_foreign_model_has_a_feature_with_all_of_its_scenarios(template: str) -> None:
    from robbdd_tools.gherkin.user_template import sheet

    for path in corpus(".bdd"):
        model = model_of(path)
        for story in model.stories:
            text = "".join(piece.text for piece in feature_pieces(model, story, sheet=sheet(template)))
            wanted = sum(count(variant.variation) for variant in story.variants)
            assert len(read_by_behave(text)) == wanted > 0
