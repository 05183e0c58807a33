"""Map the errors of users' code in the last runs to the places in models that refer to that code."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.files import load_bytes
from robbdd_tools.features.executions import executions_of
from robbdd_tools.features.run_verdicts import digests_of
from robbdd_tools.names.variant_places import variants_of

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.features.executions import PlacedExecution
    from robbdd_tools.features.run_verdicts import JudgedScenario
    from robbdd_tools.monitor.fault import Fault
    from robbdd_tools.names.project import Snapshot

CODE = "user-code-error"


@dataclass(frozen=True, slots=True)
class UserError:
    """One error in users' code, and the scenarios that are unknown because of it."""

    fault: Fault
    scenarios: tuple[JudgedScenario, ...]

    @property
    def words(self) -> str:
        """A summary of the error in one line."""
        place = self.fault.place
        where = "" if place is None else f" ({Path(place.file).name}:{place.line})"
        return f"{self.fault.code} failed: {self.fault.summary}{where}"


def user_errors(snapshot: Snapshot, scenarios: Iterable[JudgedScenario]) -> list[UserError]:
    """Return the distinct errors that still apply to the current text and code.

    The errors of a scenario are dropped if its text or the file of the code has changed since the scenario was
    executed.
    """
    broken = [scenario for scenario in scenarios if scenario.faults]
    found: dict[str, tuple[Fault, list[JudgedScenario]]] = {}
    digests = {model: digests_of(snapshot, model) for model in {one.model for one in broken} if snapshot.file(model)}
    sources: dict[str, str] = {}
    for scenario in broken:
        now = digests.get(scenario.model)
        if now is not None and (
            scenario.digest != now.variants.get(scenario.variant)
            or scenario.execution_digest != now.executions.get(scenario.execution, "")
        ):
            continue
        for fault in scenario.faults:
            if _is_unchanged(fault, sources):
                found.setdefault(fault.id, (fault, []))[1].append(scenario)
    return [UserError(fault, tuple(several)) for fault, several in found.values()]


def errors_in(snapshot: Snapshot, uri: str, errors: Sequence[UserError]) -> Iterator[tuple[Span, UserError, str]]:
    """Yield the errors to show in a model file, each with its span and message.

    An error is shown at the name of each scenario that lacks evidence because of it. In a ``.bddx``, it is shown at the
    ``bhv:`` or the declaration that names the code.
    """
    for variant in variants_of(snapshot, uri) if errors else ():
        for error in errors:
            count = sum(scenario.variant == variant.iri for scenario in error.scenarios)
            if count:
                spoilt = "1 scenario has" if count == 1 else f"{count} scenarios have"
                yield variant.definition.span, error, f"{spoilt} no result: {error.words}"
    executions = {one.iri: one for one in executions_of(snapshot, uri)} if errors else {}
    for error in errors:
        for span in dict.fromkeys(_origins(snapshot, uri, error, executions)):
            yield span, error, error.words


def _origins(
    snapshot: Snapshot, uri: str, error: UserError, executions: Mapping[str, PlacedExecution]
) -> Iterator[Span]:
    """Yield the places where a file names the code.

    The places are the ``bhv:`` of executions or, if there is none, the declaration of the name.
    """
    origin = error.fault.origin
    named = False
    for iri in dict.fromkeys(scenario.execution for scenario in error.scenarios):
        execution = executions.get(iri)
        target = None if execution is None else execution.site.target(execution.node.behaviour)
        if execution is not None and target is not None and target.iri == origin:
            named = True
            yield execution.site.span(execution.node.behaviour)
    file = snapshot.file(uri)
    if origin and not named and file is not None:
        yield from (definition.span for definition in file.definitions.values() if definition.iri == origin)


def _is_unchanged(fault: Fault, known: dict[str, str]) -> bool:
    """Return whether the file of a fault is unchanged. ``known`` caches the digests of files."""
    place = fault.place
    if place is None:
        return True
    if place.file not in known:
        try:
            known[place.file] = hashlib.sha256(load_bytes(Path(place.file))).hexdigest()
        except OSError:
            known[place.file] = ""
    return known[place.file] == fault.digest
