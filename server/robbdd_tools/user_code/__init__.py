"""Call users' code that accompanies a model; only the agent process imports this package."""
