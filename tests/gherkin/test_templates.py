"""Users' templates: their data, their restrictions, the places of errors."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import psutil
import pytest

from gherkin_kit import edited, feature, read_by_behave, steps
from kit import MODEL
from robbdd_tools.base.limits import LIMITS
from robbdd_tools.gherkin.render import TemplateProblem
from robbdd_tools.gherkin.template_requests import BlockRequest, TemplateSource, encoded


def rendered(folder: Path, source: str, model: str = MODEL) -> str:
    path = folder / "own.feature.jinja"
    path.write_text(source, encoding="utf-8")
    return feature(model, str(path))


def test_a_template_gets_the_documented_data(tmp_path: Path) -> None:
    text = rendered(
        tmp_path,
        "{% block feature %}{{ story.name }} {{ story.iri }} {{ story.tags[0] }} {{ story.benefit }}"
        " {{ story.background[1].title }}={{ story.background[1].names | join(',') }}\n{% endblock %}"
        "{% block variant %}{{ variant.name }} {{ variant.columns | join(',') }} {{ variant.template }}\n{% endblock %}"
        "{% block scenario %}{{ scenario.number }} {{ scenario.cells | join(',') }} {{ scenario.steps[0].role }}"
        " {{ scenario.steps[0].clause }} {{ variant.name }} {{ story.name }}\n{% endblock %}"
        "{% block end %}# that was {{ story.name }}\n{% endblock %}",
    )
    assert text.split("\n")[:3] == [
        "t:fetching https://example.org/t/fetching story=https:;;example.org;t;fetching work goes on"
        " a set of workspaces=env:bench_ws,env:tray_ws",
        "t:bench-to-tray part,robot,goal https://example.org/t/fetch",
        "1 env:bolt,env:panda,env:bench_ws given https://example.org/t/on-bench t:bench-to-tray t:fetching",
    ]
    assert text.endswith("# that was t:fetching\n")


def test_a_template_may_change_one_block_of_ours(tmp_path: Path) -> None:
    text = rendered(
        tmp_path,
        "{% extends 'compact.feature.jinja' %}\n{% block feature %}# by me\n{{ super() }}{% endblock %}",
    )
    assert text.startswith("# by me\n# wording: 2\n@story=")
    assert "Scenario Outline:" in text
    assert len(read_by_behave(text)) == 4


SCENARIO = "{%% block scenario %%}\n%s\n{%% endblock %%}"


@pytest.mark.parametrize(
    ("source", "line", "words"),
    [
        ("\n{% block scenario %}\n{{ scenario. }}{% endblock %}", 3, "expected name"),
        ("{% block scenario %}\n", 1, "Unexpected end of template"),
        ("{% block other %}{% endblock %}", 0, "no block 'scenario'"),
        ("\n{% extends 'mine.jinja' %}", 2, "there is no template 'mine.jinja' to extend"),
        ("{% extends 'own.feature.jinja' %}", 1, "there is no template"),
        (SCENARIO % "{{ scenario.colour }}", 2, "has no attribute 'colour'"),
        (SCENARIO % "{{ 1 / 0 }}", 2, "ZeroDivisionError: division by zero"),
        (SCENARIO % "{{ scenario.__class__ }}", 2, "__class__"),
        (SCENARIO % "{{ ''.__class__.__mro__ }}", 2, "unsafe"),
        (SCENARIO % "{% for x in range(10000000) %}{% endfor %}", 2, "Range too big"),
        (SCENARIO % "{% include '/etc/hostname' %}", 2, "/etc/hostname"),
        ("{% extends 'default.feature.jinja' %}" + SCENARIO % "\n{{ super() }}{{ none.x }}", 3, "has no attribute 'x'"),
    ],
)
def test_an_error_is_shown_with_its_file_and_line(tmp_path: Path, source: str, line: int, words: str) -> None:
    with pytest.raises(TemplateProblem) as caught:
        rendered(tmp_path, source)
    place = f"{tmp_path / 'own.feature.jinja'}:{line}: " if line else f"{tmp_path / 'own.feature.jinja'}: "
    assert str(caught.value).startswith(place)
    assert words in str(caught.value)


LOOPS = "{% for i in range(99999) %}{% for j in range(99999) %}{% endfor %}{% endfor %}"


@pytest.mark.parametrize(
    ("source", "limits", "words"),
    [
        (SCENARIO % LOOPS, {"seconds": 1}, ": the block 'scenario' takes longer than 1 s (limit template-seconds, "),
        (SCENARIO % "{{ 10 ** (10 ** 9) }}", {"seconds": 1}, ": the template takes longer than 1 s (limit temp"),
        (
            SCENARIO % "{% for i in range(999) %}{{ i }}{% endfor %}",
            {"output": 500},
            ": the block makes more than 500 bytes",
        ),
        (SCENARIO % "{{ 'x' * 10 ** 10 }}", {}, ":2: the template needs more memory than the limit template-memory"),
        (
            SCENARIO % "{% set x = 'x' * 9 ** 8 %}{{ x * 9 }}",
            {"memory": 300_000_000},
            ":2: the template needs more mem",
        ),
        (SCENARIO % ("{% for x in y %}" * 50 + "{% endfor %}" * 50), {}, ": the template cannot be compiled (Synt"),
        (SCENARIO % ("{{ " + "(" * 5000 + ")" * 5000 + " }}"), {}, ": the template cannot be compiled (Recursion"),
        (SCENARIO % "{{ '\\ud800' }}", {}, ": UnicodeEncodeError: "),
    ],
)
def test_a_template_ends_at_its_limits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, source: str, limits: dict[str, int], words: str
) -> None:
    for name, value in limits.items():
        monkeypatch.setenv(LIMITS[f"template-{name}"].variable, str(value))
    with pytest.raises(TemplateProblem) as caught:
        rendered(tmp_path, source)
    assert str(caught.value).startswith(f"{tmp_path / 'own.feature.jinja'}{words}")
    assert [child for child in psutil.Process().children() if "template_worker" in " ".join(child.cmdline())] == []


def test_the_process_of_a_template_ends_although_nobody_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(LIMITS["template-seconds"].variable, "1")
    sent = encoded(TemplateSource("endless", SCENARIO % LOOPS)) + encoded(BlockRequest("scenario", (), {}))
    worker = [sys.executable, "-m", "robbdd_tools.gherkin.template_worker"]
    done = subprocess.run(worker, input=sent, capture_output=True, encoding="utf-8", timeout=120, check=False)
    assert (done.returncode, done.stdout) == (1, '{"value": null}\n{"value": ["scenario"]}\n')


def test_our_templates_need_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "Popen", None)
    assert "Feature: " in feature(MODEL, "compact")


def test_a_template_that_cannot_be_read_is_answered_with_ours(tmp_path: Path) -> None:
    with pytest.raises(TemplateProblem, match="built-in templates: default, compact, de"):
        feature(MODEL, str(tmp_path / "missing.jinja"))
    (tmp_path / "latin.jinja").write_bytes(b"\xff")
    with pytest.raises(TemplateProblem, match="not UTF-8"):
        feature(MODEL, str(tmp_path / "latin.jinja"))


def test_the_compact_template_writes_a_table_and_the_same_scenarios() -> None:
    compact, default = read_by_behave(feature(MODEL, "compact")), read_by_behave(feature(MODEL))
    assert feature(MODEL, "compact").count("Scenario") == 1
    assert [(one.steps, one.tables) for one in compact] == [(one.steps, one.tables) for one in default]


@pytest.mark.parametrize(
    "values",
    [
        # A quoted value, which parsers read differently in a table; one that names a column; one partly in the scene.
        """{ "a \\"b\\"", <arms.panda> }""",
        """{ "<goal>", <arms.panda> }""",
        """{ <washers.washer1>, <arms.panda> }""",
    ],
)
def test_the_compact_template_writes_scenarios_where_a_table_would_not_do(values: str) -> None:
    source = edited("{ <arms.panda> }", values)
    text = feature(source, "compact")
    assert "Scenario Outline" not in text
    assert [one.steps for one in read_by_behave(text)] == [one.steps for one in read_by_behave(feature(source))]


def test_the_german_template_has_german_keywords_and_the_same_sentences() -> None:
    text = feature(MODEL, "de")
    assert text.startswith("# language: de\n# wording: 2\n")
    for keyword in ("Funktionalität: ", "Grundlage:", "Szenario: ", "Angenommen ", "Wenn ", "Dann "):
        assert keyword in text
    assert steps(MODEL)[0].removeprefix("Given ") in text
    assert [one.steps for one in read_by_behave(text)] == [one.steps for one in read_by_behave(feature(MODEL))]
