"""``python -m tests.nightly``: soak, fuzzing, kills and versions; each finding is saved for replay.

``--minutes`` is divided among what is chosen by ``--only``. The exit code is 1 when something was found.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
KEPT = ROOT / "build" / "nightly"
"""Folder for findings, with a subfolder for each."""


def main(arguments: Sequence[str]) -> int:
    """Execute the arguments' tests; return the exit code."""
    sys.path.insert(0, str(ROOT / "tests"))
    from tests.nightly.fuzz import read_case, run_case
    from tests.nightly.targets import TARGETS

    fuzzing = [f"fuzz-{name}" for name in TARGETS]
    parts = ["soak", *fuzzing, "edits", "kills", "long-forms", "versions"]
    parser = argparse.ArgumentParser("python -m tests.nightly", description=__doc__)
    parser.add_argument("--minutes", type=float, default=60.0, help="for soak and fuzzing together (default: 60)")
    parser.add_argument("--only", metavar="PART,…", default=",".join(parts), help=f"of {', '.join(parts)}; or fuzz")
    parser.add_argument("--seed", type=int, default=int(time.time()), help="repeats a night (default: the time)")
    parser.add_argument("--replay", metavar="FINDING", type=Path, help="check the saved input of a finding again")
    options = parser.parse_args(arguments)
    if options.replay is not None:
        folder: Path = options.replay if options.replay.exists() else KEPT / options.replay
        run_case(TARGETS[folder.name.rsplit("-", 2)[0]], read_case(folder))
        print(f"{folder.name}: no fault any more")
        return 0
    wanted = [part for word in options.only.split(",") for part in (fuzzing if word == "fuzz" else [word])]
    unknown = set(wanted) - set(parts)
    if unknown:
        parser.error(f"there is no part '{unknown.pop()}': there are {', '.join(parts)}")
    return _night(wanted, options.seed, options.minutes * 60)


def _night(parts: Sequence[str], seed: int, seconds: float) -> int:
    print(f"seed {seed}", flush=True)
    timed = [part for part in parts if part == "soak" or part.startswith("fuzz-")]
    found = 0
    for part in parts:
        began = time.monotonic()
        findings, said = _run(part, seed, seconds / max(1, len(timed)))
        found += findings
        print(f"{part}: {said} ({time.monotonic() - began:.0f} s, {_counted(findings)})", flush=True)
    return 1 if found else 0


def _run(part: str, seed: int, seconds: float) -> tuple[int, str]:
    """Execute one part; return the number of faults found and a summary."""
    from tests.nightly import others
    from tests.nightly.fuzz import Finding, fuzz
    from tests.nightly.soak import judged, soak
    from tests.nightly.targets import TARGETS

    if part == "soak":
        folder = KEPT / f"soak-{seed}"
        folder.mkdir(parents=True, exist_ok=True)
        return _attempt(lambda: judged(soak(seed, seconds, folder)))
    if part.startswith("fuzz-"):
        target = TARGETS[part.removeprefix("fuzz-")]
        saved: list[Path] = []

        def report(finding: Finding) -> None:
            saved.append(finding.save(target, KEPT))
            print(f"  {saved[-1]}: {finding.said.strip().splitlines()[-1][:300]}", flush=True)

        cases = fuzz(target, seed, seconds, report)
        return len(saved), f"{cases} cases"
    long = {"edits": others.edits, "kills": others.kills, "long-forms": others.long_forms, "versions": others.versions}
    return _attempt(long[part])


def _attempt(work: Callable[[], str]) -> tuple[int, str]:
    try:
        return 0, work()
    except (AssertionError, OSError) as error:
        return 1, str(error)


def _counted(findings: int) -> str:
    return f"{findings} finding{'' if findings == 1 else 's'}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
