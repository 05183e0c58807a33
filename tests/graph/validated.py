"""Models for tests of validation, and their findings."""

from graph.statements import built
from kit import EVENTS, STORY, TEMPLATE, assert_diagnostics, fixture
from robbdd_tools.base.diagnostic import Diagnostic
from robbdd_tools.graph.shapes.validate import validate
from robbdd_tools.graph.write.build import build_graph

SETS = TEMPLATE.replace("var goal", "var goal\n    set var goals").replace(
    "        in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    "        ( in-tray: holds(<part> is located at <goal>, after <place-end>)\n"
    "          and ( var y exists in <goals> ) such that { some: holds(<part> is located at <y>, after <end>) } )",
)
CHOICES = STORY[STORY.index("                var ") : STORY.index("        }\n}")]
HEAD = "ns env = 'https://example.org/env/'\n"


def findings(text: str) -> list[Diagnostic]:
    return validate(built(text))


def check(text: str) -> None:
    case = fixture(text)
    assert_diagnostics(validate(build_graph(case.snapshot, case.uri)), case)


def story(variation: str, template: str = TEMPLATE) -> str:
    return EVENTS + template + STORY.replace(CHOICES, variation)


def scene(text: str) -> str:
    return f"//- lab.scene\n{HEAD}{text}"
