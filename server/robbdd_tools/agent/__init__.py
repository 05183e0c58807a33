"""The process that executes scenarios: behave, its steps, the course of behaviours, messages to the parent."""
