"""Find the users' code that a run would execute, for ``--no-user-code`` and for untrusted workspaces."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.external_systems import ENDPOINT_HOSTS, endpoint_host
from robbdd_tools.base.isolation import NO_USER_CODE, OWNER_FORBIDS, UNTRUSTED, WORKER_USER_CODE
from robbdd_tools.base.user_settings import user_file
from robbdd_tools.catalog.executable import USERS_KINDS
from robbdd_tools.graph.project_settings import user_setting
from robbdd_tools.protocol.run_folder import OWN_STEPS

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import SceneInstance
    from robbdd_tools.protocol.specs import ExecutionSpec, Manifest, ScenarioSpec

_FIX = "leave out --no-user-code if you trust this code, or run scenarios without it"
_FIXES = {
    UNTRUSTED: "trust the workspace if you trust this code",
    OWNER_FORBIDS: f"its owner allows users' code by starting it with {WORKER_USER_CODE}=allow",
}


HOSTS = "endpoint-hosts"
HOSTS_FORM = 'a list of host names, such as ["localhost"]'


class UserCodeRefused(RobbddError):
    """A run would execute users' code, which ``--no-user-code`` forbids. The message names each place."""


def refuse_user_code(manifest: Manifest, folder: Path, *, judges: bool = True, simulates: bool = True) -> None:
    """Raise ``UserCodeRefused`` if ``refusal`` returns a message."""
    problem = refusal(manifest, folder, judges=judges, simulates=simulates)
    if problem:
        raise UserCodeRefused(problem)


def refusal(manifest: Manifest, folder: Path, *, judges: bool = True, simulates: bool = True) -> str:
    """Return a message that lists the users' code of a prepared run, its places, and what to do.

    The message is empty if the run has no such code or if the code may run. A run both simulates and judges. Judging
    stored traces executes evaluators only, and drawing a picture executes models only.
    """
    reason = os.environ.get(NO_USER_CODE)
    if not reason:
        return _hosts(manifest) if simulates and judges else ""
    fix = _FIXES.get(reason, _FIX)
    found = list(dict.fromkeys(_uses(manifest, folder, judges, simulates)))
    return f"{'; '.join(found)}: {fix}" if found else ""


def refuse_mappers(manifest: Manifest) -> None:
    """Raise ``UserCodeRefused`` if users' code, which may not run, maps the frames of a log to elements."""
    reason = os.environ.get(NO_USER_CODE)
    executions = [spec.execution for spec in manifest.scenarios if reason and spec.execution is not None]
    found = dict.fromkeys(
        f"{policy.origin or observation.iri}: the Python code {observation.entity_mapper} maps the frames of the log"
        for execution in executions
        for policy in execution.policies
        for observation in policy.observations
        if observation.entity_mapper
    )
    if found:
        raise UserCodeRefused(f"{'; '.join(found)}: {_FIXES.get(reason or '', _FIX)}")


def _uses(manifest: Manifest, folder: Path, judges: bool, simulates: bool) -> Iterator[str]:
    for spec in manifest.scenarios:
        if spec.instance is not None and simulates:
            yield from _models(spec.instance)
        if spec.execution is not None and judges:
            yield from _evaluators(spec.execution, spec)
        if simulates and judges:
            yield from _behaviours(spec)
    if simulates and judges:
        for file in sorted((folder / "features" / "steps").glob(OWN_STEPS)):
            source = manifest.sources.get(file.relative_to(folder).as_posix(), str(file))
            yield f"{source} contains user-defined steps"


def _models(instance: SceneInstance) -> Iterator[str]:
    for source in instance.sources:
        if source.kind == "python":
            yield f"{source.origin or instance.iri}: a model is created by the Python code {source.name}"


def _evaluators(execution: ExecutionSpec, spec: ScenarioSpec) -> Iterator[str]:
    for policy in execution.policies:
        if policy.rule.kind == "python":
            place, code = policy.origin or spec.model, policy.rule.name
            yield f"{place}: the policy {policy.iri} judges with the Python code {code}"


def _behaviours(spec: ScenarioSpec) -> Iterator[str]:
    own = None if spec.execution is None else spec.execution.implementation
    for code in (own, None if spec.tree is None else spec.tree.source):
        if code is not None and code.kind in USERS_KINDS:
            what = f"Python code {code.name}" if code.kind == "python" else f"{code.kind} '{code.name}'"
            yield f"{code.origin or spec.model}: a behaviour is the {what}"


def _hosts(manifest: Manifest) -> str:
    """Return a message about endpoints on hosts that neither the user's settings nor the command line allow."""
    used = {
        spec.execution.implementation: spec.model
        for spec in manifest.scenarios
        if spec.execution is not None and spec.execution.implementation.kind == "endpoint"
    }
    if not used:
        return ""
    setting = user_setting(HOSTS, HOSTS_FORM)
    if setting is not None and setting.faults:
        return f"{setting.file}: {setting.faults[0].message}"
    allowed = {*os.environ.get(ENDPOINT_HOSTS, "").split(","), *(setting.values if setting else ())}
    for one, model in used.items():
        host = endpoint_host(one.name)
        if host not in allowed:
            return (
                f"{one.origin or model}: a behaviour is the endpoint '{one.name}', whose host is not allowed: give "
                f'--allow-host {host}, or write {HOSTS} = ["{host}"] into {user_file()}'
            )
    return ""
