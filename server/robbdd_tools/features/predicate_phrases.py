"""Complete whole phrases of named predicates, with placeholders for their parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robbdd_tools.names.elements import site_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot


def phrase_form(snapshot: Snapshot, definition: Definition, *, is_after_subject: bool) -> tuple[str, str] | None:
    """Return the phrase of a named predicate as its label and as the body of a snippet.

    ``is_after_subject`` is true if the text before the phrase is its subject. The result is ``None`` if there is no
    parameter left to write, or if the text has a subject and the predicate has none.
    """
    site = site_of(snapshot, definition)
    nodes = () if site is None else (site.tree,)
    found = next((one for one in nodes if isinstance(one, tree.NamedPredicate)), None)
    if found is None or (is_after_subject and found.subject is None):
        return None
    words: list[str] = []
    names: list[str] = []
    if found.subject is not None and not is_after_subject:
        words.append(f"<{{{len(names)}}}>")
        names.append(found.subject.name.text)
    words.append(found.name.text)
    for piece in found.pieces:
        words += [word.text for word in piece.words]
        words.append(f"<{{{len(names)}}}>")
        names.append(piece.parameter.name.text)
    if not names:
        return None
    form = " ".join(words)
    placeholders = (f"${{{number}:{name}}}" for number, name in enumerate(names, start=1))
    return form.format(*names), form.format(*placeholders)
