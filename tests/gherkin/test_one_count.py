"""The text's count of scenarios (hints, diagnostics) equals the graph's (Gherkin, runs)."""

from __future__ import annotations

from pathlib import Path

import pytest

from checks.models import LINES, SETS, story
from kit import MODELS, fixture
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.gherkin.variations import bindings, count
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph
from robbdd_tools.names.project import Project, Snapshot
from robbdd_tools.names.variant_places import variants_of

GOALS = "                set var <fetch.goals>: "


def counts(snapshot: Snapshot, uri: str) -> list[tuple[int | None, int, int]]:
    """Return for each variant the count from its text, the count from its graph, and what Gherkin lists."""
    model = read_model(build_graph(snapshot, uri).graph)
    found = {str(variant.iri): variant.variation for story in model.stories for variant in story.variants}
    return [
        (number_of_scenarios(one), count(found[one.iri]), len(list(bindings(found[one.iri]))))
        for one in variants_of(snapshot, uri)
    ]


@pytest.mark.parametrize(
    "values",
    [
        "select 2 combinations from <places>",
        "select 3 repeated combinations from <places>",
        "select 2 permutations from <places>",
        "select 2 repeated permutations from <places>",
        "select 3 repeated permutations from <places>",
        "{ { <places.tray_ws> }, { <places.tray_ws> } }",
    ],
)
def test_a_variation_has_one_count(values: str) -> None:
    case = fixture(story(f"{LINES}{GOALS}{values}\n", SETS))
    ((said, counted, listed),) = counts(case.snapshot, case.uri)
    assert said == counted == listed


@pytest.mark.parametrize("path", [path for path in MODELS if path.suffix == ".bdd"], ids=lambda path: path.name)
def test_every_example_has_one_count(path: Path) -> None:
    project, uri = Project(), path_to_uri(path)
    project.load(uri)
    for said, counted, listed in counts(project.snapshot(), uri):
        assert said == counted == listed
