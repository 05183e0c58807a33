"""The language server: converts, publishes and schedules; it contains no knowledge of the language itself."""
