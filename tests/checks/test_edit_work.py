"""The work of the rules after an edit does not grow with the rest of the file."""

import pytest

from checks.test_memo import SCENARIO, URI, project
from kit import MODEL
from robbdd_tools.features.diagnostics import fast_diagnostics
from robbdd_tools.names.resolve import Targets
from robbdd_tools.syntax import symbols
from robbdd_tools.syntax.tree import Node, Ref


def model(count: int) -> str:
    """Return a model with ``count`` scenarios in one story, and a named predicate that the template uses."""
    scenarios = "".join(SCENARIO.replace("bench-to-tray", f"variant-{number}") for number in range(count))
    predicate = "Predicate (ns=t) <thing> is-stored in <bin>: ( <thing> is located at <bin> )\n"
    text = MODEL.replace(SCENARIO, scenarios).replace("Event (ns=t) end", f"{predicate}Event (ns=t) end")
    changed = text.replace("<part> is located at <goal>, 0.5", "<part> is-stored in <goal>, 0.5")
    assert changed != text
    return changed


def work_after_edit(count: int, patch: pytest.MonkeyPatch) -> tuple[int, int]:
    """Return the syntax nodes and the definitions that are visited when the last scenario of a story is edited."""
    nodes, definitions = 0, 0
    children, target = symbols.children, Targets.__getitem__

    def counted_children(node: Node) -> object:
        nonlocal nodes
        nodes += 1
        return children(node)

    def counted_target(self: Targets, ref: Ref) -> object:
        nonlocal definitions
        definitions += 1
        return target(self, ref)

    opened, text = project(), model(count)
    opened.open(URI, 1, text)
    fast_diagnostics(opened.snapshot(), URI)
    edited = text.replace(f"variant-{count - 1}", f"edited-of-{count}")  # a text that no cache has
    opened.open(URI, 2, edited)
    with patch.context() as context:
        context.setattr(symbols, "children", counted_children)
        context.setattr(Targets, "__getitem__", counted_target)
        fast_diagnostics(opened.snapshot(), URI)
    return nodes, definitions


def test_rules_visit_the_edited_scenario_only(monkeypatch: pytest.MonkeyPatch) -> None:
    few, many = work_after_edit(5, monkeypatch), work_after_edit(40, monkeypatch)
    assert few[0] > 0
    assert few[1] > 0
    assert many == few
