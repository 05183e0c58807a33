"""Describe names in Markdown, for hover and for resolved completions."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from itertools import islice
from typing import TYPE_CHECKING
from urllib.parse import unquote

from robbdd_tools.catalog.registry import load_catalog
from robbdd_tools.checks.behaviour_tree import links_to
from robbdd_tools.checks.counting import factors_of, scenario_count
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.features.clause_results import clause_hints
from robbdd_tools.features.describe_predicate import describe_predicate
from robbdd_tools.features.element_properties import describe_properties
from robbdd_tools.features.executions import executions_of
from robbdd_tools.features.imported_statements import describe_graph, describe_statements
from robbdd_tools.features.markdown import code, code_block, literal
from robbdd_tools.features.pass_rates import execution_rate
from robbdd_tools.features.policy_results import policy_hints
from robbdd_tools.features.references import uses
from robbdd_tools.features.requirement_results import requirement_words
from robbdd_tools.features.result_words import MAX_LISTED, rate_lines, rate_words, result_words
from robbdd_tools.features.run_verdicts import NOTHING
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.features.sentences import (
    clause_sentence,
    condition_meaning,
    event_meaning,
    event_sentence,
    time_meaning,
    word_meaning,
    word_of,
)
from robbdd_tools.features.used_names import name_of, uses_by_part
from robbdd_tools.names.elements import Site, elements_of, scene_members, site_of
from robbdd_tools.names.index import language_of
from robbdd_tools.names.roles import ROLE_KINDS
from robbdd_tools.names.types import variable_type
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.names.variant_places import variants_of as placed_variants
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.features.run_verdicts import Findings
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.elements import Element
    from robbdd_tools.names.project import Snapshot

_ENDS = {"sequence": "fails", "selector": "succeeds"}
"""Kind of a composite in a behaviour tree → the result of a child that ends the composite."""
_QUOTED = {
    SymbolKind.COMPOSITION,
    SymbolKind.DISTRIBUTION,
    SymbolKind.TREE_TEMPLATE,
    SymbolKind.TREE,
    SymbolKind.TREE_INSTANCE,
    SymbolKind.GRAPH,
    SymbolKind.BODY,
    SymbolKind.FRAME,
    SymbolKind.POSE,
    SymbolKind.JOINT,
    SymbolKind.SCENE_INSTANCE,
    SymbolKind.MODEL,
    SymbolKind.SENSOR,
    SymbolKind.IMPLEMENTATION,
    SymbolKind.PROVIDER,
    SymbolKind.OBSERVATION,
    SymbolKind.POLICY,
    SymbolKind.ROBOT_LOG,
    SymbolKind.EXECUTION,
}
"""Kinds that are described by their source text."""
_COMPLETE = {
    SymbolKind.FLUENT,
    SymbolKind.BEHAVIOUR,
    SymbolKind.STORY,
    SymbolKind.VARIANT,
    SymbolKind.GRAPH,
    SymbolKind.POSE,
    SymbolKind.JOINT,
    SymbolKind.SCENE_INSTANCE,
    SymbolKind.MODEL,
    SymbolKind.SENSOR,
    SymbolKind.EXECUTION,
}
"""Kinds whose names need not be used, so *not used* is not shown for them."""


def describe(snapshot: Snapshot, definition: Definition, findings: Findings = NOTHING) -> str:
    """Describe a name: its kind, type, preceding comment, IRI, contents, sentence, results and uses."""
    site = site_of(snapshot, definition)
    parts = [_title(snapshot, definition), *_comment(site, definition)]
    if site is not None:
        parts += _contents(site, definition)
        parts += describe_properties(site, definition)
    parts += describe_statements(snapshot, definition)
    parts += _results(snapshot, definition, findings)
    if definition.iri is not None and definition.kind is not SymbolKind.NAMESPACE:
        parts.append(code(f"<{definition.iri}>"))
    parts += _used(snapshot, definition)
    return "\n\n".join(parts)


def describe_path(snapshot: Snapshot, uri: str, path: str) -> str | None:
    """Describe a qualified name that a file of the project declares."""
    analysis = snapshot.file(uri)
    definition = None if analysis is None else analysis.definitions.get(path)
    return None if definition is None else describe(snapshot, definition)


def describe_import(snapshot: Snapshot, uri: str) -> str:
    """Describe an imported file by its declarations."""
    graph = describe_graph(snapshot, uri)
    if graph is not None:
        return graph
    file = snapshot.file(uri)
    first = (
        [placed.declaration.symbols[0] for placed in file.declarations if placed.declaration.symbols] if file else []
    )
    names = [f"{symbol.kind} {code(symbol.path)}" for symbol in first if symbol.kind is not SymbolKind.NAMESPACE]
    return "\n\n".join((f"**file** {code(_name(uri))}", *[f"declares {_listed(names)}"] * bool(names)))


def describe_words(words: str) -> str | None:
    """Describe the words of the catalog whose phrases contain the given keywords."""
    catalog = load_catalog()
    known = (*catalog.predicates.values(), *catalog.behaviours.values())
    found = [word_meaning(word) for word in known if f" {words} " in f" {word.phrase} "]
    return "\n\n---\n\n".join(found) or None


def variants_of(snapshot: Snapshot, template: Definition) -> Iterator[Scenario]:
    """Yield the variants of a template, both in its own file and in the files that import it."""
    return (_scenario(snapshot, *place) for place in _variants_of(snapshot, template))


def _scenario(snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration, variant: tree.Variant) -> Scenario:
    return next(scenario for scenario in scenarios(Site(snapshot, file, placed)) if scenario.variant is variant)


def _variants_of(
    snapshot: Snapshot, template: Definition
) -> Iterator[tuple[FileAnalysis, PlacedDeclaration, tree.Variant]]:
    """Yield the variants of a template that have no syntax error, with their places."""
    name = name_of(template)
    for uri in (template.uri, *snapshot.importers(template.uri)):
        file = snapshot.file(uri)
        if file is None:
            continue
        for placed, spans in uses_by_part(snapshot, file, name):
            ends, broken = [span.end for span in spans], bool(placed.declaration.faults)
            for node in (clauses.node for clauses in clauses_of(placed.declaration)):
                if not isinstance(node, tree.Variant) or node.template.span.end not in ends:
                    continue
                if not broken or Site(snapshot, file, placed).whole(node):
                    yield file, placed, node


def _title(snapshot: Snapshot, definition: Definition) -> str:
    title = f"**{definition.kind}** {code(definition.symbol.path)}"
    if definition.kind in ROLE_KINDS["Variable"]:
        found = variable_type(snapshot, definition)
        title += f": {found}" if found.is_known else ""
    return title


def _comment(site: Site | None, definition: Definition) -> Iterator[str]:
    """Yield the comment directly above a declaration."""
    if site is None:
        return
    document = site.file.document
    line = document.position(definition.extent.start).line - 1
    found: list[str] = []
    while line >= 0 and document.line_text(line).lstrip().startswith("//"):
        found.insert(0, document.line_text(line).lstrip().removeprefix("//").strip())
        line -= 1
    if found:
        yield literal("\n".join(found))


def _contents(site: Site, definition: Definition) -> Iterator[str]:
    match definition.kind:
        case kind if kind in _QUOTED:
            text = site.file.document.text[definition.extent.start : definition.extent.end]
            yield code_block(text, language_of(site.uri))
        case SymbolKind.FLUENT | SymbolKind.BEHAVIOUR:
            yield from _clause(site, definition)
        case SymbolKind.PREDICATE:
            yield from describe_predicate(site)
        case SymbolKind.EVENT:
            yield from _defined_event(site, definition)
        case SymbolKind.VARIANT:
            for scenario in scenarios(site):
                if site.span(scenario.variant.name) == definition.span:
                    yield _count(scenario)
        case SymbolKind.TREE_NODE:
            yield from _tree_node(site, definition)
        case SymbolKind.TEMPLATE:
            variants = list(_variants_of(site.snapshot, definition))
            for scenario in (_scenario(site.snapshot, *place) for place in variants[:MAX_LISTED]):
                yield f"`{scenario.variant.name.text}`: {_count(scenario)}"
            if len(variants) > MAX_LISTED:
                yield f"… and {len(variants) - MAX_LISTED:,} more"
        case SymbolKind.OBJECT_SET | SymbolKind.WORKSPACE_SET | SymbolKind.AGENT_SET | SymbolKind.CONSTANT_SET:
            yield from _members(elements_of(site))
        case SymbolKind.SCENE:
            yield from _members(tuple(sorted(scene_members(site) or (), key=lambda member: member.key)))
        case SymbolKind.OBJECT:
            model = load_catalog().object_for(definition.symbol.name, _sets(definition))
            yield from [f"Simulated as *{model.name}*: {model.doc}"] if model is not None else []
        case SymbolKind.AGENT:
            catalog, names = load_catalog(), (definition.symbol.name, _sets(definition))
            robot = catalog.robot_for(*names) or catalog.bystander_for(*names)
            yield from [f"Simulated as *{robot.name}*: {robot.doc}"] if robot is not None else []
        case _:
            pass


def _sets(definition: Definition) -> tuple[str, ...]:
    return tuple(definition.symbol.path.split(".")[:-1])


def _clause(site: Site, definition: Definition) -> Iterator[str]:
    for node in walk(site.tree) if site.tree is not None else ():
        if isinstance(node, tree.Fluent | tree.BehaviourUse) and site.span(node.name) == definition.span:
            yield f"> {literal(clause_sentence(node))}"
            phrase = node.predicate if isinstance(node, tree.Fluent) else node.action
            if isinstance(phrase, tree.PhraseUse):
                yield word_meaning(word_of(phrase))
            if isinstance(phrase, tree.NamedUse):
                yield from describe_predicate(site.follow(phrase.predicate))
            if isinstance(node, tree.Fluent):
                yield time_meaning(node.time)
                yield from [condition_meaning(node.conditions)] if node.conditions else []
            return


def _defined_event(site: Site, definition: Definition) -> Iterator[str]:
    for event in site.tree.events if isinstance(site.tree, tree.Template) else ():
        if site.span(event.name) == definition.span:
            yield f"> {literal(event_sentence(event))}"
            yield event_meaning(event)


def _tree_node(site: Site, definition: Definition) -> Iterator[str]:
    """Yield lines about a node of a behaviour tree: its action and the behaviours that are linked to it."""
    for node in walk(site.tree) if site.tree is not None else ():
        if isinstance(node, tree.TreeComposite) and site.span(node.name) == definition.span:
            parts = ", ".join(f"`{part.name.text}`" for part in node.nodes)
            yield f"Executes {parts}, one after the other, until one {_ENDS[node.kind]}."
    for link in links_to(site.snapshot, site.file):
        if link.node == (definition.uri, definition.symbol.path):
            yield f"`{link.behaviour.name.text}`: {literal(clause_sentence(link.behaviour))}"


def _count(scenario: Scenario) -> str:
    total, factors = scenario_count(scenario), factors_of(scenario)
    if total is None or factors is None:
        return "as many scenarios as its sets have elements, of which some are unknown"
    product = f" ({' × '.join(str(factor) for factor in factors)})" if len(factors) > 1 else ""
    return f"{total:,} scenario{'' if total == 1 else 's'}{product}"


def _members(members: tuple[Element, ...] | None) -> Iterator[str]:
    if members:
        names = _listed([code(member.name) for member in members])
        yield f"{len(members)} element{'' if len(members) == 1 else 's'}: {names}"


def _results(snapshot: Snapshot, definition: Definition, findings: Findings) -> Iterator[str]:
    match definition.kind:
        case SymbolKind.REQUIREMENT:
            yield from requirement_words(snapshot, definition, findings)
        case SymbolKind.FLUENT | SymbolKind.BEHAVIOUR:
            for hint in clause_hints(snapshot, definition.uri, findings):
                if hint.span == definition.extent:
                    yield result_words(hint)
        case SymbolKind.POLICY:
            for hint in policy_hints(snapshot, definition.uri, findings):
                if hint.span == definition.extent:
                    yield result_words(hint)
        case SymbolKind.EXECUTION:
            for one in executions_of(snapshot, definition.uri):
                if one.iri != definition.iri:
                    continue
                rate = execution_rate(snapshot, one, findings, number_of_scenarios(one.variant))
                if rate is not None:
                    known = findings.variants.get(one.variant.iri, ())
                    own = [scenario for scenario in known if scenario.execution == one.iri]
                    yield "Last results:\n\n" + "\n".join(rate_lines(definition.symbol.name, rate, own))
        case SymbolKind.VARIANT | SymbolKind.STORY:
            inside = [
                variant
                for variant in placed_variants(snapshot, definition.uri)
                if definition.extent.start <= variant.definition.span.start < definition.extent.end
            ]
            lines = [line for variant in inside for line in rate_words(snapshot, variant, findings)]
            if lines:
                yield "Last results:\n\n" + "\n".join(lines)
        case _:
            pass


def _used(snapshot: Snapshot, definition: Definition) -> Iterator[str]:
    places = list(uses(snapshot, definition))
    if not places:
        yield from () if definition.kind in _COMPLETE else ("not used",)
        return
    times = "once" if len(places) == 1 else f"{len(places)} times"
    starts = {uri: snapshot.document(uri).line_starts for uri in {uri for uri, _ in places}}
    lines = dict.fromkeys([(uri, bisect_right(starts[uri], span.start)) for uri, span in places])
    words = [literal(f"{_name(uri)}:{line}") for uri, line in islice(lines, MAX_LISTED)]
    yield f"used {times}: {_listed(words, len(lines))}"


def _listed(names: list[str], count: int = 0) -> str:
    """Return the first names, and the number of others. ``count`` is the total number if ``names`` is not complete."""
    left = max(count, len(names)) - MAX_LISTED
    more = f" and {left} more" if left > 0 else ""
    return f"{', '.join(names[:MAX_LISTED])}{more}"


def _name(uri: str) -> str:
    return unquote(uri.rsplit("/", 1)[-1])
