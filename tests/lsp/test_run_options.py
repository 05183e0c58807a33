"""The editor's run options select what the same options of the command line select."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kit import EXAMPLES
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.run_verdicts import JudgedScenario, Judgement
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.lsp.convert import Converter
from robbdd_tools.lsp.run_options import BadArgument, RunDefaults, RunOptions
from robbdd_tools.lsp.run_request import plan_run
from robbdd_tools.names.project import Project
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.workbench.model import load
from robbdd_tools.workbench.rerun import NothingFailed

PICKPLACE = EXAMPLES / "pickplace" / "pickplace.bdd"
EXECUTED = EXAMPLES / "pickplace" / "pickplace.bddx"
VARIANT = "https://example.org/robbdd/criteria/part-to-bin"


def planned(path: Path, folder: Path, *results: JudgedScenario, **options: Any) -> tuple[ScenarioSpec, ...]:
    """What a run with these options executes."""
    project = Project()
    uri = path_to_uri(path)
    project.load(uri)
    run = plan_run(project.snapshot(), Converter(), RunOptions.of({"uri": uri, **options}), results)
    return run.plan.prepare(folder, repeat=run.repeat).scenarios


def keys(specs: tuple[ScenarioSpec, ...]) -> list[tuple[str, int, int]]:
    return [(spec.name, spec.seed, spec.repetition) for spec in specs]


@pytest.mark.parametrize("path", [PICKPLACE, EXECUTED])
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"seed": 7},
        {"first": 2},
        {"sample": 2, "seed": 5},
        {"pairwise": 2},
        {"where": "goal=left_ws"},
        {"repeat": 3, "first": 1},
    ],
)
def test_the_same_options_plan_the_same_executions(path: Path, options: dict[str, Any], tmp_path: Path) -> None:
    repeat = options.get("repeat")
    selection = {name: value for name, value in options.items() if name != "repeat"}
    expected = load(path).scenarios(**selection).prepare(tmp_path / "expected", repeat=repeat).scenarios
    assert keys(planned(path, tmp_path / "planned", **options)) == keys(expected)


def test_a_substitution_of_the_command_counts_before_that_of_the_settings(tmp_path: Path) -> None:
    project, uri = Project(), path_to_uri(EXECUTED)
    project.load(uri)

    def executed(options: dict[str, Any], settings: dict[str, str]) -> set[str]:
        run = plan_run(
            project.snapshot(), Converter(), RunOptions.of({"uri": uri, **options}), (), RunDefaults(settings)
        )
        return {str(spec.substitution) for spec in run.plan.prepare(tmp_path).scenarios}

    assert executed({}, {"other": "pick-place"}) == {"None"}
    (by_setting,) = executed({}, {"built-in": "pick-place"})
    assert "'pick-place' substitutes" in by_setting
    with pytest.raises(SelectionError, match="no behaviour 'none'"):
        executed({"bhv": {"built-in": "none"}}, {"built-in": "pick-place"})


def failed(variation: int, repetition: int, run: int, seed: int | None) -> JudgedScenario:
    judgement = Judgement("at-goal", "violated", "", 0.0, "", "")
    return JudgedScenario(
        "", VARIANT, variation, "", "", "", {"x": judgement}, True, run, repetition=repetition, seed=seed
    )


def test_failures_are_executed_again_with_their_seed_and_repetition(tmp_path: Path) -> None:
    again = planned(PICKPLACE, tmp_path / "again", failed(2, 3, run=1, seed=9), failed=True)
    every = planned(PICKPLACE, tmp_path / "every", seed=9, repeat=3)
    assert keys(again) == keys(tuple(spec for spec in every if (spec.variation, spec.repetition) == (2, 3)))
    newest = planned(PICKPLACE, tmp_path / "newest", failed(2, 1, 1, 9), failed(3, 1, 2, None), failed=True)
    plain = planned(PICKPLACE, tmp_path / "plain")
    assert keys(newest) == keys(plain)[1:3]


def test_nothing_failed_where_only_others_did(tmp_path: Path) -> None:
    with pytest.raises(NothingFailed):
        planned(PICKPLACE, tmp_path, failed(2, 1, 1, None), failed=True, variation=1)
    with pytest.raises(NothingFailed):
        planned(PICKPLACE, tmp_path, failed=True)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"repeat": 0}, "'repeat': it must be a whole number above 0"),
        ({"jobs": True}, "'jobs': it must be a whole number above 0"),
        ({"seed": 1.5}, "'seed': it must be a whole number"),
        ({"seed": 2**63}, "'seed': it must be a whole number from -9223372036854775807"),
        ({"pairwise": 4}, "'pairwise': it must be 2 or 3"),
        ({"first": 1, "sample": 1}, "give only one of first and sample"),
        ({"only": [{"variant": VARIANT, "variations": ["1"]}]}, "no usable 'only'"),
        ({"only": [{"variant": VARIANT, "execution": 1}]}, "no usable 'only'"),
        ({"record": 1}, "'record': it must be true or false"),
        ({"stop_on_failure": 1}, "'stop_on_failure': it must be true or false"),
        ({"bhv": {"built-in": 1}}, "'bhv': it must be an object"),
    ],
)
def test_a_bad_option_is_named_with_its_form(options: dict[str, Any], words: str) -> None:
    with pytest.raises(BadArgument, match=words):
        RunOptions.of({"uri": "file:///m.bdd", **options})


def test_a_run_is_whole_unless_something_reduces_it() -> None:
    def whole(**options: Any) -> bool:
        return RunOptions.of({"uri": "file:///m.bdd", **options}).is_whole

    assert whole(seed=3, repeat=2, jobs=1, only=[{"variant": VARIANT}])
    for reduced in ({"first": 1}, {"sample": 1}, {"pairwise": 2}, {"where": "a=b"}, {"variation": 1}, {"failed": True}):
        assert not whole(**reduced)
    assert not whole(stop_on_failure=True)
    assert not whole(only=[{"variant": VARIANT, "variations": [1]}])
