"""``several-places``: an object should be located at each of several places that have nothing in common.

Like every other set, a set of places in ``is located at`` or ``is entirely inside`` means each of its elements. Users
often mean one of them.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.base.memory import kept_with_key
from robbdd_tools.checks.chosen_elements import written_elements
from robbdd_tools.checks.finding import finding, related_to
from robbdd_tools.checks.template_variants import Scenario, scenarios
from robbdd_tools.names.elements import Element, Site, element_of, site_of, story_sites
from robbdd_tools.names.index import language_of
from robbdd_tools.names.types import Written, variable_key
from robbdd_tools.names.uses import clauses_of
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.declaration import SymbolKind
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.diagnostic import Diagnostic
    from robbdd_tools.names.analysis import FileAnalysis, PlacedDeclaration
    from robbdd_tools.names.project import Snapshot
    from robbdd_tools.names.resolve import Resolution

CODE = "several-places"
PLACED = {"located-at": "is located at", "is-entirely-inside": "is entirely inside"}
"""The predicates that an object fulfils at one place at a time, with their verbs."""
Key = tuple[str, str]
Name = TypeVar("Name", bound=Hashable)


@dataclass(frozen=True, slots=True)
class _Use:
    """A clause of a template or a variant in which a set variable is the place of an object."""

    site: Site
    word: str
    thing: str
    place: tree.Ref
    variable: str


def several_places(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Diagnostic]:
    """Report each such clause once, with the places of the first variant in which it can never hold."""
    uses = [
        _use(Site(snapshot, file, placed), *found)
        for placed in file.parts()
        for found in _set_places(snapshot, file, placed)
    ]
    if not uses:
        return
    reported: set[int] = set()
    for scenario in _scenarios(snapshot, file):
        own = (scenario.site.placed, None if scenario.template is None else scenario.template.placed)
        for use in uses:
            if not any(use.site.placed is placed for placed in own) or id(use) in reported:
                continue
            found = _apart(scenario, use.variable)
            if found is not None:
                reported.add(id(use))
                node, one, other = found
                message = at_each(use.word, use.thing, use.place.path, one, other)
                related = (related_to(scenario.site, node, "the places"),)
                yield finding(use.site, use.place, Severity.WARNING, CODE, message, related)


def at_each(word: str, thing: str, places: str, one: str, other: str) -> str:
    """Return the message on an object that should be at each of several places, by one of the words ``PLACED``."""
    verb = PLACED[word]
    return (
        f"'{thing}' cannot be {verb.removeprefix('is ')} each of '{places}', because '{one}' and '{other}' have "
        f"no place in common: to mean any of them, write '( var place exists in <{places}> ) such that "
        f"{{ … <{thing}> {verb} <place> … }}'"
    )


def have_nothing_in_common(
    one: Name, other: Name, carriers: Mapping[Name, Set[Name]], inner: Mapping[Name, Set[Name]]
) -> bool:
    """Return whether two workspaces are certainly apart.

    They are not apart if one contains the other or if the same object carries both. ``carriers`` maps a workspace to
    its objects, and ``inner`` maps it to the workspaces directly inside it.
    """
    if one == other or carriers.get(one, frozenset()) & carriers.get(other, frozenset()):
        return False
    return not contains(one, other, inner) and not contains(other, one, inner)


def contains(outer: Name, one: Name, inner: Mapping[Name, Set[Name]]) -> bool:
    """Return whether a workspace is inside another one, at any depth."""
    return one in _reached(outer, inner)


def _reached(start: Name, inner: Mapping[Name, Set[Name]]) -> set[Name]:
    found: set[Name] = set()
    waiting = [start]
    while waiting:
        new = set(inner.get(waiting.pop(), ())) - found
        found |= new
        waiting += new
    return found


def _use(site: Site, word: str, thing: str, place: tree.Ref) -> _Use:
    variable = site.target(place)
    assert variable is not None
    return _Use(site, word, thing, place, variable_key(variable))


_Place = tuple[str, str, tree.Ref]
"""The word of a predicate, an object, and the set variable that is its place."""


@kept_with_key
def _known_places(_: Resolution) -> list[tuple[_Place, ...]]:
    """Return a list that caches the places in the clauses of a declaration. It is empty until they have been found."""
    return []


def _set_places(snapshot: Snapshot, file: FileAnalysis, placed: PlacedDeclaration) -> tuple[_Place, ...]:
    # The kinds of variables cannot change while the resolution stays the same.
    known = _known_places(placed.targets.resolution)
    if not known:
        known.append(tuple(_found_places(Site(snapshot, file, placed))))
    return known[0]


def _found_places(site: Site) -> Iterator[_Place]:
    for clauses in clauses_of(site.placed.declaration):
        for phrase in clauses.phrases if site.whole(clauses.node) else ():
            slots = dict(phrase.arguments)
            place, thing = slots.get("workspace"), slots.get("object")
            if phrase.word in PLACED and isinstance(place, tree.Ref) and isinstance(thing, tree.Ref):
                variable = site.target(place)
                is_set = variable is not None and variable.kind is SymbolKind.SET_VARIABLE
                # The clauses are walked only if the place is a set.
                if is_set and phrase not in set(_lenient(clauses.node)):
                    yield phrase.word, thing.path, place


def _lenient(node: tree.Node) -> Iterator[tree.Node]:
    """Yield the phrases of clauses that each element may satisfy at another time."""
    for clause in walk(node):
        if isinstance(clause, tree.Fluent) and (clause.conditions or clause.time.some_time):
            yield from (clause.predicate, *clause.conditions)


def _scenarios(snapshot: Snapshot, file: FileAnalysis) -> Iterator[Scenario]:
    """Yield the scenarios of a file and of the loaded files that import it."""
    uri = file.document.uri
    users = (uri, *(name for name in snapshot.importers(uri) if language_of(name) == "bdd"))
    for user in (snapshot.file(name) for name in users):
        for site in story_sites(snapshot, user) if user is not None else ():
            yield from scenarios(site)


def _apart(scenario: Scenario, variable: str) -> tuple[tree.Node, str, str] | None:
    """Return a value of a set variable and two places in it that have nothing in common."""
    carriers: dict[Key, set[Key]] = {}
    inner: dict[Key, set[Key]] = {}
    contents(scenario.site.follow(scenario.variant.scene), carriers, inner)
    for column in scenario.columns:
        if column.variable is None or variable_key(column.variable) != variable:
            continue
        for node, elements in _sets(scenario.site, column.written):
            places = [element for element in elements if element.kind == "workspace"]
            for one, other in combinations(dict.fromkeys(places), 2):
                if have_nothing_in_common(one.key, other.key, carriers, inner):
                    return node, _local(one), _local(other)
    return None


def _sets(site: Site, written: Iterable[Written]) -> Iterator[tuple[tree.Node, list[Element]]]:
    """Yield the values of a set variable. For a selection of several elements, yield its whole set."""
    for value in written:
        if isinstance(value, tree.SetList):
            yield from _sets(site, value.sets)
        elif not isinstance(value, tree.Selection) or value.count.value > 1:
            yield value, [element for _, element in written_elements(site, value)]


def contents(site: Site | None, carriers: dict[Key, set[Key]], inner: dict[Key, set[Key]]) -> None:
    """Collect, for each workspace of a scene, the objects that carry it and the workspaces directly inside it."""
    _collect(site, carriers, inner, set())


def _collect(
    site: Site | None, carriers: dict[Key, set[Key]], inner: dict[Key, set[Key]], seen: set[tuple[str, int]]
) -> None:
    root = None if site is None else site.tree
    if site is None or not isinstance(root, tree.Scene | tree.Composition) or (site.uri, site.placed.offset) in seen:
        return
    seen.add((site.uri, site.placed.offset))
    own = element_of(site, root.workspace) if isinstance(root, tree.Composition) else None
    for entry in root.entries:
        target = site.target(entry.reference)
        composed = None if target is None else site_of(site.snapshot, target)
        if entry.reference.role == "Composition":
            _collect(composed, carriers, inner, seen)
            if own is not None and composed is not None and isinstance(composed.tree, tree.Composition):
                part = element_of(composed, composed.tree.workspace)
                inner.setdefault(own.key, set()).update(() if part is None else (part.key,))
        elif own is not None and target is not None:
            known = inner if target.kind is SymbolKind.WORKSPACE else carriers
            known.setdefault(own.key, set()).add((target.uri, target.symbol.path))


def _local(element: Element) -> str:
    return element.name.rpartition(".")[2]
