"""Snippets of parts of declarations. Completion offers one only where the grammar accepts its whole text."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from robbdd_tools.features.snippets import Snippet

_FLUENT = "holds(<${2:object}> is located at <${3:workspace}>, ${4|before,after|} <${5:event}>)"
_BDD = (
    Snippet("name: holds(…)", f"${{1:name}}: {_FLUENT}"),
    Snippet(
        "event name when …",
        "event ${1:name} when <${2:one}> is nearer than ${3:0.5} ${4|m,cm,mm|} to <${5:other}>",
    ),
    Snippet(
        "for all (…) { When: … Then: … }",
        "for all (var ${1:x} in <${2:set}>) {\n"
        "    When:\n"
        "        <${3:agent}> picks <${1:x}> and places at <${4:workspace}>\n"
        "    Then:\n"
        "        ${5:name}: holds(<${1:x}> is located at <${4:workspace}>, after <${6:event}>)\n"
        "}",
    ),
    Snippet(
        "(var … exists in <…>) such that { … }",
        "(var ${1:y} exists in <${2:set}>) such that {\n"
        "    holds(<${3:object}> is located at <${1:y}>, after <${4:event}>)\n"
        "}",
    ),
    Snippet("(not …)", f"(not ${{1:name}}: {_FLUENT})"),
    Snippet(
        "(… and …)",
        "(${1:one}: holds(<${2:object}> is located at <${3:workspace}>, ${4|before,after|} <${5:event}>)\n"
        "    ${6|and,or|} ${7:other}: holds(<${2:object}> is held by <${8:agent}>, ${9|before,after|} <${10:event}>))",
    ),
    Snippet(
        "Scenario name { … }",
        "Scenario ${1:name} {\n"
        "    template: <${2:template}>\n"
        "    scene: <${3:scene}>\n"
        "    variation:\n"
        "        var <${4:template.variable}>: { <${5:element}> }\n"
        "}",
    ),
    Snippet(
        "| <…> | <…> | table",
        "| <${1:template.variable}> | <${2:template.other}> |\n|---|---|\n| <${3:object}> | <${4:workspace}> |",
    ),
)
_SCENEX = (
    Snippet("model name as … { … }", "model ${1:name} as ${2|mjcf,urdf,usd|} { sys path = '${3:model.xml}' }"),
    Snippet(
        "body name { frame … }",
        "body ${1:link} {\n"
        "    frame ${2:origin} {\n"
        "        pose ${3:pose} { wrt: <${4:frame}>  xyz: (${5:0}, ${6:0}, ${7:0}) m  "
        "orientation: quat { xyzw: (${8:0}, ${9:0}, ${10:0}, ${11:1}) } }\n"
        "    }\n"
        "}",
    ),
)
PART_SNIPPETS: Mapping[str, tuple[Snippet, ...]] = MappingProxyType({"bdd": _BDD, "scenex": _SCENEX, "ktree": _SCENEX})
"""Kind of file → its snippets."""
