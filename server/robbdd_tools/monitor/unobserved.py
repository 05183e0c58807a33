"""Missing evidence: something was not observed when it was needed."""

from __future__ import annotations


class Unobserved(Exception):
    """There is no observation on which to judge. The message gives the reason."""
