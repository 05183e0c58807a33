"""``python -m robbdd_tools.agent RUN_FOLDER``: execute scenarios of a prepared run.

The process reads the numbers of scenarios from standard input as they arrive, and writes messages (see
``protocol.messages``) to standard output.
"""

from __future__ import annotations

import os
import sys

from robbdd_tools.agent.stack_dumps import install
from robbdd_tools.agent.standard_streams import reserve_channel
from robbdd_tools.base.descendants import adopt_orphans
from robbdd_tools.base.graphics import without_graphics
from robbdd_tools.base.processes import on_end_request


def _stop(signum: int) -> None:
    # Every message is written in one call, so there is nothing to flush or to undo.
    os._exit(128 + signum)


def _main() -> int:
    on_end_request(_stop)
    if len(sys.argv) != 2:
        print("usage: python -m robbdd_tools.agent RUN_FOLDER", file=sys.stderr)
        return 2
    orders, messages = reserve_channel()
    adopt_orphans()
    install()
    # Only pictures for users' behaviours need graphics, and another process renders them.
    without_graphics()
    # Install the signal handlers before the slow imports.
    from robbdd_tools.agent.clause_debugger import begin_pauses
    from robbdd_tools.agent.execute_requests import read_requests
    from robbdd_tools.agent.runner import run_folder

    is_taken = begin_pauses().take
    return run_folder(sys.argv[1], read_requests(os.fdopen(orders, encoding="utf-8"), is_taken), messages)


if __name__ == "__main__":
    sys.exit(_main())
