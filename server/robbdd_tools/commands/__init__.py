"""The command line's commands, one file each: all that prints is here. Same layer as ``cli``."""

OK, FINDINGS, FAILED = 0, 1, 2
"""Exit codes: all well; errors found, or a clause that does not hold; the work could not be done."""


def signal_code(number: int) -> int:
    """Return the exit code of a command that a signal has ended, as shells have it."""
    return 128 + number
