"""The figures of clusters in ``docs/campaigns.md``.

``python tests/campaign/cluster_figures.py N``: N executions are killed, resumed, moved to a cluster, finished. Agents
need no time (``study_agents``), so the figures are those of the engine. Prints the peak memory of the client and of the
scheduler, and whether the results equal those of an uninterrupted study on one machine.

``… efficiency N``: N repetitions of ``examples/pickplace`` in one process, in two, and on two workers. Prints the
processor time of all processes together, the wall time, and whether the results are equal.
"""

from __future__ import annotations

import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from time import monotonic, sleep

sys.path.insert(0, str(Path(__file__).parents[1]))

from campaign.dask_kit import dask_processes
from campaign.study_agents import write_study
from kit import EXAMPLES

DRIVER = Path(__file__).with_name("study_agents.py")
STUDY = """import "m.bdd"
Study fetching {{
    repeat: {}
    seed: 3
}}
"""
TIMED = 'import "pickplace.bdd"\nStudy p {{ repeat: {} seed: 1 }}\n'
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


def efficiency(number: int) -> None:
    """Execute the same study in three ways."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(EXAMPLES / "pickplace", folder / "model")
        study = folder / "model" / "p.study"
        study.write_text(TIMED.format(number), encoding="utf-8")
        tables = [measured(study, f"--jobs {jobs}", "--jobs", str(jobs)) for jobs in (1, 2)]
        before = processor_time()
        with dask_processes(folder / "dask", 0) as dask:
            for _ in range(2):
                dask.start_worker(quick=False)
            tables.append(measured(study, "two workers: client", "--scheduler", dask.address))
            client = processor_time()
        print(f"two workers: all processes, with their starts: {processor_time() - before:.1f} s")
        print(f"two workers: scheduler, workers and agents: {processor_time() - client:.1f} s")
        print(f"equal exports: {len(set(tables)) == 1}")


def measured(study: Path, words: str, *options: str) -> bytes:
    """Execute a study from its beginning, print its times, and return its export."""
    command = [sys.executable, "-m", "robbdd_tools", "study"]
    quiet = subprocess.DEVNULL
    before, began = processor_time(), monotonic()
    subprocess.run([*command, "run", study.name, "--restart", *options], cwd=study.parent, stdout=quiet, stderr=quiet)
    print(f"{words}: {processor_time() - before:.1f} s of processor time, {monotonic() - began:.1f} s", flush=True)
    subprocess.run([*command, "export", study.name, "-o", "x.csv"], cwd=study.parent, check=True, stderr=quiet)
    return (study.parent / "x.csv").read_bytes()


def processor_time() -> float:
    """Return the processor time of all ended processes that this one has started, in s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    if sys.argv[1] == "efficiency":
        efficiency(int(sys.argv[2]))
    else:
        main(int(sys.argv[1]))
