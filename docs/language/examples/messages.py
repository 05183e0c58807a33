"""Reads the messages of packing.bddx."""

from __future__ import annotations

from typing import Any


def stamp(message: Any) -> float:
    """Return the time of a message, s."""
    return message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
