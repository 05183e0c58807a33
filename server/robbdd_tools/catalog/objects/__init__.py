"""Object models of the simulated world, one per file."""
