"""Find the joints of an arm among the names of a log."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING

from robbdd_tools.logs.log_names import local_name, plain_word

if TYPE_CHECKING:
    from robbdd_tools.logs.joint_tracks import JointTracks

STATES = "joint_states"
"""Usual last part of the topic of joint states."""
MAX_LISTED = 8


class JointsProblem(Exception):
    """The joints of an arm cannot be found; the message says why and what to write."""


def topic_of(
    agent: str, joints: Sequence[str], logged: JointTracks, stated: Mapping[str, str], names: Mapping[str, str]
) -> str:
    """Return the topic of the states of an agent's joints.

    The topic has the agent's name in its path, or else it ends with ``joint_states``, or else it is the only topic with
    a joint of the arm. ``stated`` maps agents (CURIE) to topics, and ``names`` maps joints to their names in the log.
    Raises ``JointsProblem``.
    """
    known = {name.strip("/"): name for name in logged}
    if agent in stated:
        if (wanted := stated[agent].strip("/")) in known:
            return known[wanted]
        raise JointsProblem(f"the log has no joint states on '{stated[agent]}' for {agent}; it has: {_listed(logged)}")
    words = {plain_word(names.get(joint, joint)) for joint in joints}
    fitting = [topic for topic in logged if any(word in plain_word(name) for name in logged[topic] for word in words)]
    own = [topic for topic in fitting if plain_word(local_name(agent)) in map(plain_word, topic.split("/"))]
    usual = [topic for topic in fitting if topic.rpartition("/")[2] == STATES]
    for found in (own, usual, fitting):
        if len(found) == 1:
            return found[0]
        if found:
            hint = f"choose with --joints {local_name(agent)}=TOPIC"
            raise JointsProblem(f"several topics have the joints of {agent}: {', '.join(found)}; {hint}")
    every = {plain_word(name): name for states in logged.values() for name in states}
    hint = f"name each with --joint {local_name(agent)}/{joints[0]}=NAME"
    raise JointsProblem(f"the log has no joint of {agent}{_nearest(joints[0], every)}; {hint}")


def joint_words(agent: str, joint: str) -> tuple[str, ...]:
    """Return the words that name a joint of an agent: ``ur10/elbow``, ``env:ur10/elbow`` and ``elbow``."""
    return f"{local_name(agent)}/{joint}", f"{agent}/{joint}", joint


def stated_joints(agent: str, joints: Sequence[str], stated: Mapping[str, str]) -> dict[str, str]:
    """Return the entries of ``stated`` for the joints of a model. The keys of ``stated`` are as in ``joint_words``."""
    keys = {joint: next((word for word in joint_words(agent, joint) if word in stated), "") for joint in joints}
    return {joint: stated[key] for joint, key in keys.items() if key}


def joints_of(agent: str, joints: Sequence[str], logged: Iterable[str], given: Mapping[str, str]) -> dict[str, str]:
    """Return the name in the log of each joint of a model.

    The names are the same or, for all joints, the same with one prefix and one suffix (``panda_joint1``,
    ``elbow_joint``). Case and separators do not matter. ``given`` maps joints to their names in the log. Raises
    ``JointsProblem`` with the joints that are missing.
    """
    known = {plain_word(name): name for name in logged}
    for joint, name in given.items():
        if plain_word(name) not in known:
            raise JointsProblem(f"the log has no joint '{name}' for '{joint}' of {agent}{_nearest(name, known)}")
    others = [joint for joint in joints if joint not in given]
    found = {joint: known[plain_word(name)] for joint, name in given.items()}
    return found | _decorated(agent, others, known) if others else found


def _decorated(agent: str, joints: Sequence[str], known: Mapping[str, str]) -> dict[str, str]:
    first = plain_word(joints[0])
    forms = {tuple(word.split(first, 1)) for word in known if first in word}
    fitting = {form for form in forms if all(form[0] + plain_word(joint) + form[1] in known for joint in joints)}
    # If two arms share a topic, each has a prefix; this arm's prefix may contain its name.
    own = {form for form in fitting if plain_word(local_name(agent)) in form[0]}
    for chosen in ({("", "")} & fitting, own, fitting):
        if len(chosen) == 1:
            before, after = next(iter(chosen))
            return {joint: known[before + plain_word(joint) + after] for joint in joints}
        if chosen:
            listed = ", ".join(sorted(known[before + first + after] for before, after in chosen))
            hint = f"choose with --joint {local_name(agent)}/{joints[0]}=NAME, and so on for each joint"
            raise JointsProblem(f"several joints fit '{joints[0]}' of {agent}: {listed}; {hint}")
    missing = [joint for joint in joints if not any(plain_word(joint) in word for word in known)] or list(joints)
    hint = f"name it with --joint {local_name(agent)}/{missing[0]}=NAME"
    listed = ", ".join(f"'{joint}'" for joint in missing)
    raise JointsProblem(f"the log has no joint {listed} of {agent}{_nearest(missing[0], known)}; {hint}")


def _nearest(name: str, known: Mapping[str, str]) -> str:
    near = [known[word] for word in get_close_matches(plain_word(name), list(known), n=3, cutoff=0.5)]
    return f"; {'nearest' if near else 'it has'}: {_listed(near or known.values())}"


def _listed(names: Iterable[str]) -> str:
    every = sorted(names)
    return ", ".join(every[:MAX_LISTED]) + (f" and {len(every) - MAX_LISTED} more" if len(every) > MAX_LISTED else "")
