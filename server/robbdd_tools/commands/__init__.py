"""The command line's commands, one file each: all that prints is here. Same layer as ``cli``."""
