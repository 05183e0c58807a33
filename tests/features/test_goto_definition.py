"""Definition and hover lead from a use to its declaration, across files and in broken text."""

from kit import MODEL, fixture
from robbdd_tools.features.goto_definition import definition
from robbdd_tools.features.hover import hover


def target(text: str) -> str | None:
    case = fixture(text)
    uri = next(uri for uri in case.project.texts() if uri.endswith("main.bdd"))
    found = definition(case.snapshot, uri, case.cursor)
    if found is None:
        return None
    source = case.project.texts()[found[0]][1]
    line = source.count("\n", 0, found[1].start) + 1
    return f"{found[0].rsplit('/', 1)[-1]}:{line}:{source[found[1].start : found[1].end]}"


def edited(old: str, new: str) -> str:
    assert old in MODEL
    return MODEL.replace(old, new, 1)


def test_a_variable_leads_to_its_template() -> None:
    assert target(edited("<robot> picks", "<rob$0ot> picks")) == "main.bdd:12:robot"
    assert target(edited("<fetch.robot>", "<fetch.ro$0bot>")) == "main.bdd:12:robot"


def test_an_element_leads_into_the_imported_scene() -> None:
    assert target(edited("<places.tray_ws>", "<places.tray_ws$0>")) == "lab.scene:5:tray_ws"


def test_each_part_of_a_qualified_name_leads_to_what_it_stands_for() -> None:
    assert target(edited("<places.tray_ws>", "<pla$0ces.tray_ws>")) == "lab.scene:5:places"
    assert target(edited("<fetch.robot>", "<fet$0ch.robot>")) == "main.bdd:8:fetch"


def test_the_sound_part_of_a_name_that_leads_nowhere_still_leads_on() -> None:
    assert target(edited("<places.tray_ws>", "<pla$0ces.trai_ws>")) == "lab.scene:5:places"
    assert target(edited("<places.tray_ws>", "<places.tra$0i_ws>")) is None


def test_an_import_leads_to_its_file() -> None:
    assert target(edited('"lab.scene"', '"lab$0.scene"')) == "lab.scene:1:"


def test_a_declaration_leads_to_itself() -> None:
    assert target(edited("Event (ns=t) start", "Event (ns=t) st$0art")) == "main.bdd:4:start"


def test_names_in_broken_text_still_lead_somewhere() -> None:
    assert target(edited("task: <task>", "task <ta$0sk>")) == "main.bdd:3:task"


def test_nowhere_leads_nowhere() -> None:
    assert target(edited("So That", "So T$0hat")) is None


def test_hover_tells_kind_and_iri() -> None:
    case = fixture(edited("<parts>", "<par$0ts>"))
    found = hover(case.snapshot, case.uri, case.cursor)
    assert found is not None
    assert found.markdown.split("\n\n") == [
        "**object set** `parts`",
        "2 elements: `parts.bolt`, `parts.nut`",
        "`<https://example.org/env/parts>`",
        "used 2 times: lab.scene:9, main.bdd:31",
    ]


def test_hover_explains_a_phrase() -> None:
    case = fixture(edited("is located at", "is loc$0ated at"))
    found = hover(case.snapshot, case.uri, case.cursor)
    assert found is not None
    assert found.markdown.startswith("`<object> is located at <workspace>`\n\n")
