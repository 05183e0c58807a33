"""The process that renders one user template. It exits at the end of its input.

Each line of its input is a pickled request in Base64. Each line of its output is the answer as JSON: either ``value``,
or ``file``, ``line`` and ``message`` of a problem. The first answer, before any request, reports that the process is
ready. The first request is the template, and all others are blocks.
"""

from __future__ import annotations

import faulthandler
import json
import sys
from collections.abc import Callable

from robbdd_tools.base.limits import TEMPLATE_MEMORY, TEMPLATE_OUTPUT, TEMPLATE_SECONDS
from robbdd_tools.base.processes import limit_memory
from robbdd_tools.gherkin.render import BLOCKS, CompiledSheet, TemplateProblem, compiled
from robbdd_tools.gherkin.template_requests import Request, TemplateSource, decoded


class _Worker:
    """The state of the process between two requests."""

    def __init__(self) -> None:
        self._sheet: CompiledSheet | None = None
        self._values: dict[str, object] = {}

    def answer(self, request: Request) -> object:
        """Return the answer to a request: the blocks of a template, or the text of a block.

        Raises ``TemplateProblem``.
        """
        if isinstance(request, TemplateSource):
            self._sheet = compiled(request.file, request.source, TEMPLATE_OUTPUT.value())
            return [block for block in BLOCKS if self._sheet.has(block)]
        assert self._sheet is not None
        self._values |= request.fresh
        return self._sheet.render(request.block, {name: self._values[name] for name in request.names})


def main() -> None:
    """Answer requests until the input ends."""
    stdout, sys.stdout = sys.stdout, sys.stderr
    limit_memory(TEMPLATE_MEMORY.value())
    worker = _Worker()

    def send(answer: dict[str, object]) -> None:
        stdout.write(json.dumps(answer) + "\n")
        stdout.flush()

    send({"value": None})
    for line in sys.stdin:
        # The parent kills this process on a timeout. If the parent no longer exists, this timer ends the process.
        faulthandler.dump_traceback_later(2 * TEMPLATE_SECONDS.value(), exit=True)
        answer = _answered(worker.answer, decoded(line))
        faulthandler.cancel_dump_traceback_later()
        send(answer)


def _answered(answer: Callable[[Request], object], request: Request) -> dict[str, object]:
    try:
        return {"value": answer(request)}
    except TemplateProblem as problem:
        return {"file": problem.file, "line": problem.line, "message": problem.message}


if __name__ == "__main__":
    main()
