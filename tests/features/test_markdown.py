"""Users' text in hovers loads nothing and leads nowhere."""

from __future__ import annotations

import pytest

from robbdd_tools.features.hover import hover
from robbdd_tools.features.markdown import code, code_block, literal
from robbdd_tools.names.project import Project


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("![x](https://e.example/x.png)", r"\!\[x\](https://e.example/x.png)"),
        ("[go](command:evil)", r"\[go\](command:evil)"),
        ("[x]: https://e.example", r"\[x\]: https://e.example"),
        ("<img src=https://e.example/x>", "`<img src=https://e.example/x>`"),
        ("<https://e.example> <command:evil>", "<https://e.example> `<command:evil>`"),
        ("<img\nsrc=x>", "\\<img\nsrc=x\\>"),
        ("the <part> and `<b>`", "the `<part>` and `<b>`"),
        ("`a\n\n![x](y)`", "\\`a\n\n\\!\\[x\\](y)\\`"),
        (r"\`![x](y)`", r"\\`![x](y)`"),
        ("``` ![x](y)", r"\`\`\` \!\[x\](y)"),
        ("&#33;&lsqb;", r"\&#33;\&lsqb;"),
        ("a_name is 5 cm - or less", "a_name is 5 cm - or less"),
    ],
)
def test_text_is_shown_as_it_is_written(text: str, shown: str) -> None:
    assert literal(text) == shown


def test_code_ends_only_where_it_ends() -> None:
    assert code("part") == "`part`"
    assert code("a`![x](y)`b\n\nc") == "`` a`![x](y)`b  c ``"
    assert code_block("a\n```\n![x](y)", "bdd") == "````robbdd\na\n```\n![x](y)\n````"


def test_a_comment_above_a_name_loads_no_picture() -> None:
    text = (
        "ns x = 'https://example.org/x/'\n// ![i](https://e.example/x.png) [go](command:evil)\nEvent (ns=x) evt-start\n"
    )
    project = Project()
    project.open("file:///t/p.bdd", 1, text)
    found = hover(project.snapshot(), "file:///t/p.bdd", text.index("evt-start"))
    assert found is not None
    assert r"\!\[i\](https://e.example/x.png) \[go\](command:evil)" in found.markdown
