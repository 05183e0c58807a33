"""Read RDF into plain data: acceptance criteria, executions, scenes, variations."""
