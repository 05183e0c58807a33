"""A declaration, which is the content of one chunk of text. Its offsets count from the start of the chunk."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.syntax.tree import ChunkTree, Ref


class SymbolKind(StrEnum):
    """Kind of a declared name."""

    NAMESPACE = "namespace"
    EVENT = "event"
    TASK = "task"
    REQUIREMENT = "requirement"
    OBJECT = "object"
    WORKSPACE = "workspace"
    AGENT = "agent"
    OBJECT_SET = "object set"
    WORKSPACE_SET = "workspace set"
    AGENT_SET = "agent set"
    CONSTANT_SET = "constant set"
    PREDICATE = "predicate"
    PARAMETER = "parameter"
    COMPOSITION = "composition"
    SCENE = "scene"
    TEMPLATE = "scenario template"
    VARIABLE = "variable"
    SET_VARIABLE = "set variable"
    FLUENT = "fluent"
    BEHAVIOUR = "behaviour"
    STORY = "user story"
    VARIANT = "scenario variant"
    BEHAVIOUR_TREE = "behaviour tree"
    TREE_NODE = "node of a behaviour tree"
    DISTRIBUTION = "distribution"
    TREE_TEMPLATE = "kinematic tree template"
    TREE = "kinematic tree"
    TREE_INSTANCE = "kinematic tree instance"
    GRAPH = "kinematic graph"
    BODY = "body"
    FRAME = "frame"
    POSE = "pose"
    JOINT = "joint"
    SCENE_INSTANCE = "scene instance"
    MODEL = "model"
    SENSOR = "sensor"
    IMPLEMENTATION = "behaviour implementation"
    PROVIDER = "observation provider"
    OBSERVATION = "observation"
    POLICY = "observation policy"
    ROBOT_LOG = "robot log"
    EXECUTION = "scenario execution"


FILE_NAMESPACE = ""
"""Stands for the only namespace of a file, if a declaration omits the namespace and the language allows this."""


@dataclass(frozen=True, slots=True)
class Symbol:
    """A declared name.

    - ``path``: the qualified name (``parts.bolt``).
    - ``span``: the span of the name itself; empty if the name is generated.
    - ``extent``: the span of the whole declaration.
    - ``namespace``: the name in the nearest enclosing ``(ns=…)``; ``FILE_NAMESPACE`` if it is omitted; ``None`` if the
      name has no IRI of its own.
    - ``target``: a qualified name whose members are also members of this name, for example the template of a kinematic
      tree instance.
    """

    path: str
    name: str
    kind: SymbolKind
    span: Span
    extent: Span
    namespace: str | None
    target: str | None = None


@dataclass(frozen=True, slots=True)
class Reference:
    """A use of a name. ``scopes`` are the paths of the enclosing declarations, innermost first."""

    ref: Ref
    scopes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SyntaxFix:
    """Text that repairs a fault when it replaces ``span``. If ``span`` is empty, the text is inserted.

    ``title`` describes the fix. It is empty if the text itself is the description.
    """

    span: Span
    text: str
    title: str = ""


@dataclass(frozen=True, slots=True)
class SyntaxFault:
    """A place where the text violates the grammar, with the text that the grammar allows there."""

    span: Span
    message: str
    fix: SyntaxFix | None = None


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Declaration:
    """One chunk with its tree (``None`` if broken), names, references and faults. All depend only on its text.

    Declarations are compared by identity. The cache returns the same object for the same text, because a keystroke
    looks up hundreds of declarations. A long story has ``parts`` in text order: the text before its scenarios, each
    scenario (its tree is a variant), and the text after them. Data about a part is kept when an edit of another part
    moves it. Other declarations have no parts.
    """

    text: str
    tree: ChunkTree | None
    symbols: Sequence[Symbol]
    references: Sequence[Reference]
    faults: tuple[SyntaxFault, ...]
    parts: tuple[Placed, ...] = ()


@dataclass(frozen=True, slots=True)
class Placed:
    """A declaration and its offset in a file. A part of a larger declaration has its offset in that declaration."""

    declaration: Declaration
    offset: int
