"""All that is fuzzed, by name."""

from __future__ import annotations

from collections.abc import Mapping

from tests.nightly.fuzz import Target
from tests.nightly.graphs import GRAPH_TARGETS
from tests.nightly.language import LANGUAGE_TARGETS
from tests.nightly.requests import REQUEST_TARGETS
from tests.nightly.runs import RUN_TARGETS

TARGETS: Mapping[str, Target] = {
    target.name: target for target in (*LANGUAGE_TARGETS, *GRAPH_TARGETS, *RUN_TARGETS, *REQUEST_TARGETS)
}
