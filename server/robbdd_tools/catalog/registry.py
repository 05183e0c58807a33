"""Collect the words of the language: scan our own folders, then the entry points of other packages.

A third-party package adds a word by an entry point of the group ``robbdd_tools.catalog`` that names a module-level
``Predicate``, ``Behaviour``, ``ObjectModel`` or ``RobotModel`` (``examples/plugin``).
"""

from __future__ import annotations

import pkgutil
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.catalog.api import Behaviour, ObjectModel, Predicate, RobotModel
from robbdd_tools.catalog.foreign_words import GROUP, Word, foreign_words
from robbdd_tools.catalog.name_words import spaces_of, words_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_PREPOSITIONS = {"at", "for", "from", "in", "into", "near", "of", "on", "onto", "under", "with"}
"""In a name, what an object is precedes such a word: ``cube_on_table``."""
FOLDERS = ("predicates", "behaviours", "objects", "robots")
Model = TypeVar("Model", ObjectModel, RobotModel)
Entry = TypeVar("Entry", Predicate, Behaviour, ObjectModel, RobotModel)


class DuplicateWord(Exception):
    """Two catalog files define the same name; the message names both."""


@dataclass(frozen=True, slots=True)
class Catalog:
    """All registered words, by name, each mapping in alphabetical order.

    ``problems`` names words of other packages that are left out, with the reason.
    """

    predicates: Mapping[str, Predicate]
    behaviours: Mapping[str, Behaviour]
    objects: Mapping[str, ObjectModel]
    robots: Mapping[str, RobotModel]
    problems: tuple[str, ...] = ()

    def object_for(self, local_name: str, sets: Iterable[str] = ()) -> ObjectModel | None:
        """Return the object model for a scene object by its name, else by the names of its ``sets``.

        Unspecific models and people are the last choice: a part bin is a bin, and an operator's table a table. The name
        of a set selects no unspecific model, since the name of the object may say what it is.
        """
        names = (local_name, tuple(sets))
        things = {name: model for name, model in self.objects.items() if not (model.bystander or model.unspecific)}
        unspecific = {name: model for name, model in self.objects.items() if model.unspecific}
        return _by_names(things, *names) or _by_name(unspecific, local_name) or _by_names(self.bystanders, *names)

    def robot_for(self, local_name: str, sets: Iterable[str] = ()) -> RobotModel | None:
        """Return the robot model for a scene agent by its name, else by the names of its ``sets``."""
        return _by_names(self.robots, local_name, sets)

    def bystander_for(self, local_name: str, sets: Iterable[str] = ()) -> ObjectModel | None:
        """Return the object model for an agent that executes nothing, such as a person, like ``robot_for``."""
        return _by_names(self.bystanders, local_name, sets)

    @property
    def agents(self) -> tuple[RobotModel | ObjectModel, ...]:
        """All models that an agent may have."""
        return (*self.robots.values(), *self.bystanders.values())

    @property
    def bystanders(self) -> Mapping[str, ObjectModel]:
        """The object models that agents may also have."""
        return {name: model for name, model in self.objects.items() if model.bystander}


@cache
def load_catalog() -> Catalog:
    """Return the catalog of this installation; raises ``DuplicateWord`` if two of our files define one name."""
    own = list(_own_words())
    added, problems = foreign_words(entry_points(group=GROUP), own)
    return replace(build_catalog([*own, *added]), problems=tuple(problems))


def problems_of_words() -> tuple[str, ...]:
    """Return which words of other packages are left out, and why; empty if this process has not used the catalog."""
    return load_catalog().problems if load_catalog.cache_info().currsize else ()


def build_catalog(words: Iterable[tuple[str, Word]]) -> Catalog:
    """Index ``(origin, word)`` pairs by kind and name; raises ``DuplicateWord``."""
    found: dict[tuple[type, str], tuple[str, Word]] = {}
    for origin, word in words:
        key = (type(word), word.name)
        if key in found:
            raise DuplicateWord(f"'{word.name}' is defined twice: in {found[key][0]} and in {origin}")
        found[key] = (origin, word)
    every = [word for _, word in found.values()]
    return Catalog(
        _named(every, Predicate),
        _named(every, Behaviour),
        _named(every, ObjectModel),
        _named(every, RobotModel),
    )


def _named(words: list[Word], kind: type[Entry]) -> Mapping[str, Entry]:
    chosen = {word.name: word for word in words if isinstance(word, kind)}
    return MappingProxyType(dict(sorted(chosen.items())))


def _own_words() -> Iterable[tuple[str, Word]]:
    for folder in FOLDERS:
        package = import_module(f"robbdd_tools.catalog.{folder}")
        for info in pkgutil.iter_modules(package.__path__):
            module = import_module(f"{package.__name__}.{info.name}")
            for value in vars(module).values():
                if isinstance(value, Predicate | Behaviour | ObjectModel | RobotModel):
                    yield module.__name__, value


def _by_names(models: Mapping[str, Model], local_name: str, sets: Iterable[str]) -> Model | None:
    found = (_by_name(models, name) for name in (local_name, *sets))
    return next((model for model in found if model is not None), None)


def _by_name(models: Mapping[str, Model], name: str) -> Model | None:
    words = words_of(name)
    relation = next((place for place, word in enumerate(words) if word in _PREPOSITIONS), len(words))
    return _best(models, words[:relation]) or _best(models, words)


def _best(models: Mapping[str, Model], words: list[str]) -> Model | None:
    matches = [
        (_precedence(model, rank), model)
        for model in models.values()
        for prefix in model.prefixes
        if (rank := _rank(prefix, words)) is not None and (rank[0] or not _only_whole(model))
    ]
    return max(matches, key=lambda match: match[0])[1] if matches else None


def _precedence(model: ObjectModel | RobotModel, rank: tuple[bool, int, int]) -> tuple[bool, bool, int, int]:
    """Return a key that is largest for the model that fits a name best.

    Of two objects, one that carries a workspace takes precedence, then the last word: a bin of cubes, a cube tray. Of
    two robots, the first word does: a mobile Panda.
    """
    whole, place, length = rank
    if isinstance(model, ObjectModel):
        return whole, bool(spaces_of(model, "")), place, length
    return whole, False, -place, length


def _only_whole(model: ObjectModel | RobotModel) -> bool:
    return isinstance(model, ObjectModel) and model.whole_words


def _rank(prefix: str, words: list[str]) -> tuple[bool, int, int] | None:
    """Return whether a prefix fits whole words of a name, where, and its length; ``None`` if it does not fit.

    A word may be plural. A part of a word counts only at the word's beginning or end: a cabinet is not a bin.
    """
    wanted = words_of(prefix)
    count, joined = len(wanted), "".join(wanted)
    plural = [*wanted[:-1], f"{wanted[-1]}s"]
    places = [place for place in range(len(words)) if words[place : place + count] in (wanted, plural)]
    if places:
        return True, places[0], len(joined)
    parts = [place for place, word in enumerate(words) if word.startswith(joined) or word.endswith(joined)]
    return (False, parts[0], len(joined)) if parts else None
