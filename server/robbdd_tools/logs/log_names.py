"""Find the frame of each element, and the events, among the names of a log."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING, TypeVar

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.catalog.coordination import each_emitter
from robbdd_tools.catalog.event_names import inner_event
from robbdd_tools.monitor.trace import OTHERS

if TYPE_CHECKING:
    from robbdd_tools.logs.log_contents import TextStamp
    from robbdd_tools.protocol.specs import ScenarioSpec

V = TypeVar("V")
GROUPS = (OTHERS, "angle", "speed")
"""Entries of ``Trace.uncertain`` that are not elements."""
BASES = frozenset({"base", "baselink", "basefootprint", "odom", "map", "world", "root"})
"""Usual names of frames that are never a tool, without separators."""
FIRST_LINK = "link0"
INTENDED = frozenset(
    (
        *("goal", "goals", "target", "targets", "desired", "setpoint", "setpoints", "command", "commands", "commanded"),
        *("cmd", "cmds", "plan", "plans", "planned", "reference", "expected", "request", "requests", "requested"),
        *("next", "upcoming", "queue", "queued", "schedule", "scheduled", "todo"),
    )
)
"""Words in the names of topics and frames with planned, not measured data."""
_SENTENCE = re.compile(r".*\s.*[#/:]|.*[#/:]\s", re.DOTALL)
"""A text that is neither a CURIE nor an IRI, although it has one of their separators."""
_SEPARATORS = re.compile(r"[\s_.-]+")


class FramesProblem(Exception):
    """The frame of an element cannot be found; the message says why and what to write."""


def local_name(curie: str) -> str:
    """Return the part of a CURIE after its last colon, without the path of its set."""
    return re.split(r"[:/#]", curie)[-1]


class NoElement(RobbddError):
    """A request states something about a name that is no element of the scene; the message lists similar names."""


def elements_of(stated: Mapping[str, V], elements: Iterable[str]) -> dict[str, V]:
    """Return a mapping with CURIEs instead of CURIEs or local names. Raises ``NoElement`` for any other name.

    Names of groups of elements (``GROUPS``) do not change.
    """
    known = {word: element for element in elements for word in (element, local_name(element))}
    found: dict[str, V] = {}
    for name, value in stated.items():
        if name not in known and name not in GROUPS:
            raise NoElement(
                f"the scene has no element '{name}'{_nearest(name, sorted({local_name(one) for one in known}))}"
            )
        found[known.get(name, name)] = value
    return found


def check_events(stated: Iterable[str], spec: ScenarioSpec) -> None:
    """Raise ``NoElement`` if a name is neither an event of a scenario nor one of its behaviour."""
    names = [local_name(event) for event in spec.events]
    known = [*names, *(one for source in dict.fromkeys(spec.events.values()) for one in each_emitter(source))]
    for name in stated:
        if name not in spec.events and inner_event(name, known) is None:
            raise NoElement(f"the scenario has no event '{name}'{_nearest(name, sorted(names))}")


def stated_frames(spec: ScenarioSpec) -> dict[str, str]:
    """Return the frames that the observations of a scenario's policies name for elements (``string`` mappers)."""
    policies = () if spec.execution is None else spec.execution.policies
    found: dict[str, str] = {}
    for policy in policies:
        for observation in policy.observations:
            for text, target in observation.mapped:
                value: object = spec.values.get(target, target)
                if isinstance(value, str):
                    found[value] = text
    return found


def frame_of(element: str, frames: Iterable[str], stated: Mapping[str, str]) -> str:
    """Return the frame of an element (CURIE) among the frames of a log.

    ``stated`` maps elements (CURIE or local name) to frames. Without an entry, the frame has the name of the element,
    or has this name as a part of its path (``cell/cube1``), unless a word of the path means a planned place
    (``goal/cube1``). Case and separators are ignored. Raises ``FramesProblem``.
    """
    known = sorted(frames)
    name = local_name(element)
    wanted = stated.get(element, stated.get(name))
    if wanted is not None:
        wanted = wanted.lstrip("/")
        if wanted in known:
            return wanted
        raise FramesProblem(f"the log has no frame '{wanted}' for {element}{_nearest(wanted, known)}")
    exact = [frame for frame in known if plain_word(frame) == plain_word(name)]
    named = exact or [frame for frame in known if plain_word(name) in map(plain_word, frame.split("/"))]
    found = [frame for frame in named if not _is_intended(frame, name)]
    if len(found) == 1:
        return found[0]
    hint = f"name it with --frame {name}=FRAME"
    if found:
        raise FramesProblem(f"several frames fit {element}: {', '.join(found)}; choose with --frame {name}=FRAME")
    if named:
        words = f"'{named[0]}' may be where {element} is meant to be, not where it is"
        raise FramesProblem(f"{words}, so it is not used; if it was measured, {hint}")
    raise FramesProblem(f"the log has no frame for {element}{_nearest(name, known)}; {hint}")


def shared_frames(found: Mapping[str, str], stated: Mapping[str, str]) -> dict[str, str]:
    """Return the elements that cannot be where their frame is, because it is that of another element, and why not.

    ``found`` maps elements (CURIE) to frames. A frame belongs to the elements for which it is ``stated``, and to the
    only one with exactly its name.
    """
    owners: dict[str, list[str]] = {}
    for element, frame in found.items():
        owners.setdefault(frame, []).append(element)
    problems: dict[str, str] = {}
    for frame, elements in owners.items():
        known = [one for one in elements if not {one, local_name(one)}.isdisjoint(stated)]
        exact = [one for one in elements if local_name(one) == frame.rpartition("/")[2]]
        own = [*known, *(exact if len(exact) == 1 else [])]
        for element in elements if len(elements) > 1 else ():
            if element not in own:
                others = ", ".join(one for one in elements if one != element)
                words = f"the frame '{frame}' fits {element}, but also {others}"
                problems[element] = f"{words}; name that of {element} with --frame {element}=FRAME"
    return problems


def _is_intended(frame: str, name: str) -> bool:
    """Return whether a frame is planned and not measured, judged by the words of its path except the element's name."""
    others = [part for part in frame.split("/") if plain_word(part) != plain_word(name)]
    return not INTENDED.isdisjoint(word for part in others for word in _SEPARATORS.split(part.casefold()))


def is_intended_topic(topic: str) -> bool:
    """Return whether the texts on a topic may say what is planned, not what happened, judged by its words."""
    return _is_intended(topic, "")


def tool_frame_of(agent: str, frames: Iterable[str], stated: Mapping[str, str]) -> str:
    """Return the frame of an agent's tool (CURIE) like ``frame_of``, but never a base that is only found by name.

    Raises ``FramesProblem``.
    """
    name, frame = local_name(agent), frame_of(agent, frames, stated)
    last = plain_word(frame.rpartition("/")[2])
    if not {agent, name}.isdisjoint(stated) or not (last in BASES or last.endswith(FIRST_LINK)):
        return frame
    words = f"'{frame}' is the base of {agent}, and no frame has the name of its tool"
    raise FramesProblem(f"{words}; name the frame of the tool with --frame {name}=FRAME")


def base_frame_of(agent: str, frames: Iterable[str], usual: Sequence[str], stated: str) -> str:
    """Return the frame of the base of an agent (CURIE) among the frames of a log; empty if it has none.

    This is the ``stated`` frame or, if none is stated, the frame that ends with one of the ``usual`` names. If several
    frames do, it is the one with the name of the agent. Raises ``FramesProblem``.
    """
    known = sorted(frames)
    if stated:
        if stated.lstrip("/") in known:
            return stated.lstrip("/")
        raise FramesProblem(f"the log has no frame '{stated}' for the base of {agent}{_nearest(stated, known)}")
    found = [frame for frame in known if any(plain_word(frame).endswith(plain_word(name)) for name in usual)]
    own = [frame for frame in found if plain_word(local_name(agent)) in plain_word(frame)]
    chosen = own or found
    if len(chosen) > 1:
        hint = f"choose with --base {local_name(agent)}=FRAME"
        raise FramesProblem(f"several frames may be the base of {agent}: {', '.join(chosen)}; {hint}")
    return chosen[0] if chosen else ""


def occurrences_of(
    event: str, emitter: str, texts: Iterable[TextStamp], signals: Iterable[str] = ()
) -> list[TextStamp]:
    """Return the texts with which a log reports an event (CURIE), in order.

    A text reports an event by its name or by a name of its ``emitter``, with the usual decorations (``evt-pick-end``).
    The text may be a CURIE or an IRI, but a sentence such as ``waiting for: pick-end`` reports nothing. If the user has
    declared when the event occurs, other texts do not count; ``signals`` are the events of declared signals.
    """
    names = [local_name(event), *each_emitter(emitter)]
    found = [
        one
        for one in texts
        if not _SENTENCE.match(one.text.strip()) and inner_event(one.text.strip(), names) is not None
    ]
    declared = [one for one in found if one.declared]
    is_declared = bool(declared) or any(inner_event(name, names) is not None for name in signals)
    return declared if is_declared else found


def plain_word(name: str) -> str:
    """Return a name without case and separators, to compare it with other spellings."""
    return _SEPARATORS.sub("", name).casefold()


def _nearest(name: str, known: list[str]) -> str:
    near = get_close_matches(name, known, n=3, cutoff=0.5)
    listed = near or known[:8]
    if not listed:
        return ": it has no frames"
    return f"; {'nearest' if near else 'it has'}: {', '.join(listed)}"
