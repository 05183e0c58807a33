"""The extension's hand-written snippets are valid where they are offered, as inserted."""

from __future__ import annotations

import json
import re
from typing import Any

import pytest

from kit import ROOT
from robbdd_tools.syntax.parse import parse_declaration

BODY = "Scenario Template (ns=t) fetch {\n    task: <task>\n    var part\n%s\n}\n"
THEN = BODY % "    When:\n        <robot> picks <part> and places at <goal>\n    Then:\n%s"
STORY = 'User Story (ns=t) s {\n    As A "a" I Want "b" So That "c"\n    Scenarios:\n%s\n}\n'
VARIANT = (
    STORY
    % "        Scenario v {\n            template: <t>\n            scene: <s>\n            variation:\n%s\n        }"
)
PLACES = {
    "Fluent": THEN,
    "Located at": THEN % "f: holds(%s, before <e>)",
    "Held by": THEN % "f: holds(%s, before <e>)",
    "Does not collide": THEN % "f: holds(%s, before <e>)",
    "For all": BODY,
    "Exists": THEN,
    "Scenario variant": STORY,
    "Variation table": VARIANT,
    "Model": "scene inst (ns=t) i {\n    scene: <s>\n%s\n}\n",
    "Body": "ktree (ns=t) k {\n    root: <world>\n%s\n}\n",
}
"""Place of a snippet in a declaration; a snippet not listed here is a declaration."""


def snippets() -> list[tuple[str, str, str]]:
    """The kind of file, the name and the body of each."""
    found: list[tuple[str, str, str]] = []
    for path in sorted((ROOT / "client-vscode" / "snippets").glob("*.json")):
        entries: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        for name, entry in entries.items():
            body = entry["body"]
            found.append((path.stem, name, body if isinstance(body, str) else "\n".join(body)))
    return found


def inserted(body: str) -> str:
    """The inserted text with all placeholders unfilled; a repeated placeholder repeats its first text."""
    defaults: dict[str, str] = dict(re.findall(r"\$\{(\d+):([^}]*)\}", body))
    text = re.sub(r"\$\{\d+\|([^,|]*)[^}]*\}", r"\1", body)
    return re.sub(r"\$\{?(\d+)(?::[^}]*)?\}?", lambda match: defaults.get(match[1], ""), text)


@pytest.mark.parametrize(("language", "name", "body"), snippets())
def test_a_snippet_is_sound_where_it_stands(language: str, name: str, body: str) -> None:
    text = PLACES.get(name, "%s") % inserted(body)
    assert [fault.message for fault in parse_declaration(language, text).faults] == [], text
