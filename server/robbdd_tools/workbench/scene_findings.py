"""Findings about models and given poses of scene instances. The simulated world is set up to find them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.base.interpreter import run_for
from robbdd_tools.base.limits import SCENE_SECONDS
from robbdd_tools.base.model_includes import model_files
from robbdd_tools.base.plain import from_plain
from robbdd_tools.base.processes import describe_exit
from robbdd_tools.base.source_texts import source_state, source_xml, unsaved_source
from robbdd_tools.checks.model_name import CODE as MODEL_NAME
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.protocol.scene_faults import FaultKind, SceneFault
from robbdd_tools.syntax import tree
from robbdd_tools.workbench.first_pose import first_pose
from robbdd_tools.workbench.model_entries import entry_span

if TYPE_CHECKING:
    from robbdd_tools.base.files import FileState
    from robbdd_tools.catalog.executable import ModelSource, SceneInstance
    from robbdd_tools.names.project import Snapshot

FIND = "robbdd_tools.agent.find_faults"
KNOWN = {FaultKind.MODEL: {"model-file", MODEL_NAME, "catalog-entry"}, FaultKind.POSE: {"pose", "distribution"}}
"""Kind of fault → codes of the rules that report it at a better place. Such faults are not reported again."""
_QUOTES = "\"'"
_TOKEN = re.compile(r"<[^>\n]*>|[\w.-]+|.")


class SceneChecker:
    """Finds faults of scene instances. An instance is examined again only if it or its files have changed."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[str, tuple[SceneFault, ...] | str]] = {}

    def findings(self, snapshot: Snapshot, uri: str) -> list[Diagnostic]:
        """Return the findings about the scene instances that a ``.scenex`` file declares.

        A file with errors is not examined.
        """
        if not declares_instance(snapshot, uri):
            return []
        rules = [one for other in snapshot.closure(uri) for one in fast_diagnostics(snapshot, other.document.uri)]
        if any(one.severity is Severity.ERROR for one in rules):
            return []
        own = instances_of(snapshot, uri)
        found = self._faults(uri, request_for(own), own)
        if isinstance(found, str):
            message = f"the models and poses of this scene were not checked: {found}"
            return [Diagnostic(uri, Span(0, 0), Severity.WARNING, "scene-unchecked", message)]
        reported = [one for one in rules if one.uri == uri]
        text = snapshot.document(uri).text
        return [_diagnostic(snapshot, uri, one) for one in found if not _is_reported(one, reported, text)]

    def _faults(self, uri: str, request: str, instances: list[SceneInstance]) -> tuple[SceneFault, ...] | str:
        state = request + repr(list(file_states(instances)))
        known = self._known.get(uri)
        if known is None or known[0] != state:
            known = self._known[uri] = (state, _examined(request))
        return known[1]


def _is_reported(fault: SceneFault, findings: list[Diagnostic], text: str) -> bool:
    """Return whether one of the findings in a file's text reports a fault at a better place.

    A wrong name explains only faults that are about this name.
    """
    codes = KNOWN.get(FaultKind(fault.kind), set())
    reported = (one for one in findings if one.code in codes)
    return any(
        one.code != MODEL_NAME or f"'{text[one.span.start : one.span.end].strip(_QUOTES)}'" in fault.reason
        for one in reported
    )


def declares_instance(snapshot: Snapshot, uri: str) -> bool:
    """Return whether a file declares an executable scene."""
    file = snapshot.file(uri)
    declared = [] if file is None else [placed.declaration.tree for placed in file.declarations]
    return any(isinstance(one, tree.SceneInstance) for one in declared)


def instances_of(snapshot: Snapshot, uri: str) -> list[SceneInstance]:
    """Return the scene instances that a file without errors declares."""
    from robbdd_tools.graph.places import placed_instances
    from robbdd_tools.graph.write.build import build_graph

    every = placed_instances(build_graph(snapshot, uri), snapshot)
    return [one for one in every if one.origin is not None and path_to_uri(Path(one.origin.file)) == uri]


def request_for(instances: list[SceneInstance]) -> str:
    """Return the request for a process that sets up scene instances, with the unsaved texts of their files."""
    texts = {str(path): text for path in _all_files(instances) if (text := unsaved_source(path)) is not None}
    return json.dumps({"instances": [asdict(_with_short_names(one)) for one in instances], "sources": texts})


def _with_short_names(instance: SceneInstance) -> SceneInstance:
    """Return an instance whose elements have local names, as in the text, if these names are unambiguous."""
    local = [one.element.replace("#", "/").rpartition("/")[2] for one in instance.elements]
    short = {one.element: name for one, name in zip(instance.elements, local, strict=True) if local.count(name) == 1}

    def named(element: str) -> str:
        return short.get(element, element)

    elements = (replace(one, element=named(one.element)) for one in instance.elements)
    frictions = (replace(one, first=named(one.first), second=named(one.second)) for one in instance.frictions)
    return replace(instance, elements=tuple(elements), frictions=tuple(frictions))


def file_states(instances: list[SceneInstance]) -> Iterator[FileState | None]:
    """Yield the state of each file that the models name, as it is on disk or in an editor."""
    return map(source_state, _all_files(instances))


def _all_files(instances: list[SceneInstance]) -> Iterator[Path]:
    for instance in instances:
        yield from dict.fromkeys(path for model in instance.sources for path in _files(model))


def _files(model: ModelSource) -> Iterator[Path]:
    if model.kind == "file" and model.origin is not None:
        yield from model_files(Path(model.origin.file).parent / Path(model.name).expanduser(), source_xml)


def _examined(request: str) -> tuple[SceneFault, ...] | str:
    """Return the faults of a request's instances, or the reason as text if they could not be examined."""
    answer = answer_of(FIND, request)
    return answer if isinstance(answer, str) else tuple(from_plain(SceneFault, one) for one in answer)


def answer_of(module: str, request: str) -> list[object] | str:
    """Return the answer of a process that sets up scene instances, or a text if it failed or took too long."""
    seconds = SCENE_SECONDS.value()
    try:
        ending = run_for(seconds, module, sent=request)
    except OSError as error:
        return str(error)
    if ending.code is None:
        return f"it took longer than {seconds} seconds (the limit {SCENE_SECONDS.name})"
    if ending.code:
        return (ending.errors.strip().splitlines() or [f"the process ended with {describe_exit(ending.code)}"])[-1]
    return json.loads(ending.output)


def _diagnostic(snapshot: Snapshot, uri: str, fault: SceneFault) -> Diagnostic:
    match FaultKind(fault.kind):
        case FaultKind.OVERLAP:
            code = "overlap"
        case FaultKind.POSE:
            code = "pose"
        case FaultKind.MODEL:
            code = "unusable-model"
    if fault.origin is None:
        return Diagnostic(uri, Span(0, 0), Severity.WARNING, code, fault.reason)
    place = path_to_uri(Path(fault.origin.file))
    document = snapshot.document(place)
    start = document.line_starts[fault.origin.line - 1] + fault.origin.column - 1
    token = _TOKEN.match(document.text, start)
    entry = None if fault.entry is None else entry_span(snapshot, place, start, fault.entry)
    span = entry or Span(start, start if token is None else token.end())
    fixes = tuple(first_pose(snapshot, place, start)) if code == "pose" else ()
    return Diagnostic(place, span, Severity.WARNING, code, fault.reason, fixes=fixes)
