"""Pictures of the last result of a clause: the violated moment, and the margin over time.

They are added to a hover if the client can show pictures.
"""

from __future__ import annotations

import json
import logging
from base64 import b64encode
from collections.abc import Iterator
from typing import TYPE_CHECKING
from urllib.parse import quote

from robbdd_tools.base.files import file_state, load_bytes, path_to_uri
from robbdd_tools.protocol.run_folder import thumbnail_file
from robbdd_tools.run.json_documents import NoTrace, stored_curves
from robbdd_tools.run.pictures import NoPictures, render_thumbnails
from robbdd_tools.run.plot import plot
from robbdd_tools.run.store import NoSuchRun

if TYPE_CHECKING:
    from collections.abc import Iterable

    from robbdd_tools.features.run_verdicts import Judged, JudgedScenario
    from robbdd_tools.lsp.run_stores import Stores
    from robbdd_tools.run.store import RunStore, StoredRun

REPLAY = "robbdd.showReplay"
"""Command of clients that announce it."""
THUMBNAILS = "thumbnails"
LARGEST = 60_000
"""Maximum bytes of an embedded picture; clients read a hundred thousand characters of a text."""
MAX_PICTURES = 8
"""Maximum number of clauses of a run whose worst violation is pictured."""
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
    scenario, judgement = judged
    if not scenario.run:
        return ""
    clause = next((iri for iri, found in scenario.clauses.items() if found is judgement), None)
    target = {"uri": scenario.model, "run": scenario.run, "index": scenario.index, "clause": clause}
    return f"[Replay](command:{REPLAY}?{quote(json.dumps([target]))})"


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
