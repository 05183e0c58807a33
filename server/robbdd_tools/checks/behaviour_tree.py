"""``behaviour-tree``: a leaf has no behaviour or two, or a single node cannot execute a behaviour."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.diagnostic import Diagnostic, Edit, Fix, Related, Severity
from robbdd_tools.base.document import Span
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.base.removals import removal
from robbdd_tools.checks.finding import listed
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.names.analysis import FileAnalysis
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.syntax.declaration import Declaration

CODE = "behaviour-tree"


@dataclass(frozen=True, slots=True)
class Link:
    """A link from a behaviour to a node of a tree.

    The document and the path identify the behaviour. The place is the place of the reference to the node.
    """

    node: tuple[str, str]
    behaviour: tree.BehaviourUse
    uri: str
    span: Span
    is_repeated: bool
    has_siblings: bool


def behaviour_tree(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Check the links in a file, and the behaviour trees of the file with all links to them from importing files."""
    for link in links_in(file):
        if link.is_repeated:
            message = (
                "one node cannot execute a behaviour that is repeated for all elements of a set: "
                "remove the link, or state the behaviour outside of 'for all'"
            )
            fixes = tuple(_without(snapshot, link, "Remove the link"))
            yield Diagnostic(link.uri, link.span, Severity.ERROR, CODE, message, fixes=fixes)
        elif link.has_siblings:
            message = (
                "a template with several behaviours states their order itself, so none of them is linked to a node: "
                "remove the link, or write one template for each node"
            )
            fixes = tuple(_without(snapshot, link, "Remove the link"))
            yield Diagnostic(link.uri, link.span, Severity.ERROR, CODE, message, fixes=fixes)
    trees = [
        (root, placed.offset)
        for placed in file.of(tree.BehaviourTree)
        if isinstance(root := placed.declaration.tree, tree.BehaviourTree) and not placed.declaration.faults
    ]
    if not trees:
        return
    links = list(links_to(snapshot, file))
    for declared, offset in trees:
        yield from _leaves(snapshot, file, declared, offset, links)


def _leaves(
    snapshot: Snapshot, file: FileAnalysis, declared: tree.BehaviourTree, offset: int, links: list[Link]
) -> Iterator[Diagnostic]:
    uri, name = file.document.uri, declared.name.text
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
                f"no behaviour is linked to '{path}', so the tree cannot go on there: "
                f"link the behaviour of a scenario template to it, 'node: <{path}>'"
            )
            yield Diagnostic(uri, span, Severity.WARNING, CODE, message, fixes=tuple(_linking(snapshot, file, path)))
        words = {link.behaviour.action.word: link for link in reversed(found)}
        if len(words) > 1:
            said = " and ".join(f"'{link.behaviour.name.text}'" for link in reversed(words.values()))
            related = tuple(Related(link.uri, link.span, "linked here") for link in reversed(words.values()))
            message = f"'{path}' cannot execute different behaviours, {said}: give one of them a node of its own"
            _, *others = reversed(words.values())
            same = [
                link for link in found if any(link.behaviour.action.word == one.behaviour.action.word for one in others)
            ]
            fixes = tuple(_apart(snapshot, same))
            yield Diagnostic(uri, span, Severity.ERROR, CODE, message, related, fixes)


def _linking(snapshot: Snapshot, file: FileAnalysis, path: str) -> Iterator[Fix]:
    """Yield a fix for each unlinked behaviour of a template. The fix links the behaviour to the node."""
    for uri in (file.document.uri, *snapshot.importers(file.document.uri)):
        other = snapshot.file(uri)
        for placed in other.declarations if other is not None else ():
            for use in _free_uses(placed.declaration):
                end = use.action.span.end + placed.offset
                line = snapshot.document(uri).line_text(snapshot.document(uri).position(end).line)
                indent = line[: len(line) - len(line.lstrip())]
                edit = Edit(uri, Span(end, end), f"\n{indent}node: <{path}>")
                yield Fix(f"Link the behaviour '{use.name.text}' to it", (edit,))


def _free_uses(declaration: Declaration) -> Iterator[tree.BehaviourUse]:
    """Yield the behaviour of a valid template if it is the only one, is not linked to a node and is not repeated."""
    root = declaration.tree
    when = root.body.parts[0].when if isinstance(root, tree.Template) and not declaration.faults else None
    if isinstance(root, tree.Template) and when is not None and len(list(root.body.behaviours)) == 1:
        use = when.behaviour
        if use.node is None and use.external is None and use.name.span.start < use.name.span.end:
            yield use


def _apart(snapshot: Snapshot, links: list[Link]) -> Iterator[Fix]:
    """Yield the fix that removes some links, each of which conflicts with other links."""
    removals = [fix for link in links for fix in _without(snapshot, link, "")]
    names = listed(list(dict.fromkeys(link.behaviour.name.text for link in links)))
    if removals and len(removals) == len(links):
        yield Fix(f"Remove the link of {names}", tuple(edit for fix in removals for edit in fix.edits))


def _without(snapshot: Snapshot, link: Link, title: str) -> Iterator[Fix]:
    document = snapshot.document(link.uri)
    begun = re.search(r"\bnode\s*:\s*<\s*\Z", document.text[: link.span.start])
    ended = re.compile(r"\s*>").match(document.text, link.span.end)
    if begun is not None and ended is not None:
        yield removal(document, title, Span(begun.start(), ended.end()))


def links_to(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Link]:
    """Yield the links to nodes that a file and the files that import it contain."""
    for uri in (file.document.uri, *snapshot.importers(file.document.uri)):
        other = snapshot.file(uri)
        yield from () if other is None else links_in(other)


def links_in(file: FileAnalysis) -> Iterator[Link]:
    """Yield the links of a file to nodes, in text order."""
    for placed in file.of(tree.Template):
        for use, node, repeated, siblings in _linked_uses(placed.declaration):
            target = placed.targets.get(node)
            if target is not None:
                span = node.span.shifted(placed.offset)
                yield Link((target.uri, target.symbol.path), use, file.document.uri, span, repeated, siblings)


@kept_with_key
def _linked_uses(declaration: Declaration) -> tuple[tuple[tree.BehaviourUse, tree.Ref, bool, bool], ...]:
    """Return the linked behaviours of a template with their nodes.

    The last two values state whether the behaviour is repeated, and whether the template has several behaviours.
    """
    root = declaration.tree
    if not isinstance(root, tree.Template):
        return ()
    loops = (loop for loop in walk(root) if isinstance(loop, tree.ForAll))
    repeated = {inner.span for loop in loops for inner in walk(loop) if isinstance(inner, tree.BehaviourUse)}
    behaviours = list(root.body.behaviours)
    return tuple(
        (use, use.node, use.span in repeated, len(behaviours) > 1) for use in behaviours if use.node is not None
    )
