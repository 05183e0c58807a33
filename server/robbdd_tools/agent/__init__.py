"""The process that executes scenarios: the simulated world, the controllers, behave and its steps."""
