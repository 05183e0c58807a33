"""Several threads may parse at the same time, the first time included."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SCRIPT = """
import sys, threading
from kit import MODEL
from robbdd_tools.base.document import Document
from robbdd_tools.names.index import index_file
sys.setswitchinterval(1e-6)
gate, faults = threading.Barrier(4), []
def work():
    gate.wait()
    index = index_file(Document("file:///m.bdd", 0, MODEL))
    faults.extend(fault.message for placed in index.declarations for fault in placed.declaration.faults)
threads = [threading.Thread(target=work) for _ in range(4)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
print(faults)
"""


def test_rules_that_are_compiled_at_the_same_time_read_the_same_text() -> None:
    # A fresh interpreter: compiled parsers are cached for the process.
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, cwd=Path(__file__).parents[1])
    assert (done.stdout.strip(), done.stderr) == ("[]", "")
