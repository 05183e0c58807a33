"""Read the cells of a table: numbers, dates, and orientations as angles."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from math import cos, sin

_WITH_COMMA = re.compile(r"[-+]?\d*,\d+([eE][-+]?\d+)?")
_FRACTION = re.compile(r"[.,](\d+)")
_EPOCH = datetime(1970, 1, 1, tzinfo=UTC)


def read_number(text: str, has_commas: bool) -> float:
    """Return a number; with ``has_commas``, it may have a decimal comma. Raises ``ValueError``."""
    return float(text.replace(",", ".") if has_commas and _WITH_COMMA.fullmatch(text.strip()) else text)


def read_date(text: str) -> int:
    """Return a date and a time by ISO 8601 in ns since 1970; without a zone, they are in UTC. Raises ``ValueError``."""
    match = _FRACTION.search(text)
    digits = match[1] if match else ""
    moment = datetime.fromisoformat(text.strip() if match is None else text.replace(match[0], "", 1).strip())
    whole = (moment if moment.tzinfo else moment.replace(tzinfo=UTC)) - _EPOCH
    return (whole.days * 86400 + whole.seconds) * 10**9 + int(f"{digits[:9]:0<9}")


def quaternion_of(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Return the quaternion (w, x, y, z) of turns (rad) about the fixed axes x, y and z, in this order (REP 103)."""
    (a, d), (b, e), (c, f) = ((cos(angle / 2), sin(angle / 2)) for angle in (roll, pitch, yaw))
    return (
        a * b * c + d * e * f,
        d * b * c - a * e * f,
        a * e * c + d * b * f,
        a * b * f - d * e * c,
    )
