"""The language server. It converts, publishes and schedules, but knows nothing of the language itself."""
