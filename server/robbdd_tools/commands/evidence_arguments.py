"""The arguments of ``robbdd evidence``. Heavy modules are imported only when a command is used."""

from __future__ import annotations

import argparse
from pathlib import Path

from robbdd_tools.commands.arguments import positive
from robbdd_tools.commands.run_arguments import allow_store


def add_evidence(parser: argparse.ArgumentParser) -> None:
    """Add the commands about bundles of evidence."""
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    pack = commands.add_parser("pack", help="write texts, results and traces of a stored run or a study as one file")
    pack.add_argument(
        "run", metavar="RUN|FILE.study", help="number of a stored run, latest, a run's folder; or a study"
    )
    pack.add_argument("path", metavar="FILE|DIR", type=Path, nargs="?", default=Path(), help="in the run's project")
    pack.add_argument("-o", "--output", metavar="FILE.zip", type=Path, required=True)
    text = "leave out the traces: the bundle is small, but its verdicts cannot be judged again"
    pack.add_argument("--no-traces", action="store_true", help=text)
    allow_store(pack)
    pack.set_defaults(command=_pack)
    verify = commands.add_parser("verify", help="check a bundle without a network: files, model, verdicts, graph")
    verify.add_argument("path", metavar="FILE.zip", type=Path)
    text = "the digest that the bundle must have, as printed when it was written"
    verify.add_argument("--digest", metavar="SHA256", default="", help=text)
    verify.add_argument("--json", metavar="OUT", type=Path, help="write the result to this file")
    text = "execute users' Python code in the bundle, which evaluates clauses; without it, these are not judged again"
    verify.add_argument("--user-code", action="store_true", help=text)
    text = "of a study, execute N executions again, spread evenly, and compare their verdicts and margins"
    verify.add_argument("--replay", metavar="N", type=positive, default=0, help=text)
    verify.set_defaults(command=_verify)


def _pack(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.evidence import PackOptions, pack

    traces = not options.no_traces
    return pack(PackOptions(options.run, options.path, options.output, options.store, traces))


def _verify(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.evidence import verify

    return verify(options.path, options.digest, options.json, user_code=options.user_code, replays=options.replay)
