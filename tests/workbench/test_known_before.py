"""What leaves clauses unknown, and can be known without a simulation, is a finding on the model before it is run."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

import robbdd_tools as robbdd
from kit import EXAMPLES, corpus
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.workbench.choice import Choice, Listed
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.plan import Plan, Selection

pytestmark = pytest.mark.physics

KNOWN_BEFORE = {
    "no-model": r"there is no model for (object|agent) ",
    "no-evaluator": r"no step definition for ",
    "catalog-phrase": r"no step definition for ",
    "no-emitter": r"nothing in the scenario emits ",
    "not-simulated": r"the ROS action '|its verdicts come from the ROS topic |no ROS",
    "setting": r"there is no configuration '|cannot be (configured: |'.*': it must be )| has no \w+: it applies to ",
    "single-element": r"needs one \w+, not a set of them",
    "no-room": r"there is room for ",
    "no-correct-place": r"the scene states no workspace that is correct for ",
    "no-region": r"nothing in the scene carries that workspace",
    "execution-fit": r"does not execute '|a distance is between two elements",
    "model-file": r"there is no model file ",
    "python-source": r"No module named |has no attribute ",
    "catalog-entry": r"the catalog has no ",
}
"""Codes of findings → the reason of unknown clauses in a run."""
PHYSICAL = (
    r"event \S+ never occurred",
    r"the execution was stopped after",
    r"there is no room left for '.*' (at '.*' )?among",
    r"overlap by",
)
"""Reasons that only a simulation can find."""


def covering(model: robbdd.Model) -> Choice:
    """Return few scenarios in which each variable has each of its values, by each execution."""
    seen: set[tuple[str, str, str, str]] = set()
    listed: list[Listed] = []
    for spec in model.scenarios().scenarios:
        execution = "" if spec.execution is None else spec.execution.iri
        values = {(spec.variant, execution, name, repr(value)) for name, value in spec.values.items()}
        if spec.repetition == 1 and (not values <= seen or not values):
            seen |= values
            listed.append(Listed(spec.variant, frozenset({spec.variation}), execution or None, frozenset({1})))
    return Choice(listed)


def unknown(path: Path) -> dict[str, list[robbdd.Finding]]:
    """Run scenarios with every value of every variable; return the reasons of unknown clauses with the findings."""
    model = robbdd.load(path)
    found: dict[str, list[robbdd.Finding]] = {}
    with Plan.of(model, Selection(choices=[covering(model)])).run(seed=1, keeping=Keeping(keep=False)) as run:
        for result in run:
            for clause in result.clauses:
                if clause.verdict == "unknown":
                    found[clause.reason] = list(model.diagnostics)
    return found


def assert_known(reasons: dict[str, list[robbdd.Finding]]) -> None:
    for reason, findings in reasons.items():
        codes = {code for code, pattern in KNOWN_BEFORE.items() if re.search(pattern, reason)}
        if codes:
            assert codes & {finding.code for finding in findings}, (reason, findings)
        else:
            assert any(re.search(pattern, reason) for pattern in PHYSICAL), reason


def models(folder: Path) -> Iterator[Path]:
    yield from sorted(path for path in folder.rglob("*") if path.suffix in (".bdd", ".bddx"))


@pytest.mark.parametrize("model", models(EXAMPLES), ids=lambda path: path.name)
def test_examples(model: Path) -> None:
    assert_known(unknown(model))


def test_models_by_others() -> None:
    for path in corpus(".bdd", ".bddx"):
        assert_known(unknown(path))


PICKPLACE = {
    "no-model": ("bench.scene", "object bin_left", "object vessel_left", ("bin_left", "vessel_left")),
    "no-emitter": ("pickplace.bdd", "after <evt-pick-end>", "after <parked>", ("Task", "Event (ns=crit) parked\nTask")),
    "single-element": (
        "pickplace.bdd",
        "var thing",
        "set var thing",
        ("var <pick-place.thing>:", "set var <pick-place.thing>: {"),
    ),
    "no-evaluator": (
        "pickplace.bdd",
        "<thing> is held by <robot>, after",
        "pred('{o} is safe', o=<thing>), after",
        ("", ""),
    ),
    "no-correct-place": (
        "pickplace.bdd",
        "<thing> is held by <robot>, after",
        "<goal> is correct for <thing>, after",
        ("", ""),
    ),
    "no-region": (
        "pickplace.bdd",
        "<places.left_ws>",
        "<places.spare_ws>",
        ("workspace left_ws", "workspace left_ws, workspace spare_ws"),
    ),
    "model-file": ("bench.scenex", 'catalog "bin"', "sys path = 'bucket.xml'", ("", "")),
    "not-simulated": ("pickplace.bddx", 'catalog "pick-place"', 'bhv action: "/a"', ("", "")),
    "execution-fit": ("pickplace.bddx", 'catalog "pick-place"', 'catalog "pick"', ("", "")),
    "python-source": ("pickplace.bddx", "module: policies", "module: policy", ("", "")),
    "catalog-entry": ("bench.scenex", 'catalog "bin"', 'catalog "bucket"', ("", "")),
}
"""Code → file of the example, a text in it and what takes its place; a second pair makes the rest fit."""


def planted(code: str, folder: Path) -> Path:
    """Copy the example with a fault; return the file that shows it."""
    shutil.copytree(EXAMPLES / "pickplace", folder, ignore=shutil.ignore_patterns(".*", "__pycache__"))
    name, old, new, (also, instead) = PICKPLACE[code]
    for path in folder.iterdir():
        text = path.read_text(encoding="utf-8")
        if path.name == name:
            assert old in text
            text = text.replace(old, new, 1)
        text = text.replace(also, instead) if also and path.suffix != ".bddx" else text
        if code == "single-element" and path.suffix == ".bdd":
            text = text.replace("<balls.ball0> }", "<balls.ball0> } }").replace("{ { <cubes", "{ { <cubes")
        path.write_text(text, encoding="utf-8")
    return folder / ("pickplace.bddx" if name.endswith("x") else "pickplace.bdd")


@pytest.mark.parametrize("code", PICKPLACE)
def test_a_planted_fault_is_found_before_the_run_that_it_spoils(code: str, tmp_path: Path) -> None:
    main = planted(code, tmp_path / "pickplace")
    findings = robbdd.load(main).diagnostics
    assert code in {finding.code for finding in findings}
    if any(finding.severity is Severity.ERROR for finding in findings):
        return
    reasons = unknown(main)
    assert any(re.search(KNOWN_BEFORE[code], reason) for reason in reasons), reasons
    assert_known(reasons)


@pytest.mark.parametrize("code", sorted(PICKPLACE.keys() - {"catalog-entry"}))
def test_the_fault_is_found_in_the_graph_of_the_model_too(code: str, tmp_path: Path) -> None:
    main = planted(code, tmp_path / "pickplace")
    graph = main.with_suffix(".ttl")
    graph.write_text(robbdd.load(main).graph(), encoding="utf-8")
    findings = robbdd.load(graph).diagnostics
    assert {finding.code for finding in findings} == {code}
    assert all(finding.place.line > 1 for finding in findings)
    if code in ("no-model", "no-region", "execution-fit"):
        assert_known(unknown(graph))
