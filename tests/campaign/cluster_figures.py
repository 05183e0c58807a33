"""``python tests/campaign/cluster_figures.py N``: N executions are killed, resumed, moved to a cluster and finished.

Agents need no time (``study_agents``), so the figures are those of the engine. Prints the peak memory of the client and
of the scheduler, and whether the results equal those of an uninterrupted study on one machine.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import monotonic, sleep

sys.path.insert(0, str(Path(__file__).parents[1]))

from campaign.dask_kit import dask_processes
from campaign.study_agents import write_study

DRIVER = Path(__file__).with_name("study_agents.py")
STUDY = """import "m.bdd"
Study fetching {{
    repeat: {}
    seed: 3
}}
"""
WORKERS = 3


def started(path: Path, *words: str) -> subprocess.Popen[bytes]:
    environment = {**os.environ, "PYTHONPATH": str(DRIVER.parents[1])}
    command = [sys.executable, str(DRIVER), "study", words[0], path.name, *words[1:]]
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command, cwd=path.parent, env=environment, stdout=quiet, stderr=quiet)


def peak(process: subprocess.Popen[bytes]) -> float:
    """Return the largest memory that a process had so far, in MB; 0 if it has ended."""
    try:
        status = Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    except OSError:
        return 0.0
    return next((int(line.split()[1]) / 1024 for line in status.splitlines() if line.startswith("VmHWM")), 0.0)


def finished(path: Path) -> int:
    command = [sys.executable, "-m", "robbdd_tools", "study", "status", path.name]
    shown = subprocess.run(command, cwd=path.parent, capture_output=True, text=True, check=False).stdout
    return int(shown.split(":")[1].split()[0].replace(",", "")) if ":" in shown else 0


def killed_after(path: Path, executions: int, *words: str) -> None:
    process = started(path, *words)
    while process.poll() is None and finished(path) < executions:
        sleep(0.2)
    process.kill()
    process.wait()
    print(f"killed `study {words[0]}` with {finished(path):,} finished", flush=True)


def exported(path: Path) -> bytes:
    assert started(path, "export", "-o", "x.csv").wait() == 0
    return path.with_suffix(".csv").read_bytes()


def main(number: int) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder, text = Path(name), STUDY.format(number // 4)
        hurt = write_study(folder / "hurt", text)
        killed_after(hurt, number // 10, "run")
        killed_after(hurt, number // 5, "resume")
        with dask_processes(folder / "dask", WORKERS) as dask:
            began, before = monotonic(), finished(hurt)
            client = started(hurt, "resume", "--scheduler", dask.address)
            most = 0.0
            while client.poll() is None:
                most = max(most, peak(client))
                sleep(0.1)
            seconds = monotonic() - began
            print(f"{number - before:,} executions on {WORKERS} workers in {seconds:.0f} s", flush=True)
            print(f"peak memory: client {most:.0f} MB, scheduler {peak(dask.scheduler):.0f} MB", flush=True)
        whole = write_study(folder / "whole", text)
        began = monotonic()
        started(whole, "run").wait()
        print(f"{number:,} executions on one machine in {monotonic() - began:.0f} s", flush=True)
        print(f"equal exports: {exported(whole) == exported(hurt)}")


if __name__ == "__main__":
    main(int(sys.argv[1]))
