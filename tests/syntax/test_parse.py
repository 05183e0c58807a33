"""One chunk is parsed to a tree; on errors, the tree keeps its names."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kit import MODEL
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.parse import parse_declaration
from robbdd_tools.syntax.symbols import walk


def parse(text: str, language: str = "bdd") -> tree.ChunkTree:
    declaration = parse_declaration(language, text)
    assert declaration.faults == ()
    assert declaration.tree is not None
    return declaration.tree


def faults(text: str, language: str = "bdd") -> list[tuple[str, str]]:
    declaration = parse_declaration(language, text)
    return [(text[fault.span.start : fault.span.end], fault.message) for fault in declaration.faults]


def template(clause: str) -> str:
    return f"Scenario Template (ns=t) x {{ var a Given: {clause} When: Behaviour (ns=t) b {{ {CARRY} }} }}"


CARRY = "duration: from <s> until <e> <r> picks <a>"


def clause(text: str) -> tree.Expression:
    root = parse(template(text))
    assert isinstance(root, tree.Template)
    assert root.body.parts[0].given is not None
    return root.body.parts[0].given


@pytest.mark.parametrize(
    ("text", "value"),
    [("3", 3), ("-0.5", -0.5), ("1e3", 1000.0), ('"a \\"b\\" \\n"', 'a "b" \n'), ("'it\\'s'", "it's")],
)
def test_literals_have_their_values(text: str, value: object) -> None:
    root = parse(f"const set (ns=t) s {{ {text} }}")
    assert isinstance(root, tree.ConstantSet)
    assert [getattr(entry, "value", None) for entry in root.values] == [value]


def test_a_reference_has_the_span_of_its_path() -> None:
    text = "comp (ns=e) c of ws < places.a_ws > { obj <b.c> }"
    refs = [node for node in walk(parse(text, "scene")) if isinstance(node, tree.Ref)]
    assert {(ref.role, text[ref.span.start : ref.span.end]) for ref in refs} == {
        ("Namespace", "e"),
        ("Workspace", "places.a_ws"),
        ("Object", "b.c"),
    }


def test_every_predicate_of_the_catalog_is_read_by_its_phrase() -> None:
    found = clause("( a: holds(<x> is held by <y>, before <e>) and b: holds(<x> can reach <y>, after <e>) )")
    words = [node.word for node in walk(found) if isinstance(node, tree.PhraseUse)]
    assert words == ["held-by", "can-reach"]


def test_a_configuration_keeps_its_bare_name() -> None:
    found = clause("c: holds(<x> has config ee_speed = <v>, 0.5 seconds before <e>)")
    assert isinstance(found, tree.Fluent)
    assert isinstance(found.predicate, tree.PhraseUse)
    assert [(slot, getattr(part, "path", getattr(part, "text", ""))) for slot, part in found.predicate.arguments] == [
        ("target", "x"),
        ("name", "ee_speed"),
        ("value", "v"),
    ]


def test_expressions_nest() -> None:
    fluent = "a{}: holds(<x> is held by <y>, from <e> until <f>)"
    parts = [fluent.format(index) for index in range(3)]
    found = clause(f"( {parts[0]} or ( not {parts[1]} ) or ( {parts[2]} ) )")
    assert isinstance(found, tree.Disjunction)
    assert [type(operand) for operand in found.operands] == [tree.Fluent, tree.Negation, tree.Conjunction]


@pytest.mark.parametrize("layout", [" ", "\n"])
@pytest.mark.parametrize(("one", "other"), [("and", "or"), ("or", "and")])
def test_and_is_not_mixed_with_or_in_one_parenthesis(one: str, other: str, layout: str) -> None:
    first, second, third = (f"a{number}: holds(<x> is held by <y>, before <e>)" for number in range(3))
    text = template(layout.join(("(", first, one, second, other, third, ")")))
    assert [found for found, _ in faults(text)] == [other]


def test_keywords_need_a_boundary() -> None:
    assert faults(template("a: holds(<x> islocated at <y>, before <e>)"))[0][0] == "islocated at <y>"


def test_a_table_row_may_break_over_lines() -> None:
    text = MODEL[MODEL.index("User Story") :]
    table = "| <fetch.part> |\n <fetch.goal> |\n |---|\n | <parts.bolt> | { 1, 'x' } |\n | set <s> |\n 2.5 |"
    root = parse(text[: text.index("var <fetch.part>")] + table + "} }")
    assert isinstance(root, tree.Story)
    variation = root.variants[0].variation
    assert isinstance(variation, tree.Table)
    assert [len(row.cells) for row in variation.rows] == [2, 2]


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("Event (ns=t)", "(ns=t)", "ends too early: expected a name"),
        ("Event (ns t) e", "t", "expected '='"),
        ("Event (ns=t) e extra", "extra", "after the end of the declaration"),
        ("Evnt (ns=t) e", "Evnt", "does not begin a declaration"),
        ("const set (ns=t) s { <> }", ">", "the name of an element"),
    ],
)
def test_a_fault_names_its_place_and_what_was_expected(text: str, place: str, words: str) -> None:
    ((found, message),) = faults(text)
    assert found == place
    assert words in message


@pytest.mark.parametrize(
    ("kind", "part", "message"),
    [
        ("scenex", "kgraph (ns=t) poses { }", "'kgraph' belongs inside 'scene inst … { … }': move it there"),
        ("scenex", "agn <arms.one> { }", "'agn' belongs inside 'scene inst … { … }': move it there"),
        ("scenex", "scene: <cell>", "'scene' belongs inside 'scene inst … { … }': move it there"),
        ("scenex", "body room { }", "'body' belongs inside 'ktree … { … }' or 'kgraph … { … }': move it there"),
        ("scenex", "variant: <x>", "'variant' belongs inside 'Scenario Exec … { … }' of a .bddx file: move it there"),
        ("scene", "correct for: x", "'correct' belongs inside 'ws set … { … }': move it there"),
        ("scene", "object cube", "'object' belongs inside 'obj set … { … }': move it there"),
        ("bdd", "Given: x", "'Given' belongs inside 'Scenario Template … { … }' or 'Scenario … { … }': move it there"),
        ("bdd", "Behaviour (ns=t) b { }", "'Behaviour' belongs inside 'Scenario Template … { … }': move it there"),
        ("bdd", "Scenario s { }", "'Scenario' belongs inside 'User Story … { … }': move it there"),
        ("bdd", "kgraph (ns=t) g { }", "'kgraph' belongs inside 'scene inst … { … }' of a .scenex file: move it there"),
        (
            "bddx",
            "Scenario Execution (ns=t) x { }",
            "'Scenario' does not begin a declaration here: write 'Scenario Exec'",
        ),
        ("bddx", "obs (ns=t) x { }", "'obs' does not begin a declaration here: write 'obs provider'"),
        ("bdd", "nonsense", "unexpected 'nonsense' after the end of the declaration"),
    ],
)
def test_a_part_outside_of_its_declaration_is_told_where_it_belongs(kind: str, part: str, message: str) -> None:
    before = "ns t = 'https://example.org/t/'\n"
    (fault,) = parse_declaration(kind, before + part).faults
    assert (fault.span.start, fault.message) == (len(before), message)


def test_a_part_behind_the_end_of_its_declaration_asks_for_the_braces() -> None:
    text = (
        "Scenario Template (ns=t) a { var b When: event <e> occurs <b> picks <b> Then: <b> is at rest after <e> } var c"
    )
    (fault,) = parse_declaration("bdd", text).faults
    assert fault.message == "'var' belongs inside the 'Scenario Template', which ends before it: check the braces"


def test_a_broken_declaration_keeps_its_names() -> None:
    text = "Scenario Template (ns=t) fetch { var a set var b Given: f: holds(<a> is nowhere"
    paths = [symbol.path for symbol in parse_declaration("bdd", text).symbols]
    assert paths == ["fetch", "fetch.a", "fetch.b", "fetch.f"]


@given(st.data())
def test_no_text_raises(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(MODEL)))
    end = data.draw(st.integers(start, min(len(MODEL), start + 200)))
    inserted = data.draw(st.text(alphabet="<>(){}\"'|:,.- \nabcEvents\u20ac\U0001f916", max_size=12))
    text = MODEL[:start] + inserted + MODEL[end:]
    declaration = parse_declaration("bdd", text)
    assert all(0 <= fault.span.start <= fault.span.end <= len(text) for fault in declaration.faults)
