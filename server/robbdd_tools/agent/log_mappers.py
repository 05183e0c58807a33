"""Entity mappers in Python: users' functions that say which element a frame of a log is."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robbdd_tools.logs.log_names import local_name
from robbdd_tools.user_code.calls import call_user_code, definition_of, load_attribute, refused

if TYPE_CHECKING:
    from robbdd_tools.monitor.policy import Observation
    from robbdd_tools.protocol.specs import ScenarioSpec


def mapped_frames(spec: ScenarioSpec, frames: Iterable[str], elements: Iterable[str]) -> dict[str, str]:
    """Return the frames that the Python mappers of a scenario's observations name for elements (CURIEs).

    A mapper is called once with each frame of its provider, in alphabetical order: ``mapper(frame) -> element | None``.
    Raises ``UserCodeError``, also for an answer that is no element of the scene, and for two frames of one element.
    """
    known = {word: element for element in elements for word in (element, local_name(element))}
    found: dict[str, str] = {}
    names = sorted(frames)
    for observation in _with_mappers(spec):
        name = observation.entity_mapper
        mapper = load_attribute(name, spec.model)
        for frame in _of_provider(observation, names):
            answer = call_user_code(name, mapper, frame)
            if answer is None:
                continue
            if answer not in known:
                listed = ", ".join(sorted({local_name(one) for one in known.values()}))
                words = f"{name} returned {answer!r} for the frame '{frame}': return None or an element: {listed}"
                raise refused(name, words, definition_of(mapper))
            element = known[answer]
            if found.setdefault(element, frame) != frame:
                words = f"{name} returned '{answer}' for two frames, '{found[element]}' and '{frame}'"
                raise refused(name, f"{words}: return it for one of them only", definition_of(mapper))
    return found


def _with_mappers(spec: ScenarioSpec) -> Iterator[Observation]:
    """Yield the observations with a Python mapper, each mapper and provider once."""
    policies = () if spec.execution is None else spec.execution.policies
    seen: set[tuple[str, str]] = set()
    for observation in (one for policy in policies for one in policy.observations):
        key = (observation.entity_mapper, observation.provider.iri)
        if observation.entity_mapper and key not in seen:
            seen.add(key)
            yield observation


def _of_provider(observation: Observation, frames: Iterable[str]) -> Iterator[str]:
    """Yield the frames that a provider observes: those of its topic, or all frames of a transform listener."""
    provider = observation.provider
    topic = provider.source.lstrip("/")
    for frame in frames:
        if provider.kind != "topic" or frame == topic or frame.startswith(f"{topic}/"):
            yield frame
