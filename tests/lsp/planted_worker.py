"""The validation process with planted faults: words in a text make it raise, exit, or hang."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import Any

from robbdd_tools.lsp import worker
from robbdd_tools.names.project import Snapshot


def planted(find: Callable[..., Any]) -> Callable[..., Any]:
    def found(snapshot: Snapshot, uri: str, *more: Any) -> Any:
        text = snapshot.document(uri).text
        if "planted error" in text:
            raise RuntimeError("planted error")
        if "planted end" in text:
            os._exit(1)
        if "planted hang" in text:
            threading.Event().wait()
        return find(snapshot, uri, *more)

    return found


def main(in_passing: bool = False) -> None:
    name = "shape_diagnostics"
    setattr(worker, name, planted(getattr(worker, name)))
    worker.main(in_passing)
