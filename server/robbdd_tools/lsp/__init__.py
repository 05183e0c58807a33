"""The language server: converts, publishes, schedules; knows nothing of the language itself."""
