"""Data that a run and its agent processes share: the manifest, the messages, and the names of files in a run folder."""
