"""The commands of the command line, one file each. All printing is here. Same layer as ``cli``."""

OK, FINDINGS, FAILED = 0, 1, 2
"""Exit codes: success; errors found, or a clause that does not hold; the command could not do its work."""


def signal_code(number: int) -> int:
    """Return the exit code of a command ended by a signal, as shells compute it."""
    return 128 + number
