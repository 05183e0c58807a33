"""Report executions of a graph that a run cannot carry out as stated."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Severity
from robbdd_tools.catalog.executors import executes
from robbdd_tools.checks.catalog_entry import CODE as CATALOG_ENTRY
from robbdd_tools.checks.catalog_entry import known_entries, not_in_catalog
from robbdd_tools.checks.execution_fit import CODE as EXECUTION_FIT
from robbdd_tools.checks.execution_fit import not_executed, not_two
from robbdd_tools.checks.external_system import CODE as EXTERNAL_SYSTEM
from robbdd_tools.checks.external_system import system_fault
from robbdd_tools.checks.model_file import CODE as MODEL_FILE
from robbdd_tools.checks.model_file import missing_file
from robbdd_tools.checks.not_simulated import CODE as NOT_SIMULATED
from robbdd_tools.checks.not_simulated import WITHOUT_MESSAGES, WITHOUT_TOPIC, without_action
from robbdd_tools.checks.python_source import CODE as PYTHON_SOURCE
from robbdd_tools.checks.python_source import missing
from robbdd_tools.graph.acceptance_model import behaviour_clauses

if TYPE_CHECKING:
    from robbdd_tools.catalog.executable import Implementation
    from robbdd_tools.checks.graph_site import GraphSite
    from robbdd_tools.graph.acceptance_model import Execution
    from robbdd_tools.monitor.policy import Policy


def execution_findings(site: GraphSite) -> Iterator[Diagnostic]:
    """Report implementations, policies and models that cannot be used in a simulation on this machine."""
    for execution in site.model.executions:
        yield from _implementation(site, execution)
        for policy in execution.policies:
            yield from _policy(site, policy)
    for instance in site.instances:
        for source in instance.sources:
            match source.kind:
                case "python":
                    yield from _python(site, source.iri, source.name)
                case "catalog":
                    yield from _entry(site, source.iri, source.name, "scenex")
                case "file":
                    folder = site.folder(source.iri)
                    problem = None if folder is None else missing_file(folder, source.name)
                    if problem is not None:
                        yield site.finding(source.iri, MODEL_FILE, problem)
                case _:
                    pass


def _implementation(site: GraphSite, execution: Execution) -> Iterator[Diagnostic]:
    one = execution.implementation
    match one.kind:
        case "ros-action":
            name = site.local_name(one.iri).rpartition("/")[2]
            message = f"a simulation has no ROS action: {without_action(name)}"
            yield site.finding(one.iri, NOT_SIMULATED, message, Severity.INFORMATION)
        case "python":
            yield from _python(site, one.iri, one.name)
        case "process" | "endpoint":
            problem = system_fault(one.kind, one.name)
            if problem:
                yield site.finding(one.iri, EXTERNAL_SYSTEM, problem)
        case _:
            found = list(_entry(site, one.iri, one.name, "bddx"))
            yield from found or _misfit(site, execution, one)


def _misfit(site: GraphSite, execution: Execution, implementation: Implementation) -> Iterator[Diagnostic]:
    variant = next((one for one in site.variants if one.iri == execution.variant), None)
    if variant is None:
        return
    clauses = behaviour_clauses((*variant.template.clauses, *variant.clauses))
    wanted = [
        word for word in dict.fromkeys(one.behaviour for one in clauses) if not executes(implementation.name, word)
    ]
    if wanted:
        yield site.finding(execution.iri, EXECUTION_FIT, not_executed(implementation.name, wanted))


def _policy(site: GraphSite, policy: Policy) -> Iterator[Diagnostic]:
    rule = policy.rule
    if rule.kind == "topic":
        message = f"a simulation has no ROS topic: {WITHOUT_TOPIC}"
        yield site.finding(policy.iri, NOT_SIMULATED, message, Severity.INFORMATION)
        return
    for provider in (one.provider for one in policy.observations if one.provider.kind != "ground-truth"):
        message = f"a simulation has no ROS messages: {WITHOUT_MESSAGES}"
        yield site.finding(provider.iri, NOT_SIMULATED, message, Severity.INFORMATION)
    if rule.kind == "python":
        yield from _python(site, policy.iri, rule.name)
    elif (observed := sum(len(one.targets) for one in policy.observations)) != 2:
        yield site.finding(policy.iri, EXECUTION_FIT, not_two(observed))


def _python(site: GraphSite, node: str, name: str) -> Iterator[Diagnostic]:
    folder = site.folder(node)
    module, _, attribute = name.partition(":")
    problem = None if folder is None or not folder.is_dir() else missing(module, attribute, folder)
    if problem is not None:
        yield site.finding(node, PYTHON_SOURCE, problem.message)


def _entry(site: GraphSite, node: str, name: str, language: str) -> Iterator[Diagnostic]:
    known = known_entries(language)
    if name not in known:
        what = "behaviour" if language == "bddx" else "model"
        message, _ = not_in_catalog(what, name, known)
        yield site.finding(node, CATALOG_ENTRY, message, Severity.ERROR)
