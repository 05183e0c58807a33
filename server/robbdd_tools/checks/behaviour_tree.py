"""``behaviour-tree``: a leaf without a behaviour or with two, a behaviour that no single node can execute."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Related, Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "behaviour-tree"


@dataclass(frozen=True, slots=True)
class Link:
    """A behaviour that is linked to a node, told by its document and path, and the reference's place."""

    node: tuple[str, str]
    behaviour: tree.BehaviourUse
    uri: str
    span: Span
    is_repeated: bool


def behaviour_tree(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Look at the trees of a file, with what its importers link to them, and at the links of the file."""
    for link in links_in(file):
        if link.is_repeated:
            message = (
                "one node cannot execute a behaviour that is repeated for all elements of a set: "
                "take the link out, or state the behaviour outside of 'for all'"
            )
            yield Diagnostic(link.uri, link.span, Severity.ERROR, CODE, message)
    trees = [
        (root, placed.offset)
        for placed in file.declarations
        if isinstance(root := placed.declaration.tree, tree.BehaviourTree) and not placed.declaration.faults
    ]
    if not trees:
        return
    links = list(links_to(snapshot, file))
    for declared, offset in trees:
        yield from _leaves(file.document.uri, declared, offset, links)


def _leaves(uri: str, declared: tree.BehaviourTree, offset: int, links: list[Link]) -> Iterator[Diagnostic]:
    name = declared.name.text
    linked: dict[str, list[Link]] = {}
    for link in links:
        if link.node[0] == uri and link.node[1].startswith(f"{name}."):
            linked.setdefault(link.node[1], []).append(link)
    for leaf in walk(declared):
        if not isinstance(leaf, tree.TreeLeaf):
            continue
        path, span = f"{name}.{leaf.name.text}", leaf.name.span.shifted(offset)
        found = linked.get(path, [])
        if not found and linked and declared.source is None:
            message = (
                f"nothing says what '{path}' does, so the tree cannot go on there: "
                f"link the behaviour of a scenario template to it, 'node: <{path}>'"
            )
            yield Diagnostic(uri, span, Severity.WARNING, CODE, message)
        words = {link.behaviour.action.word: link for link in reversed(found)}
        if len(words) > 1:
            said = " and ".join(f"'{link.behaviour.name.text}'" for link in reversed(words.values()))
            related = tuple(Related(link.uri, link.span, "linked here") for link in reversed(words.values()))
            message = f"'{path}' cannot execute different behaviours, {said}: give one of them a node of its own"
            yield Diagnostic(uri, span, Severity.ERROR, CODE, message, related)


def links_to(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Link]:
    """Yield the links to nodes of a file's trees, and others, from the file itself and those that import it."""
    for uri in (file.document.uri, *snapshot.importers(file.document.uri)):
        other = snapshot.file(uri)
        yield from () if other is None else links_in(other)


def links_in(file: FileAnalysis) -> Iterator[Link]:
    """Yield the links of a file to nodes, in the order of the text."""
    for placed in file.declarations:
        for use, node, is_repeated in _linked_uses(placed.declaration):
            target = placed.targets.get(node)
            if target is not None:
                span = node.span.shifted(placed.offset)
                yield Link((target.uri, target.symbol.path), use, file.document.uri, span, is_repeated)


@kept_with_key
def _linked_uses(declaration: Declaration) -> tuple[tuple[tree.BehaviourUse, tree.Ref, bool], ...]:
    """Return the behaviours of a template with the nodes that they name, and whether they are repeated."""
    root = declaration.tree
    if not isinstance(root, tree.Template):
        return ()
    loops = (loop for loop in walk(root) if isinstance(loop, tree.ForAll))
    repeated = {inner.span for loop in loops for inner in walk(loop) if isinstance(inner, tree.BehaviourUse)}
    uses = (use for use in walk(root) if isinstance(use, tree.BehaviourUse))
    return tuple((use, use.node, use.span in repeated) for use in uses if use.node is not None)
