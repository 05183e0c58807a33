"""Language features for editors and the command line, one pure function per file."""
