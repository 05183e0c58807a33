"""The commands of the command line, one file each. All printing is done here.

This package is in the layer of ``cli``.
"""

OK, FINDINGS, FAILED, CANNOT_TELL = 0, 1, 2, 3
"""Exit codes: success; errors found, or a clause that does not hold; the command could not do its work; more
executions are needed to tell."""


def signal_code(number: int) -> int:
    """Return the exit code of a command that a signal ended. The code is the one that shells compute."""
    return 128 + number
