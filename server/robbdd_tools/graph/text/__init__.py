"""From RDF to RobBDD text, and what that text cannot say."""
