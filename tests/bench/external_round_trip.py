"""``python external_round_trip.py``: time of an observation and its command, over a process and over an endpoint."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

from robbdd_tools.user_code.system_links import SystemFailed, SystemLink, open_link

FOLDER = Path(__file__).parents[2] / "examples" / "external"
POSE = {"position": [0.1, 0.2, 0.3], "rotation": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}
RESET = {"type": "reset", "version": 1, "behaviour": "pick-place", "arguments": {"object": "b0", "workspace": "ws"}}
OBSERVATION: dict[str, Any] = {
    "type": "observation",
    "time": 1.25,
    "joints": [0.1] * 7,
    "tool": POSE,
    "objects": {f"b{number}": POSE for number in range(9)},
    "places": {"ws": [0.4, 0.5, 0.6]},
    "holds": ["b0"],
}
COUNT = 200
PORT = 9127


def measure(name: str, link: SystemLink) -> None:
    """Print the mean and the 99th percentile in ms."""
    taken: list[float] = []
    for _ in range(10):
        link.send(dict(RESET))
        link.receive(5.0)
        for _ in range(COUNT):
            began = perf_counter()
            link.send(OBSERVATION)
            answer = link.receive(5.0)
            taken.append(perf_counter() - began)
            if answer.get("done"):
                break
    link.close()
    ordered = sorted(taken)
    mean, high = 1e3 * sum(ordered) / len(ordered), 1e3 * ordered[int(0.99 * len(ordered))]
    print(f"{name}: {len(ordered)} round trips, mean {mean:.3f} ms, 99th percentile {high:.3f} ms")


def connected(address: str) -> SystemLink:
    """Connect as soon as the server listens."""
    for _ in range(100):
        try:
            return open_link("endpoint", address, None, 5.0)
        except SystemFailed:
            sleep(0.05)
    raise SystemExit(f"nothing listens at {address}")


if __name__ == "__main__":
    measure("process", open_link("process", "python policy.py", FOLDER, 5.0))
    server = subprocess.Popen([sys.executable, "policy.py", str(PORT)], cwd=FOLDER)
    try:
        measure("endpoint", connected(f"ws://127.0.0.1:{PORT}"))
    finally:
        server.kill()
