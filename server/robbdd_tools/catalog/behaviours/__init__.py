"""Behaviours of agents, one per file."""
