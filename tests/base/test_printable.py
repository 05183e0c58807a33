"""What is printed of texts by others acts on no terminal and no CI service."""

from __future__ import annotations

import ast
import json
from xml.etree import ElementTree

import pytest

from robbdd_tools.base.printable import printable, printable_json, printable_python, printable_xml


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("\x1b[31mred\x1b[0m", r"\x1b[31mred\x1b[0m"),
        ("\x9b31m \x85 \x7f \x00", r"\x9b31m \x85 \x7f \x00"),
        ("one\r\ntwo\tthree", r"one\r\ntwo\tthree"),
        ("a \u202egpj.exe \u2066 \ufeff \u2028", r"a \u202egpj.exe \u2066 \ufeff \u2028"),
        ("\udc80 \ud800", r"\udc80 \ud800"),
        ("\uffff \U000e0041", r"\uffff \U000e0041"),
        ("::error::forged", r"\x3a:error::forged"),
        ("  ::error::forged", r"  \x3a:error::forged"),
        ("x ##[error]y ##vso[task.complete]", r"x #\x23[error]y #\x23vso[task.complete]"),
    ],
)
def test_what_would_act_is_escaped(text: str, shown: str) -> None:
    assert printable(text) == shown


@pytest.mark.parametrize(
    "text",
    [
        "",
        "<thing> is [bold] {x}",
        "größer als 5 µm − 日本語",
        "👩\u200d💻",
        "می\u200cخواهم",
        "std::vector ## x [1]",
        r"C:\new",
    ],
)
def test_ordinary_text_stays(text: str) -> None:
    assert printable(text) == text


@pytest.mark.parametrize("indent", [None, 1])
def test_json_is_read_as_the_same(indent: int | None) -> None:
    document = {"\x1b": ["\x9b\x7f", "\u202e", "\ud800", "ü 日本 \U000e0041 \xa0", "a\n::error::b ##[error]c", 1.5]}
    text = printable_json(document, indent)
    assert json.loads(text) == document
    assert all(printable(line) == line for line in text.split("\n"))
    assert "ü 日本" in text


COMMANDS = "a ##vso[task.complete]b\n  ::error::c\n::d ##[group]"


def commands_in(text: str) -> list[str]:
    return [line for line in text.split("\n") if line.lstrip().startswith("::") or "##[" in line or "##vso[" in line]


def test_documents_hold_no_command_and_are_read_as_the_same() -> None:
    root = ElementTree.Element("a", b=COMMANDS.replace("\n", " "))
    root.text = COMMANDS
    xml = ElementTree.tostring(root, encoding="unicode")
    assert commands_in(xml)
    shown = ElementTree.fromstring(printable_xml(xml))
    assert commands_in(printable_xml(xml)) == []
    assert (shown.text, shown.get("b")) == (root.text, root.get("b"))
    code = f'"""{COMMANDS}"""'
    assert commands_in(printable_python(code)) == []
    assert ast.literal_eval(printable_python(code)) == COMMANDS
