"""From RDF to plain data: acceptance criteria, executions, scenes, variations."""
