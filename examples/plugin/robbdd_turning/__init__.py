"""Predicates about turning objects, for RobBDD."""
