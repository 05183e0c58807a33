"""Graph to Gherkin: variations expanded, sentences from the catalog, text by Jinja templates."""
