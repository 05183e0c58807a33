"""Load the models that a command names, and print their errors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.files import path_to_uri, read_text
from robbdd_tools.base.graph_formats import graph_format
from robbdd_tools.base.user_settings import user_file
from robbdd_tools.commands.output import fail, print_note
from robbdd_tools.names.project import Project
from robbdd_tools.workbench.diagnostics import Finding, findings
from robbdd_tools.workbench.model import ModelFile, load
from robbdd_tools.workbench.named_files import NotAModel

HOSTS = "context-hosts"
HOSTS_FORM = 'a list of host names, such as ["example.org"]'


def valid_model(path: Path, more: Sequence[Path] = ()) -> ModelFile | None:
    """Load one model for a command that requires it to be free of errors.

    If the model has errors, they are printed and ``None`` is returned. ``more`` are further graph files that belong to
    the model.
    """
    if path.is_dir():
        fail(f"{path} is a folder; name a file in it")
        return None
    try:
        model = load(path, *more)
    except NotAModel as error:
        fail(str(error))
        return None
    if len(model.files) > 1:
        fail("several files are one model only if they are graphs (.ttl, .json, .jsonld); name one model")
        return None
    errors = [finding for finding in model.diagnostics if finding.is_error]
    print_findings(errors, print_note)
    return None if errors else model.files[0]


def print_findings(found: Iterable[Finding], print_: Callable[[str], None]) -> None:
    """Print each finding as ``file:line:column: severity: message [code]``, followed by its related places."""
    for finding in found:
        print_(str(finding))
        for related in finding.related:
            print_(f"    {related.place}: {related.message}")


def fetch_contexts(paths: Iterable[Path], hosts: Iterable[str]) -> str | None:
    """Fetch the JSON-LD contexts of models; return an error message if a fetch fails.

    Only hosts that the user allows are contacted: ``hosts``, and the setting ``context-hosts`` in the user's own
    configuration. If the model's project contains this setting, it is reported as ignored. Fetched contexts are cached,
    so that later reads need no network.
    """
    allowed = frozenset(hosts)
    for path in paths:
        if graph_format(path.name) == "json-ld":
            failure = _fetch(path, allowed)
            if failure is not None:
                return failure
    return None


def _fetch(path: Path, hosts: frozenset[str]) -> str | None:
    from robbdd_tools.graph.project_settings import nearest_setting, user_setting
    from robbdd_tools.graph.rdf.contexts import ContextLoader
    from robbdd_tools.graph.rdf.serialize import UnreadableGraph, parse

    setting = user_setting(HOSTS, HOSTS_FORM)
    for fault in setting.faults if setting else ():
        return _described(fault, Severity.ERROR)
    allowed = hosts.union(setting.values if setting else ())
    stated = nearest_setting(path_to_uri(path), HOSTS, HOSTS_FORM)
    if stated is not None and not allowed.issuperset(stated.values):
        ignored = stated.fault(
            f"'{HOSTS}' is ignored here, as a folder cannot permit itself to use the network: "
            f"give '--allow-host HOST', or write the setting into {user_file()}"
        )
        print_note(_described(ignored, Severity.WARNING))
    text = read_text(path)
    if not allowed or not isinstance(text, str):
        return None
    try:
        parse(text, "json-ld", path_to_uri(path), ContextLoader(allowed))
    except UnreadableGraph as error:
        return f"robbdd: {path}: {error}"
    return None


def _described(fault: Diagnostic, severity: Severity) -> str:
    return str(findings(Project().snapshot(), [replace(fault, severity=severity)])[0])
