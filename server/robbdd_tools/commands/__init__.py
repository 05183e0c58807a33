"""The command line's commands, one file each: all that prints is here. Same layer as ``cli``."""

OK, FINDINGS, FAILED, INTERRUPTED = 0, 1, 2, 130
"""Exit codes: all well; errors found, or a clause that does not hold; the work could not be done; Ctrl-C."""
