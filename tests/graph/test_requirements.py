"""Requirements in the graph, as text again, and in Gherkin."""

from checks.test_requirements import CLAUSE, NEED
from graph.statements import statements
from graph.test_text import assert_identity
from kit import EVENTS, STORY, fixture
from robbdd_tools.gherkin.feature import feature_pieces
from robbdd_tools.graph.read.acceptance import read_model
from robbdd_tools.graph.write.build import build_graph

FULL = NEED.replace(" source", ' id: "SYS 4.1/a" source') + 'Requirement (ns=t) R-2 { "Two\\nlines, \\"quoted\\"." }\n'
TEXT = (
    EVENTS
    + FULL
    + CLAUSE.replace("    var", "    verifies: <R-2>\n    var", 1)
    + STORY.replace("Scenarios:", "verifies: <R-1>\n    Scenarios:").replace(
        "scene>\n", "scene>\n verifies: <R-2>, <R-1>\n"
    )
)
LINKS = {
    ("t:in-tray", "t:R-1"),
    ("t:fetch", "t:R-2"),
    ("t:fetching", "t:R-1"),
    ("t:bench-to-tray", "t:R-1"),
    ("t:bench-to-tray", "t:R-2"),
}


def test_each_link_is_a_triple_and_survives_the_way_back() -> None:
    case = fixture(TEXT)
    graph = build_graph(case.snapshot, case.uri).graph
    links = (line.split(" rbw:verifies ") for line in statements(graph) if " rbw:verifies " in line)
    assert {(first, second) for first, second in links} == LINKS
    assert_identity(graph)


def test_requirements_are_tags_of_features_and_scenarios() -> None:
    case = fixture(TEXT)
    model = read_model(build_graph(case.snapshot, case.uri).graph)
    text = "".join(piece.text for piece in feature_pieces(model, model.stories[0]))
    tags = [line.split() for line in text.splitlines() if "@" in line]
    one, two = "@requirement=https:;;example.org;t;R-1", "@requirement=https:;;example.org;t;R-2"
    assert one in tags[0]
    assert two not in tags[0]
    assert len(tags) > 1
    assert all({one, two} <= set(line) for line in tags[1:])
