"""Launch, cancel and store runs. This package never imports the agent."""
