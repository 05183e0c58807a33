"""What a run and its agent processes share: the manifest, the messages, the names of files in a run folder."""
