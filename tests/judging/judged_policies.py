"""Judge a clause by an observation policy, on a trace made by hand."""

from __future__ import annotations

from dataclasses import replace

from monitor.traces import still, trace_of
from robbdd_tools.catalog.executable import Implementation
from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.scenario_clauses import judged_clause, stated_by_step
from robbdd_tools.monitor.policy import Observation, Policy, Provider, Rule
from robbdd_tools.monitor.trace import Trace
from robbdd_tools.monitor.verdict import Verdict
from robbdd_tools.protocol.clauses import Clause, Fluent, Junction, Text
from robbdd_tools.protocol.specs import ClauseSpec, ExecutionSpec, ScenarioSpec
from world.worlds import BIN_WS, CUBE, scenario

CLAUSE = "https://x/at-goal"
SENTENCE = f'"{CUBE}" is located at "{BIN_WS}" from "t:a" until "t:b"'
STATED = ClauseSpec(7, CLAUSE, "at-goal", "then", SENTENCE)
TRUTH = Provider("x:truth", "ground-truth", 100.0)
NEAR = Rule("distance", form="less-than", bounds=(0.5,))


def spec_of(
    rule: Rule = NEAR,
    provider: Provider = TRUTH,
    targets: tuple[str, ...] = ("t:var-thing", "env:bin"),
    horizon: float | None = None,
    seed: int = 1,
    model: str = "",
) -> ScenarioSpec:
    policy = Policy("x:policy", CLAUSE, rule, horizon, (Observation("x:seen", provider, targets),))
    way = ExecutionSpec("x:run", "x:run", Implementation("x:impl", "catalog", "pick-place"), policies=(policy,))
    return replace(scenario(seed=seed), values={"t:var-thing": CUBE}, execution=way, model=model)


def moving(distances: list[float]) -> Trace:
    """A cube at some distances from a bin, sampled every 0.1 s."""
    path = [[distance, 0.0, 0.0] for distance in distances]
    events = {"t:a": 0.0, "t:b": (len(path) - 1) * 0.1}
    return trace_of({CUBE: path, "env:bin": still(len(path))}, events)


def as_judged(sentence: str, known: ClauseSpec, spec: ScenarioSpec) -> Clause:
    statement = stated_by_step("then", sentence, known)
    assert isinstance(statement, Fluent | Text | Junction)
    return judged_clause(statement, known, spec)


def judged(spec: ScenarioSpec, trace: Trace, sentence: str = SENTENCE) -> Verdict:
    clause = as_judged(sentence, STATED, spec)
    return decide(clause, trace, {}, {"t:a", "t:b"})
