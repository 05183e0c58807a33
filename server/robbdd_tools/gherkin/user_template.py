"""Render users' templates. Each template has its own process, which is killed if a block takes too long."""

from __future__ import annotations

import json
import threading
import weakref
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from robbdd_tools.base import interpreter
from robbdd_tools.base.files import UnreadableFile, load_text
from robbdd_tools.base.limits import TEMPLATE_SECONDS
from robbdd_tools.base.processes import RunningProcess, describe_exit, end_group
from robbdd_tools.gherkin.render import OURS, Sheet, TemplateProblem, our_sheet
from robbdd_tools.gherkin.template_requests import BlockRequest, Request, TemplateSource, encoded

WORKER = "robbdd_tools.gherkin.template_worker"


def sheet(name: str) -> Sheet:
    """Return the built-in template ``name``, or the user's template at the path ``name``.

    Raises ``TemplateProblem``.
    """
    return our_sheet(name) if name in OURS else UserSheet(name)


class UserSheet:
    """A user's template in its own process. The process ends with this object or at the first problem.

    Compiling the template and rendering a block may each take ``template-seconds``. Raises ``TemplateProblem``.
    """

    def __init__(self, file: str) -> None:
        try:
            source = load_text(Path(file))
        except UnreadableFile as error:
            known = ", ".join(OURS)
            raise TemplateProblem(file, 0, f"{error} (built-in templates: {known})") from None
        self.file = file
        self._process = process = interpreter.start(WORKER, folder=interpreter.working_folder(), log=None)
        assert process.stdin is not None
        assert process.stdout is not None
        self._requests, self._answers = process.stdin, process.stdout
        self._end = weakref.finalize(self, _end, process, process.wait, self._requests, self._answers)
        self._answers.readline()  # Starting the process does not count as the template's time.
        self._sent: dict[str, object] = {}
        self._blocks: list[str] = self._ask("the template", TemplateSource(file, source))

    def has(self, block: str) -> bool:
        """Return whether the template has a block."""
        return block in self._blocks

    def render(self, block: str, values: Mapping[str, object]) -> str:
        """Return the text of one block; empty if the template has no such block. Raises ``TemplateProblem``."""
        if not self.has(block):
            return ""
        fresh = {name: value for name, value in values.items() if self._sent.get(name) is not value}
        self._sent |= fresh
        return self._ask(f"the block '{block}'", BlockRequest(block, tuple(values), fresh))

    def _ask(self, subject: str, request: Request) -> Any:
        seconds = TEMPLATE_SECONDS.value()
        is_late = threading.Event()
        timer = threading.Timer(seconds, _end_late, (self._process, is_late))
        timer.start()
        line = ""
        try:
            with suppress(BrokenPipeError):
                self._requests.write(encoded(request))
                self._requests.flush()
                line = self._answers.readline()
        finally:
            timer.cancel()
        if not line.endswith("\n"):
            self._end()
            if is_late.is_set():
                limit = f"limit template-seconds, see {TEMPLATE_SECONDS.variable}"
                raise TemplateProblem(self.file, 0, f"{subject} takes longer than {seconds} s ({limit})")
            how = describe_exit(self._process.returncode)
            raise TemplateProblem(self.file, 0, f"the process that renders {subject} ended with {how}")
        answer = json.loads(line)
        if "message" in answer:
            self._end()
            raise TemplateProblem(answer["file"], answer["line"], answer["message"])
        return answer["value"]


def _end_late(process: RunningProcess, is_late: threading.Event) -> None:
    is_late.set()
    end_group(process)


def _end(process: RunningProcess, wait: Callable[[], int], *streams: IO[str]) -> None:
    """End the process, even during a request."""
    end_group(process)
    wait()
    for stream in streams:
        with suppress(OSError):
            stream.close()
