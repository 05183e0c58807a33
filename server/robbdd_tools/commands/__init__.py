"""The commands of the command line, one file each. Only this package prints. It is in the layer of ``cli``."""

OK, FINDINGS, FAILED, CANNOT_TELL = 0, 1, 2, 3
"""Exit codes: success; errors, or a clause that does not hold; failure of the command; more executions are needed."""


def signal_code(number: int) -> int:
    """Return the exit code of a command that a signal ended. The code is the one that shells compute."""
    return 128 + number
