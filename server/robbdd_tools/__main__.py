"""``python -I -m robbdd_tools``: the command line, with an interpreter that ignores the environment."""

from robbdd_tools.start import robbdd

raise SystemExit(robbdd())
