"""Predicates of fluents, one per file."""
