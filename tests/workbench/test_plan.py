"""A plan determines the executed scenarios, their order, seeds and repetitions."""

from __future__ import annotations

from pathlib import Path

import pytest

from kit import EXAMPLES
from robbdd_tools.gherkin.select import SelectionError
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.workbench.choice import Choice, Listed
from robbdd_tools.workbench.model import Model, load
from robbdd_tools.workbench.plan import NothingSelected, Plan, Selection

PICKPLACE = EXAMPLES / "pickplace" / "pickplace.bdd"
EXECUTED = EXAMPLES / "pickplace" / "pickplace.bddx"


@pytest.fixture(scope="module")
def model() -> Model:
    return load(PICKPLACE)


@pytest.fixture(scope="module")
def executed() -> Model:
    return load(EXECUTED)


def numbers(plan: Plan) -> list[int]:
    return [spec.variation for spec in plan.scenarios]


def executions(plan: Plan) -> set[str]:
    return {spec.execution.name for spec in plan.scenarios if spec.execution is not None}


def variant(model: Model) -> str:
    return model.scenarios().scenarios[0].variant


def test_a_plan_takes_everything_in_written_order(model: Model) -> None:
    assert numbers(model.scenarios()) == [1, 2, 3, 4]


def test_conditions_and_amounts_reduce_it(model: Model) -> None:
    assert all(spec.values["crit:var-goal"] == "env:left_ws" for spec in goals(model, "goal=left_ws"))
    assert numbers(model.scenarios(first=2)) == [1, 2]
    assert len(model.scenarios(sample=3, seed=7)) == 3
    (cover,) = model.scenarios(pairwise=2).covers
    assert cover.covered == cover.possible


def goals(model: Model, where: str) -> tuple[ScenarioSpec, ...]:
    found = model.scenarios(where=where).scenarios
    assert found
    return found


def test_a_name_is_local_a_curie_or_an_iri(model: Model) -> None:
    iri = variant(model)
    for name in ("part-to-bin", "crit:part-to-bin", iri):
        assert len(model.scenarios(name)) == 4


def test_a_name_of_an_execution_selects_it(executed: Model) -> None:
    every = executions(executed.scenarios())
    name = sorted(every)[0]
    assert executions(executed.scenarios(name.rpartition(":")[2])) == {name}


def test_unknown_names_and_bad_conditions_are_refused(model: Model) -> None:
    with pytest.raises(SelectionError, match="there is no scenario 'gone'; the model has part-to-bin"):
        model.scenarios("gone")
    with pytest.raises(SelectionError, match="column"):
        model.scenarios(where="goal=")
    with pytest.raises(NothingSelected, match="no scenario fits"):
        model.scenarios(where="goal=elsewhere")
    with pytest.raises(ValueError, match="only one of first and sample"):
        model.scenarios(first=1, sample=1)


def test_a_choice_lists_scenarios_by_number(model: Model) -> None:
    listed = Choice([Listed(variant(model), frozenset({2, 4}))])
    assert numbers(Plan.of(model, Selection(choices=[listed]))) == [2, 4]
    other = Choice([Listed(variant(model), frozenset({4}))])
    assert numbers(Plan.of(model, Selection(choices=[listed, other]))) == [4]


def test_a_choice_lists_repetitions(model: Model, tmp_path: Path) -> None:
    listed = Choice([Listed(variant(model), frozenset({1}), repetitions=frozenset({3}))])
    manifest = Plan.of(model, Selection(choices=[listed])).prepare(tmp_path, repeat=3)
    assert [(spec.variation, spec.repetition) for spec in manifest.scenarios] == [(1, 3)]


def test_a_choice_lists_an_execution(executed: Model) -> None:
    every = executed.scenarios().scenarios
    wanted = every[-1].execution
    assert wanted is not None
    listed = Choice([Listed(every[-1].variant, execution=wanted.iri)])
    assert executions(Plan.of(executed, Selection(choices=[listed]))) == {wanted.name}


def test_a_choice_of_scenarios_that_are_gone_is_refused(model: Model) -> None:
    gone = Choice([Listed("https://example.org/gone")])
    with pytest.raises(NothingSelected, match="no longer"):
        Plan.of(model, Selection(choices=[gone]))


def test_a_seed_decides_all_seeds_and_replaces_those_of_executions(executed: Model, tmp_path: Path) -> None:
    plan = executed.scenarios()
    own = [spec.seed for spec in plan.scenarios]
    seeded = [spec.seed for spec in plan.prepare(tmp_path / "a", seed=5).scenarios]
    assert seeded == [spec.seed for spec in executed.scenarios(seed=5).scenarios]
    assert seeded != own


def test_a_number_of_repetitions_replaces_that_of_executions(model: Model, tmp_path: Path) -> None:
    manifest = model.scenarios(first=1).prepare(tmp_path, repeat=2)
    assert [spec.repetition for spec in manifest.scenarios] == [1, 2]
    assert len({spec.seed for spec in manifest.scenarios}) == 2


def test_a_folder_runs_each_variant_and_execution_once() -> None:
    model = load(EXAMPLES / "pickplace")
    keys = [
        (spec.variant, spec.variation, spec.repetition, spec.execution and spec.execution.iri)
        for spec in model.scenarios().scenarios
    ]
    assert len(keys) == len(set(keys))
