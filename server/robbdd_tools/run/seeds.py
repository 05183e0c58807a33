"""Random seed of one execution."""

from __future__ import annotations

import hashlib


def scenario_seed(seed: int, variant: str, number: int, repetition: int = 1) -> int:
    """Return the random seed of one execution of a scenario.

    The seed is the first 32 bits of a SHA-256 digest of the run's seed, the IRI of the variant and the number of the
    scenario. From the second repetition on, the number of the repetition is appended. So each execution has its own
    random stream, which does not depend on the other executions of the run. For a shared execution, the IRI and the
    number are those of the behaviour tree and its execution.
    """
    words = f"{seed} {variant} {number}" + (f" {repetition}" if repetition > 1 else "")
    return int.from_bytes(hashlib.sha256(words.encode()).digest()[:4], "big")
