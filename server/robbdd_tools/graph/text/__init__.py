"""Write RDF as RobBDD text, and report statements that the text cannot express."""
