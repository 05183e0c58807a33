"""Loaded by the workers of a test's cluster: their agents are threads that need no time."""

from __future__ import annotations

import os
from collections.abc import Iterator
from time import sleep
from unittest.mock import patch

from campaign.study_agents import QuickAgent
from robbdd_tools.protocol.messages import LogLine, RunMessage
from robbdd_tools.protocol.specs import ScenarioSpec
from robbdd_tools.run import scheduler


class SlowAgent(QuickAgent):
    """An agent that waits ``ROBBDD_PAUSE`` seconds before each execution, and warns of ``ROBBDD_WARNING``."""

    def executed(self, index: int, spec: ScenarioSpec) -> Iterator[RunMessage]:
        sleep(float(os.environ.get("ROBBDD_PAUSE", "0")))
        if os.environ.get("ROBBDD_WARNING"):
            yield LogLine("warning", f"{spec.seed}: {os.environ['ROBBDD_WARNING']}")
        yield from super().executed(index, spec)


def dask_setup(_: object) -> None:
    patch.object(scheduler, "Agent", SlowAgent).start()
