"""What editors and the command line ask of a snapshot, one pure function per file."""
