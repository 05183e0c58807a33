"""Data shared by a run and its agent processes: the manifest, the messages, the names of files in a run folder."""
