"""Robots, one per file."""
