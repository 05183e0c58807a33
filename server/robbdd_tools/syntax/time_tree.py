"""Syntax trees of time constraints."""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.syntax.scene_tree import Node, Number, Ref


@dataclass(frozen=True, slots=True)
class During(Node):
    """``[at some time] from <start> until <end>``."""

    start: Ref
    end: Ref
    some_time: bool


@dataclass(frozen=True, slots=True)
class Before(Node):
    """``[[within] h seconds] before [the first | the last | every] <event>``. ``h`` is a number or a variable.

    ``some_time`` is true after ``within``. ``which`` is the word ``first``, ``last`` or ``every``.
    """

    some_time: bool
    horizon: Number | Ref | None
    which: str | None
    event: Ref


@dataclass(frozen=True, slots=True)
class After(Node):
    """``[[within] h seconds] after [the first | the last | every] <event>``, with the same parts as ``Before``."""

    some_time: bool
    horizon: Number | Ref | None
    which: str | None
    event: Ref


TimeConstraint = During | Before | After
