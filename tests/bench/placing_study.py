"""``python -m tests.bench.placing_study [SEEDS [AGENT THING]]``: success rates of each arm, object and place.

Success means that the object is located at the goal, the goal was not collided with, the object was not dropped, and
the behaviour succeeded. Bins alternate with the seed. The figures are for ``docs/simulation.md``.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))

from robbdd_tools.judging.decisions import decide
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.protocol.specs import ConfigSpec, SceneSpec
from world.worlds import BALL, BENCH_WS, BIN, BIN_WS, CUBE, EVENTS, OTHER_BIN, OTHER_WS, SCENE, execution, pick_place

AGENTS = ("env:panda", "env:kinova", "env:ur5e", "env:ur10")
SCALES = ("0.8", "0.9", "1.0")
CARRIERS = {"env:shelf_upper_ws": "env:shelf", "env:shelf_lower_ws": "env:shelf", "env:tray_ws": "env:tray"}
THINGS = ("env:cube", "env:ball", "env:cylinder", "env:bottle")
AT = '"{thing}" is located at "{goal}" after event "t:place-end"'
CLAUSES = (
    AT,
    '"{agent}" does not collide "{goal}" from "t:pick-start" until "t:place-end"',
    '"{agent}" does not drop "{thing}" from "t:pick-start" until "t:end"',
)


@dataclass(frozen=True)
class Trial:
    """One execution: ``scale`` is that of the bins' height, empty for another goal."""

    agent: str
    thing: str
    goal: str
    scale: str
    seed: int

    def scene(self) -> SceneSpec:
        """Return the scene of the trial."""
        if self.scale:
            config = tuple(ConfigSpec(name, "height_scale", self.scale) for name in (BIN, OTHER_BIN))
            return replace(SCENE, agents=(self.agent,), config=config)
        carrier = CARRIERS[self.goal]
        workspaces = {BENCH_WS: ("env:bench",), self.goal: (carrier,)}
        objects = (self.thing, carrier, "env:bench")
        return replace(
            SCENE, agents=(self.agent,), objects=objects, workspaces=workspaces, contains={BENCH_WS: (self.goal,)}
        )


def succeeds(trial: Trial) -> tuple[bool, bool, str]:
    """Execute a trial; return whether it succeeded, whether the object is at the goal, and the problem, if any."""
    words = {"agent": trial.agent, "thing": trial.thing, "goal": trial.goal}
    run = execution([pick_place(trial.thing, trial.goal, trial.agent)], trial.scene(), trial.seed)
    trace = run.complete(run.advance_until(lambda _: False))
    outcomes = [
        decide(read_clause(sentence.format(**words)), trace, run.regions, EVENTS.keys()).outcome for sentence in CLAUSES
    ]
    return run.completed == 1 and set(outcomes) == {"holds"}, outcomes[0] == "holds", trace.remark


def trials(seeds: int) -> Iterator[Trial]:
    """Yield all trials: ``seeds`` of each arm, object and place."""
    for agent in AGENTS:
        for thing in (CUBE, BALL):
            for scale in SCALES:
                goals = (BIN_WS, OTHER_WS)
                yield from (Trial(agent, thing, goals[seed % 2], scale, seed) for seed in range(seeds))
        for goal in CARRIERS:
            for thing in THINGS:
                yield from (Trial(agent, thing, goal, "", seed) for seed in range(seeds))


def main(seeds: int, agent: str = "", thing: str = "") -> None:
    """Print the successes of each arm, object and place."""
    chosen = [one for one in trials(seeds) if one.agent.endswith(agent) and one.thing.endswith(thing)]
    well: Counter[tuple[str, str, str]] = Counter()
    there: Counter[tuple[str, str, str]] = Counter()
    total: Counter[tuple[str, str, str]] = Counter()
    with ProcessPoolExecutor() as pool:
        for trial, (good, at_goal, remark) in zip(chosen, pool.map(succeeds, chosen, chunksize=8), strict=True):
            place = (trial.agent, trial.thing, f"bin of scale {trial.scale}" if trial.scale else trial.goal)
            well[place] += good
            there[place] += at_goal
            total[place] += 1
            if remark:
                print(f"{' '.join(place)}, seed {trial.seed}: {remark}")
    for place, count in total.items():
        print(f"{' '.join(place)}: {well[place]} of {count}, at the goal in the end {there[place]}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 28, *sys.argv[2:])
