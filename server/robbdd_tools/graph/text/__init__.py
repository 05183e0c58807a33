"""Write RDF as RobBDD text, and report what the text cannot express."""
