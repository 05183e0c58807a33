"""``robbdd evidence``: write the evidence of a run or a study as one file, and check such a file without a network."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

from robbdd_tools.base.printable import printable_json
from robbdd_tools.base.writing import replace_file
from robbdd_tools.campaign.evidence_bundle import write_bundle
from robbdd_tools.campaign.evidence_check import Verification, verify_bundle
from robbdd_tools.campaign.study_evidence import pack_study
from robbdd_tools.campaign.study_file import SUFFIX
from robbdd_tools.commands import CANNOT_TELL, FINDINGS, OK
from robbdd_tools.commands.output import print_line
from robbdd_tools.commands.run import Outputs, report_problems
from robbdd_tools.commands.runs import print_unfinished
from robbdd_tools.workbench.stored import find_run


@dataclass(frozen=True, slots=True)
class PackOptions:
    """The options of ``robbdd evidence pack``: the run or study, a path in its project, the bundle, and its traces."""

    run: str
    path: Path
    output: Path
    store: Path | None = None
    traces: bool = True


def pack(options: PackOptions) -> int:
    """Write the bundle of a run or a study and print its digest; return the exit code."""

    def work() -> int:
        if options.run.endswith(SUFFIX):
            written = pack_study(Path(options.run), options.store, options.output, traces=options.traces)
            print_line(f"{options.output}: {written.traces} executions, digest {written.digest}")
            return OK
        run = find_run(options.run, options.path, store=options.store)
        print_unfinished(run.place, run.status)
        bundle = write_bundle(run, options.output, traces=options.traces)
        print_line(f"{options.output}: {bundle.traces} traces, digest {bundle.digest}")
        return OK

    return report_problems(Outputs(report=options.output), viewer=False, work=work)


def verify(path: Path, digest: str, json: Path | None, *, user_code: bool, replays: int = 0) -> int:
    """Check a bundle and print what was checked. Of a study, ``replays`` executions are executed again.

    Returns 0 if everything was checked and is consistent, 1 if something in the bundle contradicts the rest, 2 if the
    file is not a bundle, 3 if nothing contradicts, but a part could not be checked.
    """

    def work() -> int:
        found = verify_bundle(path, digest=digest, user_code=user_code, replays=replays)
        _print(found)
        if json is not None:
            document = {**asdict(found), "result": _result(found)}
            replace_file(json, printable_json(document, indent=1) + "\n")
        return FINDINGS if found.contradicts else OK if found.is_complete else CANNOT_TELL

    return report_problems(Outputs(report=json), viewer=False, work=work)


def _print(found: Verification) -> None:
    print_line(f"digest {found.digest}")
    print_line(f"{found.model}, executed by RobBDD {found.robbdd} with {found.simulator or 'no simulator'}")
    print_line(f"stated: {found.holding} of {found.executions} executions hold")
    for check in found.checks:
        sign = "✗" if check.problems else "?" if check.unchecked else "✔"
        print_line(f"{sign} {check.name}{f': {check.detail}' if check.detail and not check.problems else ''}")
        for line in (*check.problems, *([check.unchecked] if check.unchecked else [])):
            print_line(f"    {line}")
    print_line(_result(found))


def _result(found: Verification) -> str:
    if found.contradicts:
        return "not valid"
    return "valid" if found.is_complete else "not contradicted, but not checked in full"
