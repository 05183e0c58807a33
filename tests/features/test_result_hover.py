"""The hover of a clause shows its last result at each of its tokens."""

from __future__ import annotations

import re
from dataclasses import replace

from features.judged_clauses import HOLDS, NS, VIOLATED, judged
from gherkin_kit import edited
from kit import MODEL, fixture
from robbdd_tools.features.hover import hover
from robbdd_tools.features.project_findings import findings_of
from robbdd_tools.features.run_verdicts import JudgedScenario, digests_of
from robbdd_tools.names.clause_places import clauses_in


def test_the_result_is_in_the_hover_everywhere_in_a_clause_with_what_the_word_means() -> None:
    case = fixture(MODEL)
    findings = judged(case, HOLDS, VIOLATED)
    text = case.snapshot.document(case.uri).text
    start = text.index("in-tray: holds")
    line = text[start : text.index("\n", start)]
    found = [hover(case.snapshot, case.uri, start + place, findings) for place in range(len(line))]
    assert [place for place, one in enumerate(found) if one is None or "−12 mm" not in one.markdown] == []
    judgements = {one.judged[1].outcome for one in found if one is not None and one.judged is not None}
    assert (judgements, len([one for one in found if one is not None and one.judged])) == ({"violated"}, len(line))
    on_name = found[line.index("<part>") + 1]
    assert on_name is not None
    assert on_name.markdown.startswith("**variable** `fetch.part`")


EVERY_KIND = edited(
    "in-tray: holds(<part> is located at <goal>, 0.5 seconds after <place-end>)",
    """((in-tray: holds(<part> is located at <goal>, after <end>) or 'lamp' after <end>) and 'bell' after <end>
            and (not near: holds(<part> is located at <goal>, before <end>))
            and (var other exists in <parts>) such that { kept: holds(<other> is at rest, after <end>) })""",
)


def test_each_token_of_each_kind_of_clause_shows_the_result_of_its_innermost_clause() -> None:
    case = fixture(EVERY_KIND)
    places = list(clauses_in(case.snapshot, case.uri))
    assert len(places) >= 9
    verdicts = {one.iri: replace(VIOLATED, said=f"✗ −{number}.5 mm") for number, one in enumerate(places)}
    digests = digests_of(case.snapshot, case.uri)
    scenario = JudgedScenario(case.uri, f"{NS}bench-to-tray", 1, "part = 1", "", "")
    for iri, verdict in verdicts.items():
        scenario.judge(iri, replace(verdict, digest=digests.clauses[iri]))
    findings = findings_of([scenario])
    text = case.snapshot.document(case.uri).text
    for place in places:
        for token in re.finditer(r"[\w.-]+|[^\w\s]", text[place.span.start : place.span.end]):
            offset = place.span.start + token.start()
            around = [one for one in places if one.span.contains(offset)]
            innermost = min(around, key=lambda one: one.span.end - one.span.start)
            found = hover(case.snapshot, case.uri, offset, findings)
            assert found is not None, token
            assert found.judged == (scenario, scenario.clauses[innermost.iri]), token
            assert verdicts[innermost.iri].said in found.markdown, token
