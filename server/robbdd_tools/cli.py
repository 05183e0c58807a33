"""Command line: arguments of each ``robbdd`` command, and exit codes.

Exit codes: 0 success; 1 errors found (check) or a clause violated or unknown (run); 2 the command could not do its
work; 128 + n ended by signal n (130 Ctrl-C, 143 SIGTERM, 129 SIGHUP).
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from robbdd_tools import __version__
from robbdd_tools.base.external_systems import ENDPOINT_HOSTS
from robbdd_tools.base.isolation import NO_USER_CODE
from robbdd_tools.base.memory import collect_rarely
from robbdd_tools.base.printable import printable
from robbdd_tools.base.processes import end_requests
from robbdd_tools.catalog.registry import problems_of_words
from robbdd_tools.commands import FAILED, OK, signal_code
from robbdd_tools.commands.arguments import allow_selection, seed, wanted
from robbdd_tools.commands.commands_of_runs import add_commands_of_runs
from robbdd_tools.commands.cut_arguments import add_cut
from robbdd_tools.commands.evidence_arguments import add_evidence
from robbdd_tools.commands.falsify_arguments import add_falsify
from robbdd_tools.commands.lost_output import output_may_be_lost
from robbdd_tools.commands.mutate_arguments import add_mutate
from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.commands.replaced_options import allow_replaced
from robbdd_tools.commands.run_arguments import (
    allow_run,
    allow_scenex,
    argument_problem,
    port,
    resume_options,
    run_options,
)
from robbdd_tools.commands.study_arguments import add_study

MORE = "further parts of a model that is a graph (.ttl, .json, .jsonld)"
SHELLS = ("bash", "zsh", "tcsh")
FORMATS = ("ttl", "json-ld", "json-ld-expanded", "nt", "xml")


class _Ended(BaseException):
    """A signal ends the command after its clean-up; ``number`` is the signal's."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def _end(number: int) -> None:
    raise _Ended(number)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code; a broken pipe and signals end it without a traceback."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(encoding="utf-8", errors="replace")
    options = argument_parser().parse_args(arguments)
    collect_rarely()
    if getattr(options, "no_user_code", False):
        os.environ[NO_USER_CODE] = "1"
    if getattr(options, "allow_host", None):
        os.environ[ENDPOINT_HOSTS] = ",".join(options.allow_host)
    command: Callable[[argparse.Namespace], int] = options.command
    try:
        with end_requests(_end):
            code = _fetch_contexts(options) or command(options)
            for problem in problems_of_words():
                print_note(f"robbdd: {problem}")
            return code
    except _Ended as error:
        return signal_code(error.number)
    except BrokenPipeError:
        sys.stderr.close()
        return FAILED


class _Parser(argparse.ArgumentParser):
    """Argument parser whose error messages are escaped for the terminal."""

    def error(self, message: str) -> NoReturn:
        """Print the error and exit."""
        super().error(printable(message))


def argument_parser() -> argparse.ArgumentParser:
    """Return the parser of the arguments of all commands."""
    parser = _Parser("robbdd", description="Acceptance tests of robots, from models to verdicts.")
    parser.add_argument("--version", action="version", version=f"robbdd {__version__}")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")

    check = commands.add_parser("check", help="report errors and warnings in models")
    check.add_argument("paths", nargs="+", metavar="FILE|DIR", type=Path)
    check.add_argument("--json", action="store_true", help="one JSON object per diagnostic and line")
    check.set_defaults(command=_check)

    layout = commands.add_parser("format", help="rewrite models in canonical layout")
    layout.add_argument("paths", nargs="+", metavar="FILE|DIR", type=Path)
    layout.add_argument(
        "--check", action="store_true", help="only name the files that would change; exit code 1 if any"
    )
    layout.set_defaults(command=_format)

    graph = commands.add_parser("graph", help="print the knowledge graph of a model and its imports")
    graph.add_argument("path", metavar="FILE", type=Path)
    graph.add_argument("more", metavar="FILE", type=Path, nargs="*", help=MORE)
    graph.add_argument("--format", choices=(*FORMATS, "svg"), default="ttl", help="svg is a picture of its structure")
    _take_results(graph)
    graph.set_defaults(command=_graph)

    gherkin = commands.add_parser("gherkin", help="write a folder of features that behave runs")
    gherkin.add_argument("path", metavar="FILE", type=Path)
    gherkin.add_argument("more", metavar="FILE", type=Path, nargs="*", help=MORE)
    gherkin.add_argument("-o", "--output", metavar="DIR", type=Path, required=True)
    gherkin.add_argument(
        "--template", metavar="NAME|FILE", default="default", help="default, compact, de or your own file"
    )
    gherkin.add_argument(
        "--expand", action="store_true", help="write the definitions of named predicates in place of their phrases"
    )
    gherkin.add_argument("--seed", type=seed, default=None, help="seed of samples and runs (default: 1)")
    allow_selection(gherkin)
    gherkin.set_defaults(command=_gherkin)

    steps = commands.add_parser("steps", help="write a skeleton of step functions for another robot or simulator")
    steps.add_argument("path", metavar="FILE", type=Path)
    steps.add_argument("-o", "--output", metavar="STEPS.py", type=Path, help="add missing steps to this file")
    steps.add_argument(
        "--undefined", action="store_true", help="only steps of free-text clauses, which nothing else can judge"
    )
    steps.set_defaults(command=_steps)

    run = commands.add_parser("run", help="execute the scenarios of models in simulation and judge every clause")
    text = "a model, or a folder whose models are all run"
    run.add_argument("path", metavar="FILE|DIR", type=Path, nargs="?", help=text)
    run.add_argument(
        "more", metavar="FILE|DIR", type=Path, nargs="*", help="more models; all graph files are one model"
    )
    allow_run(run)
    run.set_defaults(command=_run)

    stored = add_commands_of_runs(commands)
    studies = add_study(commands.add_parser("study", help="execute the combinations of a .study file many times"))

    add_evidence(commands.add_parser("evidence", help="write the evidence of a run as one file; check such a file"))
    mutated = commands.add_parser("mutate", help="give the simulated robots faults, and show which clauses notice them")
    add_mutate(mutated)
    searched = commands.add_parser("falsify", help="search the ranges of a .study file for a failure near to nominal")
    add_falsify(searched)

    view = commands.add_parser("view", help="render the initial scene of a scenario with its workspaces labelled")
    view.add_argument("path", metavar="FILE", nargs="?", type=Path)
    text = "show this arm alone, and what was found in its MJCF or URDF file; or an arm of the catalog"
    view.add_argument("--robot", metavar="ARM", help=text)
    view.add_argument("--gripper", type=Path, metavar="FILE", help="file of a gripper to fix to the arm; needs --on")
    view.add_argument("--on", metavar="NAME", help="body or site of the arm's file that carries the gripper")
    view.add_argument("--scenario", metavar="NAME", help="this scenario or variant (default: the first)")
    view.add_argument("--seed", type=seed, default=None, help="seed of all random choices (default: 1)")
    allow_scenex(view)
    view.add_argument("-o", "--output", metavar="FILE.png", type=Path, help="default: the model's name with .png")
    view.set_defaults(command=_view)

    imported = commands.add_parser("import", help="write a graph (.ttl, .json, .jsonld) as RobBDD text")
    imported.add_argument("path", metavar="FILE", type=Path)
    imported.add_argument("more", metavar="FILE", type=Path, nargs="*", help=MORE)
    imported.add_argument("-o", "--output", metavar="MODEL.bdd", type=Path, required=True)
    imported.add_argument("--force", action="store_true", help="replace existing files")
    imported.set_defaults(command=_import)
    query = commands.add_parser("query", help="query the knowledge graph of a model with SPARQL")
    query.add_argument("path", metavar="FILE", type=Path)
    query.add_argument("query", metavar="QUERY", nargs="?", help="SELECT, ASK, CONSTRUCT or DESCRIBE")
    query.add_argument("-f", "--file", metavar="QUERY.rq", type=Path, help="read the query from this file")
    query.add_argument("--name", metavar="NAME", help="a built-in query; without any query, these are listed")
    query.add_argument("--format", choices=("table", "csv", "json", "ttl", "json-ld"), default="table")
    _take_results(query)
    query.set_defaults(command=_query)
    new = commands.add_parser("new", help="create a project from a template")
    new.add_argument(
        "path", metavar="DIR", nargs="?", type=Path, help="its folder; without it the templates are listed"
    )
    new.add_argument("--template", metavar="NAME", default="pickplace", help="default: pickplace")
    new.set_defaults(command=_new)
    add_cut(commands.add_parser("cut", help="cut hollow meshes into convex pieces, with which they collide"))
    doctor = commands.add_parser("doctor", help="test each part of the installation, and say how to fix it")
    doctor.add_argument("path", metavar="FILE|DIR", nargs="?", type=Path, default=Path(), help="whose store to test")
    doctor.add_argument("--json", action="store_true", help="print one JSON object")
    doctor.set_defaults(command=_doctor)
    dap = commands.add_parser("dap", help="serve an editor's debugger: pause executions at clauses")
    text = "wait for one editor on this port of 127.0.0.1 instead of standard input and output"
    dap.add_argument("--port", metavar="PORT", type=port, help=text)
    dap.set_defaults(command=_dap)
    completion = commands.add_parser("completion", help="print a script that completes robbdd's arguments in a shell")
    completion.add_argument("shell", choices=SHELLS)
    completion.set_defaults(command=_completion)
    _allow_refusal(run, *stored, *studies, mutated, searched, view, dap)
    _allow_hosts(check, graph, gherkin, run, mutated, imported, query)
    allow_replaced(parser)
    return parser


def _take_results(parser: argparse.ArgumentParser) -> None:
    text = "include the results of a run: its JSON, or the number of a stored run (default: the latest)"
    parser.add_argument("--results", metavar="RESULT.json|RUN", nargs="?", const="latest", help=text)


def _allow_refusal(*parsers: argparse.ArgumentParser) -> None:
    for parser in parsers:
        text = "refuse to execute users' Python code: steps, behaviours, evaluators, models"
        parser.add_argument("--no-user-code", action="store_true", help=text)


def _allow_hosts(*parsers: argparse.ArgumentParser) -> None:
    for parser in parsers:
        text = "fetch JSON-LD contexts from this host, and connect to its endpoints; may be repeated "
        text += "(always: context-hosts and endpoint-hosts in your settings)"
        parser.add_argument("--allow-host", metavar="HOST", action="append", help=text)


def _fetch_contexts(options: argparse.Namespace) -> int:
    if "allow_host" not in options:
        return OK
    from robbdd_tools.commands.models import fetch_contexts

    paths = getattr(options, "paths", None) or [options.path or Path(), *getattr(options, "more", ())]
    failure = fetch_contexts(paths, options.allow_host or ())
    if failure is None:
        return OK
    print_note(failure)
    return FAILED


def _check(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.check import check

    return check(options.paths, as_json=options.json)


def _format(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.layout import format_models

    return format_models(options.paths, options.check)


def _graph(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.export import print_graph

    return print_graph(options.path, options.more, options.format, options.results)


def _gherkin(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.gherkin import GherkinOptions, write_gherkin

    chosen = GherkinOptions(
        options.path, options.more, options.output, options.template, wanted(options), options.expand
    )
    return write_gherkin(chosen)


def _steps(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.steps import write_steps

    return write_steps(options.path, options.output, undefined=options.undefined)


def _run(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.resume import resume
    from robbdd_tools.commands.run import run

    problem = argument_problem(options)
    if problem:
        return fail(problem)
    with output_may_be_lost():
        if options.resume is not None:
            return resume(resume_options(options))
        return run(run_options(options))


def _new(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.new import list_templates, new_project

    return list_templates() if options.path is None else new_project(options.path, options.template)


def _doctor(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.doctor import doctor

    return doctor(options.path, as_json=options.json)


def _dap(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.dap import serve_debugger

    return serve_debugger(options.port)


def _completion(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.shell_completion import print_completion

    return print_completion(argument_parser(), options.shell)


def _import(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.import_model import import_model

    return import_model(options.path, options.output, more=options.more, overwrite=options.force)


def _view(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.view import view, view_robot

    if options.robot is not None:
        return view_robot(options.robot, options.output, options.gripper, options.on)
    if options.gripper is not None or options.on is not None:
        return fail("--gripper and --on need an arm: --robot ARM")
    if options.path is None:
        return fail("name a model (FILE) or an arm (--robot ARM)")
    return view(options.path, options.scenario, options.seed, options.output, options.scenex or ())


def _query(options: argparse.Namespace) -> int:
    from robbdd_tools.commands.query import query

    text, results = options.query, options.results
    if text is None and options.file is None and options.name is None and results is not None and "{" in results:
        # argparse takes a query directly after --results for its value; no run has such a name.
        text, results = results, "latest"
    return query(options.path, text, options.file, options.name, options.format, results)


if __name__ == "__main__":
    sys.exit(main())
