"""What is sent to the validation process."""

from __future__ import annotations

from robbdd_tools.graph.shapes.project_shapes import EditorShapes
from robbdd_tools.lsp.framing import Request, frame
from robbdd_tools.names.project import Project


def test_a_text_that_many_requests_name_is_sent_once() -> None:
    project = Project()
    text = "// a long text\n" * 1000
    project.open("file:///long.scene", 1, text)
    requests = [Request(number, f"file:///{number}.bdd", project.texts(), EditorShapes()) for number in range(20)]
    assert len(frame(tuple(requests))) < 2 * len(text)
