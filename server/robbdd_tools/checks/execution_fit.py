"""``execution-fit``: parts of an execution do not fit together, so a run leaves clauses unknown."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.catalog.executors import DEFAULT, EXECUTORS, executes
from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.finding import change, finding, listed, related_to
from robbdd_tools.monitor.durations import NO_DURATION
from robbdd_tools.names.elements import Site, story_sites
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

CODE = "execution-fit"


def execution_fit(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report behaviours that are not executed, and policies that cannot judge their clauses."""
    for placed in file.of(tree.Execution, tree.Policy):
        site = Site(snapshot, file, placed)
        if isinstance(site.tree, tree.Policy):
            yield from _duration(site, site.tree)
        match site.tree:
            case tree.Execution() as execution:
                yield from _behaviour(site, execution)
            case tree.Policy(rule=tree.Evaluation(evaluator=tree.LinearDistance()) as rule):
                yield from _distance(site, rule)
            case _:
                pass


def _behaviour(site: Site, execution: tree.Execution) -> Iterator[Diagnostic]:
    implementation = site.follow(execution.behaviour)
    if implementation is None or not isinstance(implementation.tree, tree.Implementation):
        return
    source = implementation.tree.source
    if not isinstance(source, tree.CatalogEntry) or source.name.value not in EXECUTORS:
        return
    executed = source.name.value
    wanted = [word for word in _behaviours(site, execution) if not executes(executed, word)]
    if wanted:
        message = not_executed(executed, wanted)
        related = (related_to(implementation, source, "the implementation"),)
        fix = change(implementation, f"Execute it by '{DEFAULT}'", source.name, f'"{DEFAULT}"')
        yield finding(site, execution.behaviour, Severity.WARNING, CODE, message, related, (fix,))


def not_executed(behaviour: str, wanted: list[str]) -> str:
    """Return the message on behaviours that a catalog behaviour does not execute."""
    return f"'{behaviour}' of the catalog does not execute {listed(wanted)}, so that all clauses stay unknown"


def not_two(observed: int) -> str:
    """Return the message on a distance that is not between exactly two elements."""
    return f"a distance is between two elements, but {observed} are observed"


def _behaviours(site: Site, execution: tree.Execution) -> list[str]:
    """Return the catalog words of the executed variant's behaviours."""
    variant = site.target(execution.variant)
    template = None if variant is None else _template(site.snapshot, variant)
    if template is None or template.tree is None:
        return []
    return list(dict.fromkeys(node.action.word for node in walk(template.tree) if isinstance(node, tree.BehaviourUse)))


def _template(snapshot: Snapshot, variant: Definition) -> Site | None:
    file = snapshot.file(variant.uri)
    for story in story_sites(snapshot, file, variant.span) if file is not None else ():
        for node in walk(story.tree) if story.tree is not None else ():
            if isinstance(node, tree.Variant) and story.span(node.name) == variant.span:
                return story.follow(node.template)
    return None


def _duration(site: Site, policy: tree.Policy) -> Iterator[Diagnostic]:
    clause = site.target(policy.fluent)
    owner = site.follow(policy.fluent)
    if clause is None or owner is None or owner.tree is None:
        return
    for node in walk(owner.tree):
        if not isinstance(node, tree.Fluent) or owner.span(node.name) != clause.span:
            continue
        if isinstance(node.predicate, tree.PhraseUse) and _is_duration(node.predicate.word):
            related = (related_to(owner, node.name, "the clause"),)
            yield finding(site, policy.fluent, Severity.WARNING, CODE, NO_DURATION, related)


def _is_duration(word: str) -> bool:
    predicate = load_catalog().predicates.get(word)
    return predicate is not None and predicate.duration is not None


def _distance(site: Site, rule: tree.Evaluation) -> Iterator[Diagnostic]:
    targets: list[tuple[Site, tree.Link]] = []
    for ref in rule.observations:
        observation = site.follow(ref)
        if observation is None or not isinstance(observation.tree, tree.Observation):
            return
        targets += ((observation, target) for target in observation.tree.targets)
    if len(targets) != 2:
        message = not_two(len(targets))
        related = tuple(related_to(one, target, "observed") for one, target in targets)
        yield finding(site, rule.evaluator, Severity.WARNING, CODE, message, related)
    for observation, target in targets:
        variable = observation.target(target.reference)
        if variable is not None and variable.kind is SymbolKind.SET_VARIABLE:
            message = f"a distance is between two elements, but '{target.reference.path}' is a set"
            related = (related_to(observation, target, "observed"),)
            yield finding(site, rule.evaluator, Severity.WARNING, CODE, message, related)
