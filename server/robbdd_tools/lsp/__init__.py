"""The language server. It converts, publishes and schedules, but contains no knowledge of the language itself."""
