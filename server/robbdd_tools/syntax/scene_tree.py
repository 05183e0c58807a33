"""Syntax trees of scenes, and syntax trees that all file kinds share: one frozen class per grammar rule.

Spans count from the start of the chunk, so a tree stays valid when its text moves.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache

from robbdd_tools.base.document import Span


@dataclass(frozen=True, slots=True)
class Node:
    """A node of a tree; ``span`` covers its text without surrounding white space."""

    span: Span


@cache
def field_names(node: type[Node]) -> tuple[str, ...]:
    """Return the fields of a kind of node, in the order of the grammar."""
    return tuple(field.name for field in fields(node))


@dataclass(frozen=True, slots=True)
class Name(Node):
    """A name at its declaration."""

    text: str


@dataclass(frozen=True, slots=True)
class Text(Node):
    """A string; ``value`` has its escapes resolved."""

    value: str


@dataclass(frozen=True, slots=True)
class Quantity(Node):
    """A number with a unit, such as ``0.25 m/s``. ``text`` has one space between both."""

    text: str


@dataclass(frozen=True, slots=True)
class Truth(Node):
    """``true`` or ``false``."""

    value: bool


@dataclass(frozen=True, slots=True)
class Number(Node):
    """A number: an ``int`` if written without point and exponent."""

    value: int | float


@dataclass(frozen=True, slots=True)
class Ref(Node):
    """A reference. ``role`` is its grammar rule without ``Ref`` (``Event``, ``AnySet`` …). ``span`` covers the path."""

    role: str
    path: str


@dataclass(frozen=True, slots=True)
class Import(Node):
    """``import "path"``."""

    path: Text


@dataclass(frozen=True, slots=True)
class Namespace(Node):
    """``ns name = 'iri'``."""

    name: Name
    iri: Text


@dataclass(frozen=True, slots=True)
class NamespaceArgument(Node):
    """``(ns=name)``."""

    reference: Ref


@dataclass(frozen=True, slots=True)
class PythonAttribute(Node):
    """``py { module: a.b, attr: c }``; imported in the agent only."""

    module: Name
    attribute: Name


@dataclass(frozen=True, slots=True)
class CatalogEntry(Node):
    """``catalog "name"``: a word of the installed catalog."""

    name: Text


PropertyValue = Ref | Quantity | Number | Text | Truth
"""A value of a property. A word without quotes is a ``Text``."""


@dataclass(frozen=True, slots=True)
class PropertyCondition(Node):
    """``colour = red``, ``fragile`` or ``not fragile``.

    ``comparison`` is ``=``, ``!=``, ``<``, ``<=``, ``>``, ``>=`` or ``not``. Without a sign, ``value`` is ``None``, and
    the property is compared with true.
    """

    name: Name
    comparison: str
    value: PropertyValue | None


@dataclass(frozen=True, slots=True)
class Where(Node):
    """``where … and …``: selects the elements of a set whose properties satisfy all conditions."""

    conditions: tuple[PropertyCondition, ...]


@dataclass(frozen=True, slots=True)
class Columns(Node):
    """``with mass, colour``: the properties that the tables of features show."""

    names: tuple[Name, ...]


@dataclass(frozen=True, slots=True)
class Link(Node):
    """An entry that refers to a declaration: ``obj <…>``, ``ws comp <…>``, ``set <…>``. Its role states the kind.

    ``where`` selects elements of a set. Only a set in a scene has ``columns``.
    """

    reference: Ref
    where: Where | None
    columns: Columns | None = None


@dataclass(frozen=True, slots=True)
class Property(Node):
    """``mass: 0.2 kg``: a fact about an element. Several values are separated by commas."""

    name: Name
    values: tuple[PropertyValue, ...]


@dataclass(frozen=True, slots=True)
class CorrectFor(Node):
    """``correct for: …``: the objects that belong in a workspace."""

    objects: tuple[Link, ...]


@dataclass(frozen=True, slots=True)
class Member(Node):
    """An object, workspace or agent inside its set. Only the details of workspaces contain ``CorrectFor``."""

    name: Name
    details: tuple[Property | CorrectFor, ...]

    @property
    def properties(self) -> tuple[Property, ...]:
        """The stated properties of the element."""
        return tuple(one for one in self.details if isinstance(one, Property))

    @property
    def correct_for(self) -> tuple[Link, ...]:
        """The objects, or sets of objects, that belong in the workspace."""
        return tuple(link for one in self.details if isinstance(one, CorrectFor) for link in one.objects)


@dataclass(frozen=True, slots=True)
class ElementSet(Node):
    """``obj set``, ``ws set`` or ``agn set``; ``kind`` is ``object``, ``workspace`` or ``agent``."""

    kind: str
    namespace: NamespaceArgument | None
    name: Name
    members: tuple[Member, ...]


@dataclass(frozen=True, slots=True)
class SimilarSet(Node):
    """``similar obj set``: declares members with the base name and 0 … count-1."""

    kind: str
    namespace: NamespaceArgument | None
    name: Name
    base: Name
    count: Number
    properties: tuple[Property, ...]


@dataclass(frozen=True, slots=True)
class Composition(Node):
    """``comp … of ws <…> { … }``."""

    namespace: NamespaceArgument | None
    name: Name
    workspace: Ref
    entries: tuple[Link, ...]


@dataclass(frozen=True, slots=True)
class Scene(Node):
    """``scene … { … }``."""

    namespace: NamespaceArgument | None
    name: Name
    entries: tuple[Link, ...]
