"""The process that executes scenarios: behave and its steps, the course of behaviours, messages to the parent."""
