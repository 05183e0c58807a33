"""List the user stories of a file with their variants for test trees. They are read from the text of the file."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from robbdd_tools.base.files import read_text, uri_to_path
from robbdd_tools.features.scenarios import number_of_scenarios
from robbdd_tools.features.workspace_files import model_files
from robbdd_tools.names.index import FileIndex
from robbdd_tools.names.variant_places import PlacedVariant, variants_of
from robbdd_tools.syntax import tree

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.names.analysis import PlacedDeclaration
    from robbdd_tools.names.definition import Definition
    from robbdd_tools.names.project import Snapshot

_PATTERNS = {".bdd": re.compile(r"\bUser\s+Story\b"), ".bddx": re.compile(r"\bScenario\s+Exec\b")}
"""Pattern of runnable declarations, by file extension."""


@dataclass(frozen=True, slots=True)
class ListedVariant:
    """A variant in a test tree. ``count`` is the number of its scenarios, or ``None`` while it is unknown.

    ``variation`` is the absolute span of the variant's values: the whole table, or the first line of a product.
    """

    placed: PlacedVariant
    count: int | None
    variation: Span


@dataclass(frozen=True, slots=True)
class ListedStory:
    """A story with its role, feature and benefit, and with its variants in text order."""

    definition: Definition
    iri: str
    wants: str
    variants: tuple[ListedVariant, ...]


def stories_in(snapshot: Snapshot, uri: str) -> list[ListedStory]:
    """Return the stories of a file that have an IRI, in text order."""
    file = snapshot.file(uri)
    variants = list(variants_of(snapshot, uri))
    found: list[ListedStory] = []
    for placed in file.declarations if file is not None else ():
        story = placed.declaration.tree
        definition = file.definitions.get(story.name.text) if file and isinstance(story, tree.Story) else None
        if isinstance(story, tree.Story) and definition is not None and definition.iri is not None:
            own = tuple(_listed(variant) for variant in variants if _stands_in(variant, placed))
            found.append(ListedStory(definition, definition.iri, story.feature.value if story.feature else "", own))
    return found


def story_files(snapshot: Snapshot, folders: Iterable[str]) -> list[str]:
    """Return the files that contain stories or executions, sorted.

    These are open files and files on disk below the given folders.
    """
    known = {uri: source.document.text for uri, source in snapshot.sources.items() if isinstance(source, FileIndex)}
    candidates = sorted({*model_files(folders), *known})
    patterns = ((uri, _PATTERNS.get(f".{uri.rpartition('.')[2]}")) for uri in candidates)
    return [uri for uri, words in patterns if words and words.search(known[uri] if uri in known else _text(uri))]


def _stands_in(variant: PlacedVariant, story: PlacedDeclaration) -> bool:
    return story.offset <= variant.definition.span.start < story.span.end


def _listed(variant: PlacedVariant) -> ListedVariant:
    return ListedVariant(variant, number_of_scenarios(variant), variant.site.span(variant.node.variation))


def _text(uri: str) -> str:
    path = uri_to_path(uri)
    text = read_text(path) if path is not None else ""
    return text if isinstance(text, str) else ""
