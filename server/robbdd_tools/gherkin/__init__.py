"""Write Gherkin from the graph's data: expand variations, take sentences from the catalog, render Jinja templates."""
