"""A place in a file that is not a model, such as Python code or a robot's description."""

from __future__ import annotations

from dataclasses import dataclass

from robbdd_tools.base.document import Document, Span


@dataclass(frozen=True, slots=True)
class OutsidePlace:
    """A span in the text of another file, which was read from the disk."""

    uri: str
    text: str
    span: Span

    @property
    def document(self) -> Document:
        """The file as a document."""
        return Document(self.uri, 0, self.text)
