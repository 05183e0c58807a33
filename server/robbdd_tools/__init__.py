"""Behaviour-driven acceptance testing of robots: language, graph, Gherkin, simulation, verdicts."""

__version__ = "0.1.0"
