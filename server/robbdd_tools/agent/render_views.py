"""Render pictures for users' behaviours while a scenario is executed.

``python -m robbdd_tools.agent.render_views MODEL`` loads a compiled model of the engine and answers each line of its
standard input, a request of ``world/cameras.py``, with one JSON object: the pixels in base 64, or an error. Before the
first request, it writes an error if the graphics back end does not work, else an empty object.
"""

from __future__ import annotations

import json
import os
import sys
from base64 import b64encode
from typing import Any

from robbdd_tools.agent.standard_streams import reserve_channel
from robbdd_tools.base.graphics import NO_GRAPHICS


def answer_views(path: str) -> int:
    """Answer until the input ends; return the exit code."""
    requests, answers = reserve_channel()
    with os.fdopen(requests, encoding="utf-8") as stream, os.fdopen(answers, "w", encoding="utf-8") as output:
        try:
            from robbdd_tools.world.views import Views

            views = Views(path)
        except Exception as error:  # each back end fails with an exception type of its own
            print(json.dumps({"error": f"{type(error).__name__}: {error}"}), file=output)
            return NO_GRAPHICS
        print("{}", file=output, flush=True)
        for line in stream:
            print(json.dumps(_answer(views, json.loads(line))), file=output, flush=True)
    return 0


def _answer(views: Any, request: dict[str, Any]) -> dict[str, str]:
    try:
        pixels = views.render(request["camera"], request["state"], tuple(request["size"]))
    except Exception as error:  # a driver may fail at any picture
        return {"error": f"{type(error).__name__}: {error}"}
    return {"pixels": b64encode(pixels.tobytes()).decode("ascii")}


if __name__ == "__main__":
    sys.exit(answer_views(sys.argv[1]))
