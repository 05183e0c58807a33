"""Go to implementation: from a template to its variants, and from a clause to its policy or evaluator."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import path_to_uri
from robbdd_tools.features.catalog_source import source_of
from robbdd_tools.features.describe import variants_of
from robbdd_tools.features.goto_definition import symbol_at
from robbdd_tools.features.sentences import word_of
from robbdd_tools.names.elements import Site, site_of
from robbdd_tools.names.requirement_links import key_of, verifiers
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

Place = tuple[str, Span]
_FILE_START = Span(0, 0)


def implementation(snapshot: Snapshot, uri: str, offset: int) -> list[Place]:
    """Return the implementations of the name at an offset. The implementation of a catalog word is its Python file."""
    found = symbol_at(snapshot, uri, offset)
    if found is None:
        return [place for phrase in _phrases_at(snapshot, uri, offset) for place in _python(phrase)]
    definition = found[1]
    site = site_of(snapshot, definition)
    match definition.kind:
        case SymbolKind.TEMPLATE:
            return [(one.site.uri, one.site.span(one.variant.name)) for one in variants_of(snapshot, definition)]
        case SymbolKind.TASK:
            return list(_declaring(snapshot, definition, tree.Template, "Task"))
        case SymbolKind.REQUIREMENT:
            found = verifiers(snapshot, [definition])[key_of(definition)]
            return [(one.variant.definition.uri, one.variant.definition.span) for one in found]
        case SymbolKind.SCENE:
            return list(_declaring(snapshot, definition, tree.SceneInstance, "Scene"))
        case SymbolKind.VARIANT:
            return list(_declaring(snapshot, definition, tree.Execution, "Variant"))
        case SymbolKind.FLUENT:
            policies = list(_declaring(snapshot, definition, tree.Policy, "Fluent"))
            return policies or _word(site, definition)
        case SymbolKind.BEHAVIOUR:
            return [*_implementations(snapshot, definition), *_word(site, definition)]
        case SymbolKind.TREE_TEMPLATE:
            return list(_declaring(snapshot, definition, tree.TreeInstance, "TreeTemplate"))
        case _:
            return []


def _declaring(
    snapshot: Snapshot,
    definition: Definition,
    kind: type[tree.Template | tree.SceneInstance | tree.Execution | tree.Policy | tree.TreeInstance],
    role: str,
) -> Iterator[Place]:
    """Yield the declarations of a kind that refer to a definition in the given role."""
    for uri in (definition.uri, *snapshot.importers(definition.uri)):
        file = snapshot.file(uri)
        for placed in file.declarations if file is not None else ():
            root = placed.declaration.tree
            if not isinstance(root, kind):
                continue
            refs = (entry.ref for entry in placed.declaration.references if entry.ref.role == role)
            targets = (placed.targets.get(ref) for ref in refs)
            if any(target is not None and _same(target, definition) for target in targets):
                yield uri, root.name.span.shifted(placed.offset)


def _implementations(snapshot: Snapshot, behaviour: Definition) -> Iterator[Place]:
    """Yield the implementations that the executions of a behaviour's template choose for the behaviour."""
    file = snapshot.file(behaviour.uri)
    template = None if file is None else file.definitions.get(behaviour.symbol.path.partition(".")[0])
    variants = list(variants_of(snapshot, template)) if template is not None else []
    names = {(one.site.uri, one.site.span(one.variant.name)) for one in variants}
    for uri in (behaviour.uri, *snapshot.importers(behaviour.uri)):
        executing = snapshot.file(uri)
        for placed in executing.declarations if executing is not None else ():
            root = placed.declaration.tree
            if isinstance(root, tree.Execution):
                variant, used = placed.targets.get(root.variant), placed.targets.get(root.behaviour)
                if variant is not None and used is not None and (variant.uri, variant.span) in names:
                    yield used.uri, used.span


def _word(site: Site | None, definition: Definition) -> list[Place]:
    for node in walk(site.tree) if site is not None and site.tree is not None else ():
        if isinstance(node, tree.Fluent | tree.BehaviourUse) and site is not None:
            if site.span(node.name) != definition.span:
                continue
            phrase = node.predicate if isinstance(node, tree.Fluent) else node.action
            return list(_python(phrase)) if isinstance(phrase, tree.PhraseUse) else []
    return []


def _phrases_at(snapshot: Snapshot, uri: str, offset: int) -> Iterator[tree.PhraseUse]:
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        if placed.span.contains(offset) and placed.declaration.tree is not None:
            for node in walk(placed.declaration.tree):
                if isinstance(node, tree.PhraseUse) and node.span.shifted(placed.offset).contains(offset):
                    yield node


def _python(phrase: tree.PhraseUse) -> Iterator[Place]:
    """Yield the source file of a catalog word."""
    path = source_of(word_of(phrase))
    if path is not None:
        yield path_to_uri(path), _FILE_START


def _same(one: Definition, other: Definition) -> bool:
    return (one.uri, one.symbol.path) == (other.uri, other.symbol.path)
