"""``python -m tests.mutants``: how many faults, planted at random, the tests of each room notice.

Every survivor is listed with its place and its change. The exit code is 1 when a room is below the target.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Sequence

from tests.mutants.rooms import ROOMS
from tests.mutants.session import Mutant, Session, SessionFailed, sample

TARGET = 0.9
"""The share of mutants that each room's own tests have to kill."""


def main(arguments: Sequence[str]) -> int:
    """Execute the command; return the exit code."""
    parser = argparse.ArgumentParser("python -m tests.mutants", description=__doc__)
    parser.add_argument("--sample", metavar="N", type=int, help="this many random mutants of each room (default: all)")
    parser.add_argument("--seed", metavar="N", type=int, default=1, help="chooses the sample (default: 1)")
    parser.add_argument("--only", metavar="ROOM,…", default=",".join(ROOMS), help=f"of {', '.join(ROOMS)}")
    parser.add_argument("--seconds", type=float, default=20.0, help="time limit of a mutant, beyond that of its tests")
    options = parser.parse_args(arguments)
    rooms = options.only.split(",")
    unknown = set(rooms) - set(ROOMS)
    if unknown:
        parser.error(f"no room '{unknown.pop()}': choose from {', '.join(ROOMS)}")
    table = [f"{'room':10} {'mutants':>8} {'tested':>7} {'killed':>7} {'timeout':>8} {'survived':>9} {'rate':>6}"]
    reached = True
    for name in rooms:
        session = Session(ROOMS[name], options.seconds)
        try:
            names = session.mutants()
            results = session.run(sample(names, options.sample, options.seed))
        except SessionFailed as error:
            print(error, file=sys.stderr)
            return 2
        survivors = {mutant.name: mutant.status for mutant in results if not mutant.is_killed}
        for mutant, diff in session.diffs(list(survivors)).items():
            print(f"{session.place(mutant, diff)} {survivors[mutant]} ({mutant})\n{diff}\n", flush=True)
        table.append(_row(name, len(names), results))
        reached = reached and _rate(results) >= TARGET
    print(f"seed {options.seed}\n" + "\n".join(table))
    return 0 if reached else 1


def _rate(results: Sequence[Mutant]) -> float:
    return sum(mutant.is_killed for mutant in results) / max(1, len(results))


def _row(room: str, mutants: int, results: Sequence[Mutant]) -> str:
    count = Counter("survived" if not mutant.is_killed else mutant.status for mutant in results)
    killed = count["killed"] + count["segfault"]
    numbers = f"{killed:7} {count['timeout']:8} {count['survived']:9} {_rate(results):6.0%}"
    return f"{room:10} {mutants:8} {len(results):7} {numbers}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
