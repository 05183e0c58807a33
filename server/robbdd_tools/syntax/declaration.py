"""A declaration: what one chunk of text says, by itself (offsets count from the chunk's start)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.syntax.tree import ChunkTree, Ref


class SymbolKind(StrEnum):
    """What a name stands for."""

    NAMESPACE = "namespace"
    EVENT = "event"
    TASK = "task"
    OBJECT = "object"
    WORKSPACE = "workspace"
    AGENT = "agent"
    OBJECT_SET = "object set"
    WORKSPACE_SET = "workspace set"
    AGENT_SET = "agent set"
    CONSTANT_SET = "constant set"
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
    EXECUTION = "scenario execution"


FILE_NAMESPACE = ""
"""The namespace of a declaration that gives none where the language allows it: the only one of its file."""


@dataclass(frozen=True, slots=True)
class Symbol:
    """A declared name.

    ``path`` is the qualified name (``parts.bolt``), ``span`` that of the name itself (empty where the text gives
    none), ``extent`` that of the whole thing it names. ``namespace`` is the name given by the nearest enclosing
    ``(ns=…)``, ``FILE_NAMESPACE`` where that is left out, ``None`` for what has no IRI of its own. ``target`` is a
    qualified name whose parts are parts of this one too: the template of a kinematic tree instance.
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
    """A use of a name. ``scopes`` are the enclosing declarations' paths, innermost first."""

    ref: Ref
    scopes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class SyntaxFix:
    """Text that repairs a fault when it is written over ``span`` (empty: put in)."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class SyntaxFault:
    """A place where the text does not follow the grammar, with what would have been accepted there."""

    span: Span
    message: str
    fix: SyntaxFix | None = None


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Declaration:
    """One chunk: its tree (``None`` when broken), names, references and faults; a function of its text only.

    Compared by identity: the cache gives the same object for the same text, and a keystroke asks for hundreds.

    A long story is read in ``parts``, which follow one another through its text: what stands before its scenarios,
    each scenario (its tree a variant) and what stands behind them. What is known of a part stays, wherever an edit of
    another one moves it. Any other declaration has none.
    """

    text: str
    tree: ChunkTree | None
    symbols: Sequence[Symbol]
    references: Sequence[Reference]
    faults: tuple[SyntaxFault, ...]
    parts: tuple[Placed, ...] = ()


@dataclass(frozen=True, slots=True)
class Placed:
    """A declaration and where it stands: in a file, or as a part in a larger declaration."""

    declaration: Declaration
    offset: int
