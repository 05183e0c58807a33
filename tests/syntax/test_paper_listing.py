"""The listing of the paper, as it is printed."""

from kit import fixture
from robbdd_tools.base.diagnostic import Severity
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.graph.rdf.serialize import serialize
from robbdd_tools.graph.write.build import build_graph

SCENE_OF_PAPER = """ns lab = 'https://example.org/lab/'
obj set (ns=lab) lab_objects { object cube1, object ball1 }
obj set (ns=lab) ws_objects { object table, object bin1 }
ws set (ns=lab) lab_ws { workspace ws-table, workspace ws-bin1 }
agn set (ns=lab) robots { agent panda }
comp (ns=lab) bin1_comp of ws <lab_ws.ws-bin1> { obj <ws_objects.bin1> }
comp (ns=lab) table_comp of ws <lab_ws.ws-table> { obj <ws_objects.table> ws comp <bin1_comp> }
scene (ns=lab) lab_scene { obj set <lab_objects> ws comp <table_comp> agn set <robots> }
"""
AS_PRINTED = """import "lab.scene"
ns bdd_tmpl = 'https://example.org/tmpl/'
ns bdd = 'https://example.org/bdd/'
Event pickup_start
Event pick_start
Event place_end
Scenario Template (ns=bdd_tmpl) tmpl_pickplace {
    var target_object
    var pick_ws
    var place_ws
    var agent
    Given: <target_object> is located at <pick_ws> before <pickup_start>
    When: <agent> picks <target_object> and places it at <place_ws>
    Then:
        <agent> does not collide <place_ws> from <pick_start> until <place_end>
        <target_object> is located at <place_ws> after <place_end>
}
User Story (ns=bdd) us_pickplace_lab {
    Scenarios:
        Scenario Variant scr_panda_pickplace {
            template: <tmpl_pickplace>
            scene: <lab_scene>
            <target_object> can be:
                - obj <lab_scene.cube1>
                - obj <lab_scene.ball1>
            <pick_ws> can be:
                - ws <lab_scene.ws-table>
            <place_ws> can be:
                - ws <lab_scene.ws-bin1>
            <agent> can be:
                - agn <lab_scene.panda>
        }
}
"""


def test_the_listing_of_the_paper_is_accepted_as_printed() -> None:
    found = fixture(f"//- paper.bdd\n{AS_PRINTED}//- lab.scene\n{SCENE_OF_PAPER}")
    assert [entry for entry in fast_diagnostics(found.snapshot, found.uri) if entry.severity is Severity.ERROR] == []
    file = found.snapshot.file(found.uri)
    assert file is not None
    assert file.definitions["pickup_start"].iri == "https://example.org/tmpl/pickup_start"
    text = serialize(build_graph(found.snapshot, found.uri).graph, "ttl")
    assert "tmpl:place_end a time:Event" in text
    assert "lab:cube1" in text
    assert "rbw:role" not in text


def test_the_listing_of_the_paper_means_the_same_in_the_current_form() -> None:
    def graph_of(text: str) -> str:
        found = fixture(f"//- paper.bdd\n{text}//- lab.scene\n{SCENE_OF_PAPER}")
        return serialize(build_graph(found.snapshot, found.uri).graph, "nt")

    found = fixture(f"//- paper.bdd\n{AS_PRINTED}//- lab.scene\n{SCENE_OF_PAPER}")
    hints = [entry for entry in fast_diagnostics(found.snapshot, found.uri) if entry.code == "published-form"]
    text = AS_PRINTED
    for edit in sorted((e for h in hints for e in h.fixes[0].edits), key=lambda e: e.span.start, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert "Event (ns=bdd_tmpl) pickup_start" in text
    assert "<lab_objects.cube1>" in text
    assert "lab_scene." not in text
    assert graph_of(text) == graph_of(AS_PRINTED)


def test_an_event_of_templates_in_two_namespaces_has_to_say_which() -> None:
    second = (
        "Scenario Template (ns=bdd) other { var o Given: <o> is located at <o> before <place_end> When: <o> picks <o> }"
    )
    found = fixture(f"//- paper.bdd\n{AS_PRINTED}{second}\n//- lab.scene\n{SCENE_OF_PAPER}")
    missing = [entry for entry in fast_diagnostics(found.snapshot, found.uri) if entry.code == "namespace-missing"]
    assert [entry.message.split(":")[0] for entry in missing] == [
        "this file has 2 namespaces, so 'place_end' must say which"
    ]


def test_an_unused_event_of_a_file_with_two_namespaces_has_to_say_which() -> None:
    found = fixture(f"//- paper.bdd\n{AS_PRINTED}Event unused\n//- lab.scene\n{SCENE_OF_PAPER}")
    codes = [entry.code for entry in fast_diagnostics(found.snapshot, found.uri) if entry.severity is Severity.ERROR]
    assert codes == ["namespace-missing"]
