"""``python -m tests.bench.step_size [RUNS]``: how many verdicts change when the physics step is halved.

Each run is executed twice from the same seed, with the step of the product and with half of it; the control tick
stays. The figures are for ``docs/simulation.md``.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

sys.path.insert(0, str(Path(__file__).parent.parent))

from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.protocol.specs import ConfigSpec
from robbdd_tools.world import composition, simulation
from robbdd_tools.world.engine import SUBSTEPS, TIMESTEP
from world.worlds import BALL, BIN, BIN_WS, CUBE, EVENTS, OTHER_BIN, OTHER_WS, SCENE, execution, pick_place

AGENTS = ("env:panda", "env:ur10")
THINGS = (CUBE, BALL)
GOALS = (BIN_WS, OTHER_WS)
SCALES = ("0.8", "0.9", "1.0")
CLAUSES = {
    "held by": '"{thing}" is held by "{agent}" from "t:pick-end" until "t:place-start"',
    "located at": '"{thing}" is located at "{goal}" after event "t:place-end"',
    "does not collide": '"{agent}" does not collide "{goal}" from "t:pick-start" until "t:place-end"',
    "does not drop": '"{agent}" does not drop "{thing}" from "t:pick-start" until "t:end"',
}


def verdicts(seed: int, refinement: int) -> Iterator[tuple[str, str, str]]:
    """Yield robot, clause and verdict of one run with the step divided by ``refinement``."""
    agent = AGENTS[seed % 2]
    thing, goal, scale = THINGS[seed // 2 % 2], GOALS[seed // 4 % 2], SCALES[seed // 8 % 3]
    config = tuple(ConfigSpec(name, "height_scale", scale) for name in (BIN, OTHER_BIN))
    scene = replace(SCENE, agents=(agent,), config=config)
    with (
        patch.object(composition, "TIMESTEP", TIMESTEP / refinement),
        patch.object(simulation, "SUBSTEPS", SUBSTEPS * refinement),
    ):
        run = execution([pick_place(thing, goal, agent)], scene, seed)
        trace = run.advance_until(lambda _: False)
    events = EVENTS.keys()
    for name, sentence in CLAUSES.items():
        clause = read_clause(sentence.format(thing=thing, agent=agent, goal=goal))
        yield agent, name, str(decide(clause, trace, run.regions, events).outcome)


def main(runs: int) -> None:
    """Print, per robot and clause, how many verdicts changed."""
    changed: Counter[tuple[str, str]] = Counter()
    coarse: Counter[tuple[str, str, str]] = Counter()
    fine: Counter[tuple[str, str, str]] = Counter()
    for seed in range(runs):
        for one, two in zip(verdicts(seed, 1), verdicts(seed, 2), strict=True):
            coarse[one] += 1
            fine[two] += 1
            if one != two:
                changed[one[:2]] += 1
                print(f"seed {seed}: {one[0]} {one[1]}: {one[2]} became {two[2]}", flush=True)
    for agent in AGENTS:
        for name in CLAUSES:
            counts = " / ".join(
                f"{coarse[agent, name, outcome]} {fine[agent, name, outcome]}"
                for outcome in ("holds", "violated", "unknown")
            )
            print(f"{agent} {name}: changed {changed[agent, name]}; holds / violated / unknown: {counts}")
    total = runs * len(CLAUSES)
    print(f"{sum(changed.values())} of {total} verdicts changed ({100 * sum(changed.values()) / total:.1f} %)")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
