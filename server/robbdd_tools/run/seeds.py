"""Random seed of one execution."""

from __future__ import annotations

import hashlib


def scenario_seed(seed: int, variant: str, number: int, repetition: int = 1) -> int:
    """Return a scenario's seed: the first 32 bits of the SHA-256 of the run's seed, the variant's IRI and its number.

    From the second repetition on, the repetition number is appended. So each execution has its own random stream,
    whatever else is run. For a shared execution, IRI and number are those of the behaviour tree and its execution.
    """
    words = f"{seed} {variant} {number}" + (f" {repetition}" if repetition > 1 else "")
    return int.from_bytes(hashlib.sha256(words.encode()).digest()[:4], "big")
