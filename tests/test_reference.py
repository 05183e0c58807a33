"""The models of the language reference: checked, run, and with an example of each construct."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from construct_examples import LANGUAGES, example_of_rule, examples
from construct_output import gherkin, turtle

from fork_kit import ROBBDD
from kit import DOCS
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.features.diagnostics import all_diagnostics
from robbdd_tools.names.project import Project
from robbdd_tools.syntax.constructs import Construct, constructs
from robbdd_tools.syntax.phrases import PREDICATE_RULE

FOLDER = DOCS / "language" / "examples"
MODELS = sorted(path for path in FOLDER.iterdir() if path.suffix[1:] in LANGUAGES)
STATED = {"not-simulated", "published-form", "shacl-scenario-task", "catalog-models", "no-model"}
"""Remarks on what the models show on purpose: ROS, the published form, models that only a `.scenex` names."""
CONSTRUCTS = [one for source in (*LANGUAGES, "base") for one in constructs(source)]


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.name)
def test_the_models_have_no_problem(path: Path) -> None:
    project = Project()
    project.load(path_to_uri(path))
    found = all_diagnostics(project.snapshot(), path_to_uri(path))
    assert [one for one in found if one.severity is Severity.ERROR or one.code not in STATED] == []


@pytest.mark.physics
@pytest.mark.usefixtures("forks")
@pytest.mark.parametrize("name", ["packing.bdd", "packing.bddx", "published.bdd"])
def test_the_clauses_of_the_models_hold(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "models"
    shutil.copytree(FOLDER, folder)
    done = subprocess.run([*ROBBDD, "run", name], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("construct", CONSTRUCTS, ids=lambda one: f"{one.source}-{one.title}")
def test_each_construct_has_an_example(construct: Construct) -> None:
    found = examples(construct)
    assert found, "show it in a model of docs/language/examples"
    for example in found:
        assert example.text.strip()


def test_each_predicate_but_those_of_text_has_an_example() -> None:
    rules = {name: PREDICATE_RULE + name.replace("-", "_") for name in load_catalog().predicates}
    assert [name for name, rule in rules.items() if example_of_rule("bdd", rule) is None] == []


def test_an_example_is_shown_with_its_own_gherkin_and_graph_only() -> None:
    (kept,) = (one for one in CONSTRUCTS if one.title == "First, last, every")
    example = examples(kept)[0]
    steps, graph = gherkin(example), turtle(example)
    assert steps.count("\n") == 0
    assert "after the first" in steps
    assert graph.splitlines()[0].startswith("crit:stays")
    assert "crit:carried" not in graph
