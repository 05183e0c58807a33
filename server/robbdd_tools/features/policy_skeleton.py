"""Quick fix of ``no-evaluator``: add an observation policy for a clause to a ``.bddx``."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, NewFile
from robbdd_tools.base.document import Span
from robbdd_tools.base.files import file_state
from robbdd_tools.checks.no_evaluator import Unjudged, unjudged
from robbdd_tools.names.elements import Site
from robbdd_tools.names.imports import import_path
from robbdd_tools.names.index import language_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import FILE_NAMESPACE, SymbolKind

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot

_VARIABLES = (SymbolKind.VARIABLE, SymbolKind.SET_VARIABLE)
MODULE = "policies"
"""Module of the evaluator. It is in the folder of the ``.bddx``, and its function is named after the clause."""
MAX_WORDS = 4
"""Maximum number of words of a text that form the name of its clause."""


def policy_fixes(snapshot: Snapshot, file: FileAnalysis, diagnostic: Diagnostic) -> Iterator[Fix]:
    """Yield a fix that adds a policy for the reported clause.

    The policy is written into the first loaded ``.bddx`` that imports the model or, if there is none, into a new one in
    the folder of the model.
    """
    for found in unjudged(snapshot, file):
        if found.span == diagnostic.span:
            yield from _fix(Site(snapshot, file, found.placed), found)


def _fix(site: Site, found: Unjudged) -> Iterator[Fix]:
    owner = _owner(site, found)
    observed = [] if owner is None else _observed(site, found, owner)
    if owner is None or not observed:
        return
    if isinstance(found.clause, tree.Fluent):
        name, edits = found.clause.name.text, ()
    elif "{" in found.clause.text.value or "}" in found.clause.text.value:
        return
    else:
        name = _free_name(site, owner, found.clause.text.value)
        edits = (_named(site, found.clause, name),)
    uri, snapshot = site.uri, site.snapshot
    for importer in snapshot.importers(uri):
        other = snapshot.file(importer) if language_of(importer) == "bddx" else None
        namespace = None if other is None else _namespace(other)
        if other is not None and namespace is not None:
            text = _policy(f"{owner}.{name}", name, namespace, observed, _provider(other))
            end = len(other.document.text.rstrip())
            added = Edit(importer, Span(end, end), f"\n\n{text.rstrip()}")
            used = tuple(_used(snapshot, other, owner, f"<{name}-policy>"))
            yield Fix(f"Write a policy into '{importer.rpartition('/')[2]}'", (*edits, *used, added))
            return
    new = _new_file(site, lambda namespace: _policy(f"{owner}.{name}", name, namespace, observed, None))
    if new is not None:
        yield Fix(f"Write a policy into a new '{new.uri.rpartition('/')[2]}'", edits, new)


def _owner(site: Site, found: Unjudged) -> str | None:
    """Return the qualified name of the template or variant that contains a clause."""
    root = site.tree
    match root:
        case tree.Template():
            return root.name.text
        case tree.Variant():
            return site.placed.declaration.symbols[0].path if site.placed.declaration.symbols else None
        case tree.Story():
            inside = (one for one in root.variants if one.span.contains(found.clause.span.start))
            variant = next(inside, None)
            return None if variant is None else f"{root.name.text}.{variant.name.text}"
        case _:
            return None


def _observed(site: Site, found: Unjudged, owner: str) -> list[str]:
    """Return the variables that a clause uses. If it uses none, return all variables of its template."""
    arguments: tuple[tree.TextArgument, ...] = ()
    if isinstance(found.clause, tree.Fluent) and isinstance(found.clause.predicate, tree.TextPredicate):
        arguments = found.clause.predicate.arguments
    targets = [site.target(argument.value) for argument in arguments if isinstance(argument.value, tree.Ref)]
    named = [target.symbol.path for target in targets if target is not None and target.kind in _VARIABLES]
    if named:
        return list(dict.fromkeys(named))
    variables = site.tree.variables if isinstance(site.tree, tree.Template) else ()
    return [f"{owner}.{variable.name.text}" for variable in variables]


def _free_name(site: Site, owner: str, text: str) -> str:
    words = re.findall(r"[a-z0-9]+", text.lower())[:MAX_WORDS]
    base = "-".join(words) or "clause"
    base = base if base[0].isalpha() else f"clause-{base}"
    name, number = base, 2
    while f"{owner}.{name}" in site.file.definitions:
        name, number = f"{base}-{number}", number + 1
    return name


def _named(site: Site, clause: tree.TextClause, name: str) -> Edit:
    """Return the edit that gives a clause a name, so that a policy can refer to it."""
    document = site.file.document
    words, time = (document.text[span.start : span.end] for span in (site.span(clause.text), site.span(clause.time)))
    return Edit(site.uri, site.span(clause), f"{name}: holds(pred({words}), {time})")


def _namespace(file: FileAnalysis) -> str | None:
    """Return the namespace name of a file's executions."""
    kinds = (tree.Execution, tree.Policy, tree.Implementation)
    for placed in file.declarations:
        symbols = placed.declaration.symbols
        if isinstance(placed.declaration.tree, kinds) and symbols and symbols[0].namespace:
            return symbols[0].namespace
    return None


def _provider(file: FileAnalysis) -> str | None:
    """Return the first observation provider in a file that is available in simulation."""
    for placed in file.declarations:
        root = placed.declaration.tree
        if isinstance(root, tree.Provider) and isinstance(root.source, tree.GroundTruth):
            return root.name.text
    return None


def _policy(path: str, name: str, namespace: str, observed: list[str], provider: str | None) -> str:
    """Return the text of a policy that observes some variables and calls a function of the user."""
    own = f"(ns={namespace})"
    text = ""
    if provider is None:
        provider = f"{name}-truth"
        text += f"obs provider {own} {provider} {{ simulation ground truth update-rate: 100 Hz }}\n\n"
    targets = "".join(f"    observes var <{variable}>\n" for variable in observed)
    text += f"observation {own} {name}-seen {{\n    provider: <{provider}>\n{targets}}}\n\n"
    attribute = re.sub(r"\W", "_", name)
    return (
        f"{text}obs policy {own} {name}-policy for <{path}> {{\n    observations: {{ <{name}-seen> }}\n"
        f"    evaluator: py {{ module: {MODULE}, attr: {attribute} }}\n}}\n"
    )


def _used(snapshot: Snapshot, file: FileAnalysis, owner: str, policy: str) -> Iterator[Edit]:
    """Yield the edits that make the executions of a clause's variants use a new policy."""
    text = file.document.text
    for placed in file.declarations:
        root = placed.declaration.tree
        if not isinstance(root, tree.Execution) or placed.declaration.faults:
            continue
        site = Site(snapshot, file, placed)
        if owner not in _owners(site, root):
            continue
        if root.policies:
            end = text.index(">", site.span(root.policies[-1]).end) + 1
            yield Edit(file.document.uri, Span(end, end), f", {policy}")
        elif "policies" not in text[placed.span.start : placed.span.end]:
            end = text.index(">", site.span(root.behaviour).end) + 1
            yield Edit(file.document.uri, Span(end, end), f"\n    policies: {{ {policy} }}")


def _owners(site: Site, execution: tree.Execution) -> Iterator[str]:
    """Yield the variant of an execution and its template."""
    target, story = site.target(execution.variant), site.follow(execution.variant)
    if target is None or story is None or not isinstance(story.tree, tree.Story):
        return
    yield target.symbol.path
    for variant in story.tree.variants:
        if variant.name.text == target.symbol.name:
            template = story.target(variant.template)
            if template is not None:
                yield template.symbol.path


def _new_file(site: Site, policy: Callable[[str], str]) -> NewFile | None:
    """Return a new ``.bddx`` in the folder of the model.

    Returns ``None`` if this file already exists or if the clause has no namespace.
    """
    symbols = site.placed.declaration.symbols
    namespace = symbols[0].namespace if symbols else None
    folder, _, own = site.uri.rpartition("/")
    uri = f"{folder}/{own.partition('.')[0]}.bddx"
    path = import_path(uri, site.uri)
    if path is None or namespace in (None, FILE_NAMESPACE) or uri in site.snapshot.sources:
        return None
    return None if file_state(uri) is not None else NewFile(uri, f'import "{path}"\n\n{policy(namespace)}')
