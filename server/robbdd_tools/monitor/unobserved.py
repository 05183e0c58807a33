"""Missing evidence: something was not observed when it was needed."""

from __future__ import annotations


class Unobserved(Exception):
    """There is no observation on which to judge. The message gives the reason."""


def no_grip(agent: str, unseen: str) -> str:
    """Return why it is unknown whether an agent holds an object, ``unseen`` if its poses are missing."""
    holder, thing = agent.rpartition(":")[2], unseen.rpartition(":")[2]
    if unseen:
        words = f"the log does not say where {unseen} is, and so not whether {agent} holds it"
        return f"{words}: add --frame {thing}=FRAME, or --grip {holder}/{thing}=SIGNAL"
    return (
        f"the log does not say what {agent} holds: add --grip {holder}=SIGNAL of its gripper, "
        f"or record texts on /{holder}/holds"
    )
