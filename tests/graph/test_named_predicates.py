"""Predicates that a model defines: triples, text, sentences, manifest, steps that a person writes."""

from __future__ import annotations

import json

from gherkin_kit import feature, pieces
from graph.statements import built, of
from graph.test_text import assert_identity
from kit import EVENTS, STORY, TEMPLATE, fixture
from robbdd_tools.features.hover import hover
from robbdd_tools.features.rename import rename
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.judging.parsed_sentences import read_clause
from robbdd_tools.protocol.clauses import Fluent, Statement, from_plain, to_plain

DEFINITION = """Predicate (ns=t) <thing> is-put at <place> by <robot>: (
    ( <thing> is located at <place> or <thing> is near-to <place> by 5 cm )
    and ( not <thing> is held by <robot> )
)
Predicate (ns=t) <thing> near-to <place> by <limit>: <thing> is nearer than <limit> to <place>
""".replace("<thing> is near-to", "<thing> near-to")
CLAUSE = "in-tray: holds(<part> is-put at <goal> by <robot>, within 2 seconds after <place-end>)"
GIVEN = "on-bench: holds(<part> is-put at <source> by <robot>, before <pick-start>)"
OLD = "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)"
EVENT = "    event put when <part> is-put at <goal> by <robot> and <part> is at rest for 0.5 seconds\n    Given:"
WHOLE = EVENTS + DEFINITION + TEMPLATE.replace(OLD, CLAUSE).replace("    Given:", EVENT) + STORY


def stated() -> list[Statement]:
    scenario = next(piece.scenario for piece in pieces(WHOLE) if piece.scenario)
    return [step.statement for step in scenario.steps]


def test_the_definition_is_a_node_and_a_clause_refers_to_it() -> None:
    graph = built(WHOLE).graph
    assert "a rbw:NamedPredicate" in of(graph, "t:is-put")
    assert {"rbw:named-predicate t:is-put", "rbw:argument-list (t:var-part t:var-goal t:var-robot)"} < {
        *of(graph, "t:in-tray")
    }


def test_the_text_of_the_graph_has_the_same_graph() -> None:
    assert_identity(built(WHOLE).graph)


def test_the_graph_fits_the_shapes() -> None:
    assert validate(built(WHOLE)) == []


def test_a_feature_states_what_a_phrase_means_with_its_values() -> None:
    text = feature(WHOLE)
    meaning = [line for line in text.splitlines() if " means " in line and "is-put" in line][-1]
    assert meaning.strip() == (
        '# "env:nut" is-put at "env:tray_ws" by "env:panda" means ( "env:nut" is located at "env:tray_ws" or '
        '"env:nut" is nearer than "5 cm" to "env:tray_ws" ) and not ( "env:nut" is held by "env:panda" )'
    )


def test_a_clause_is_the_same_after_the_manifest() -> None:
    fluents = [one for one in stated() if isinstance(one, Fluent) and one.predicate.name.endswith("is-put")]
    assert fluents
    for fluent in fluents:
        assert from_plain(json.loads(json.dumps(to_plain(fluent)))) == fluent


def test_a_person_may_write_the_phrase_with_other_values() -> None:
    known = next(one for one in stated() if isinstance(one, Fluent) and one.predicate.name.endswith("is-put"))
    text = '"a" is-put at "b" by "c" whenever "a" is-put at "d" by "c" after event "t:end"'
    assert not isinstance(read_clause(text), Fluent)
    found = read_clause(text, named=[known.predicate])
    assert isinstance(found, Fluent)
    assert found.arguments == {"thing": "a", "place": "b", "robot": "c"}
    assert found.condition is not None
    assert found.condition.arguments["place"] == "d"


def test_hover_shows_the_definition_and_what_the_parameters_take() -> None:
    planted = fixture(WHOLE.replace("holds(<part> is-put", "holds(<part> is-p$0ut", 1))
    shown = hover(planted.snapshot, planted.uri, planted.cursor)
    assert shown is not None
    assert "is located at" in shown.markdown
    assert "`place`: workspace" in shown.markdown


def test_a_predicate_and_its_parameters_are_renamed_everywhere() -> None:
    planted = fixture(WHOLE.replace("holds(<part> is-put", "holds(<part> is-p$0ut", 1))
    edits = rename(planted.snapshot, planted.uri, planted.cursor, "is-set")
    assert len(edits) == WHOLE.count("is-put")
    inner = fixture(WHOLE.replace("Predicate (ns=t) <thing> is-put", "Predicate (ns=t) <th$0ing> is-put", 1))
    assert len(rename(inner.snapshot, inner.uri, inner.cursor, "it")) == 4
