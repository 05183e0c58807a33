"""Things of the simulated world, one per file."""
