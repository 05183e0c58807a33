"""Pictures of the last result of a clause: the violated moment, and the margin over time.

They are added to a hover if the client can show pictures.
"""

from __future__ import annotations

import json
import logging
from base64 import b64encode
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING
from urllib.parse import quote

from robbdd_tools.base.files import file_state, load_bytes, path_to_uri
from robbdd_tools.features.markdown import literal
from robbdd_tools.features.rejudged_results import SIGNS
from robbdd_tools.protocol.run_folder import thumbnail_file
from robbdd_tools.run.database import DatabaseProblem
from robbdd_tools.run.json_documents import NoTrace, stored_curves
from robbdd_tools.run.pictures import NoPictures, render_thumbnails
from robbdd_tools.run.plot import plot
from robbdd_tools.run.store import NoSuchRun

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robbdd_tools.features.run_verdicts import Judged, JudgedScenario
    from robbdd_tools.lsp.run_stores import Stores
    from robbdd_tools.run.store import RunStore, StoredRun

REPLAY, HISTORY = "robbdd.showReplay", "robbdd.showHistory"
"""Commands of the clients that announce support for them."""
THUMBNAILS = "thumbnails"
LARGEST = 60_000
"""Maximum bytes of an embedded picture, because clients read only a hundred thousand characters of a text."""
MAX_RUNS = 8
"""Maximum number of runs whose verdicts on a clause are listed."""
MAX_PICTURES = 8
"""Maximum number of clauses of a run that get a picture of their worst violation."""
_LOG = logging.getLogger(__name__)


def pictures_of(stores: Stores, judged: Judged) -> str:
    """Return the pictures of a result side by side as Markdown; empty if the stored run no longer exists."""
    scenario, judgement = judged
    try:
        run = _run_of(stores.of(scenario.model), scenario)
        kept = stored_curves(run, scenario.index)
    except (NoSuchRun, NoTrace):
        return ""
    if kept.get("scenario") != [scenario.variant, scenario.variation]:
        return ""
    return " ".join(_shown(run, scenario.index, judgement.line, plot(kept, judgement.line, judgement.operand)))


def replay_link(judged: Judged) -> str:
    """Return a Markdown link that replays the execution of a result; empty if there is no stored run."""
    scenario = judged[0]
    if not scenario.run:
        return ""
    target = {"uri": scenario.model, "run": scenario.run, "index": scenario.index, "clause": _clause_of(judged)}
    return f"[Replay]({_command(REPLAY, target)})"


def history_line(stores: Stores, judged: Judged, *, link: bool) -> str:
    """Return the verdicts of the latest runs on the clause of a result, as a line of Markdown, the newest run first.

    Empty if fewer than two stored runs judged it. With ``link``, the line ends with a link to the whole history.
    """
    scenario, judgement = judged
    clause = _clause_of(judged)
    try:
        runs = [] if clause is None else stores.history(scenario.model, clause)
    except DatabaseProblem:
        return ""
    if len(runs) < 2:
        return ""
    latest = [f"{SIGNS[run.verdict]} {run.holding}/{run.total} (run {run.run})" for run in runs[: -MAX_RUNS - 1 : -1]]
    more = [f"{len(runs) - MAX_RUNS} more"] if len(runs) > MAX_RUNS else []
    target = {"uri": scenario.model, "clause": clause}
    links = [f"[History]({_command(HISTORY, target)})"] if link else []
    return f"Runs of {literal(judgement.name)}: {' · '.join((*latest, *more, *links))}"


def _clause_of(judged: Judged) -> str | None:
    scenario, judgement = judged
    return next((iri for iri, found in scenario.clauses.items() if found is judgement), None)


def _command(name: str, target: Mapping[str, object]) -> str:
    return f"command:{name}?{quote(json.dumps([target]))}"


def _run_of(store: RunStore, scenario: JudgedScenario) -> StoredRun:
    return store.find(str(scenario.run))


def _shown(run: StoredRun, index: int, line: int, drawn: str | None) -> Iterator[str]:
    if drawn is not None:
        yield f"![margin over time]({_data('image/svg+xml', drawn.encode())})"
    path = thumbnail_file(run.folder / THUMBNAILS, index, line)
    state = file_state(path_to_uri(path))
    if state is not None:
        shown = _data("image/png", load_bytes(path)) if state.size <= LARGEST else path_to_uri(path)
        yield f"![the moment of the violation]({shown})"


def _data(kind: str, data: bytes) -> str:
    return f"data:{kind};base64,{b64encode(data).decode('ascii')}"


def picture_violations(run: StoredRun, scenarios: Iterable[JudgedScenario]) -> None:
    """Render a thumbnail of the worst violation of each of the first ``MAX_PICTURES`` clauses, if rendering works."""
    worst: dict[str, tuple[float, int, int]] = {}
    for scenario in scenarios:
        for iri, judgement in scenario.clauses.items():
            if judgement.outcome == "violated":
                found = (judgement.rank, scenario.index, judgement.line)
                worst[iri] = min(found, worst.get(iri, found))
    chosen = sorted({(index, line) for _, index, line in worst.values()})[:MAX_PICTURES]
    try:
        if chosen:
            render_thumbnails(run.folder, run.folder / THUMBNAILS, chosen)
    except NoPictures as error:
        _LOG.info("there are no pictures of violations: %s", error)
