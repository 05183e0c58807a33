"""Execute parts of batches on the workers of a Dask cluster. No other module uses ``distributed``.

The scheduler has only the parts in flight and the files that they need. If it is restarted, they are sent again.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from time import monotonic
from typing import Any, Self
from uuid import uuid4

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.run.parcels import Parcel
from robbdd_tools.workbench.deciding_versions import differences, versions
from robbdd_tools.workbench.parts import Part, PartResult, execute_part

CONNECTING = 10.0
"""Seconds to connect to a scheduler."""
ATTEMPTS = 3
"""The study ends when Dask has given up a part this many times because the part killed its workers."""
POLL = 0.05
"""Seconds between two checks for finished parts. A part takes about 30 s."""
LOOK = 2.0
"""Seconds between two queries of the list of workers."""
_RUNNING = "running"
_MISSING = "the study needs Dask: install robbdd-tools[cluster]"


class ClusterProblem(RobbddError):
    """A cluster cannot be used; the message gives the reason."""


@dataclass(slots=True)
class _Flight:
    """A part that was sent, with its files."""

    part: Part
    used: Parcel
    prepared: Parcel
    future: Any
    attempts: int = 1


@dataclass(slots=True)
class _Sent:
    """A parcel as a value in the cluster, and the number of parts that use it. Workers copy it from each other."""

    future: Any
    uses: int = 0


@dataclass(slots=True)
class Cluster:
    """A connection to a scheduler. Use it as a context manager, in one thread.

    ``note`` is called with remarks for the user, such as a lost connection. Raises ``ClusterProblem``.
    """

    address: str
    note: Callable[[str], None]
    _client: Any = field(init=False)
    _flights: list[_Flight] = field(init=False, default_factory=list[_Flight])
    _sent: dict[str, _Sent] = field(init=False, default_factory=dict[str, _Sent])
    _threads: int = field(init=False, default=0)
    _known: frozenset[str] = field(init=False, default=frozenset())
    _looked: float = field(init=False, default=0.0)
    _waited: bool = field(init=False, default=False)
    _work: Mapping[str, int] = field(init=False, default_factory=dict[str, int])
    _cancelled: threading.Event = field(init=False, default_factory=threading.Event)

    def __post_init__(self) -> None:
        self._client = self._connected()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        # The scheduler forgets the parts in flight, and workers end them.
        self._flights.clear()
        self._sent.clear()
        self._client.close(timeout=2)

    @property
    def in_flight(self) -> int:
        """The number of parts that were sent and have no result yet."""
        return len(self._flights)

    @property
    def threads(self) -> int:
        """The number of parts that the workers execute at a time, at most some seconds old."""
        if monotonic() - self._looked > LOOK and self._client.status == _RUNNING:
            self._looked = monotonic()
            workers = self._workers()
            self._check([one for one in workers if one not in self._known])
            self._known = frozenset(workers)
            self._threads = sum(workers.values())
            self._work = self._shares(workers)
            if not self._threads and not self._waited:
                self.note(f"no worker is connected to {self.address}: waiting for one")
            self._waited = not self._threads
        return self._threads

    def work(self) -> Mapping[str, int]:
        """Return the number of executions that each worker has, by its address. The numbers may be some seconds old.

        Any thread may call it.
        """
        return self._work

    def cancel(self) -> None:
        """Let ``results`` end. It may be called from any thread or signal handler."""
        self._cancelled.set()

    @property
    def is_cancelled(self) -> bool:
        """Whether ``cancel`` was called."""
        return self._cancelled.is_set()

    def send(self, part: Part, used: Parcel, prepared: Parcel) -> None:
        """Send a part and the files that it needs."""
        self._flights.append(_Flight(part, used, prepared, self._submitted(part, used, prepared)))

    def results(self) -> Iterator[tuple[Part, PartResult]]:
        """Wait for the result of a part; yield it, and other results that have arrived.

        Yields nothing after ``cancel`` or, after a short pause, if no part is in flight.
        """
        if not self._flights:
            self._cancelled.wait(POLL)
        while self._flights and not self._cancelled.is_set():
            if self._client.status == "closed":
                self._reconnect()
            back = [found for flight in list(self._flights) if (found := self._landed(flight)) is not None]
            if back:
                yield from back
                return
            _ = self.threads
            self._cancelled.wait(POLL)

    def _check(self, workers: Sequence[str]) -> None:
        """Raise ``ClusterProblem`` if versions on new workers differ; the message names these versions."""
        if not workers:
            return
        found: dict[str, Any] = self._client.run(_versions_there, workers=workers, on_error="return")
        problems = [
            f"{worker} has {', '.join(differing)}"
            for worker, there in found.items()
            if (differing := [_unusable(there)] if isinstance(there, BaseException) else list(_other(there)))
        ]
        if problems:
            raise ClusterProblem(f"workers with other versions are refused: {'; '.join(problems)}")

    def _landed(self, flight: _Flight) -> tuple[Part, PartResult] | None:
        match flight.future.status:
            case "finished":
                try:
                    result: PartResult = flight.future.result(timeout=CONNECTING)
                except Exception:  # Dask's own types: the worker or the scheduler died with the result
                    return None
                self._flights.remove(flight)
                self._release(flight)
                return flight.part, result
            case "error":
                self._again(flight, flight.future.exception(timeout=CONNECTING))
            case "cancelled" | "lost" if self._client.status == _RUNNING:
                self._forget_sent()
                self._again(flight, None)
            case _:
                pass
        return None

    def _again(self, flight: _Flight, error: BaseException | None) -> None:
        """Send a part again that was lost or that killed its workers."""
        if error is not None and type(error).__name__ != "KilledWorker":
            raise ClusterProblem(f"a worker cannot execute the study; it has {_unusable(error)}")
        flight.attempts += error is not None
        if flight.attempts > ATTEMPTS:
            raise ClusterProblem(f"a part of batch {flight.part.batch} ends every worker that executes it: {error}")
        self._release(flight)
        flight.future = self._submitted(flight.part, flight.used, flight.prepared)

    def _submitted(self, part: Part, used: Parcel, prepared: Parcel) -> Any:
        files = [self._value(parcel) for parcel in (used, prepared)]
        return self._client.submit(_on_worker, part, *files, key=f"robbdd-part-{uuid4()}", pure=False)

    def _value(self, parcel: Parcel) -> Any:
        sent = self._sent.get(parcel.digest)
        if sent is None:
            # A task instead of scattered data: it is computed again if the worker that has it dies.
            key = f"robbdd-files-{parcel.digest}-{uuid4()}"
            sent = self._sent[parcel.digest] = _Sent(self._client.submit(_same, parcel, key=key, pure=False))
        sent.uses += 1
        return sent.future

    def _release(self, flight: _Flight) -> None:
        for parcel in (flight.used, flight.prepared):
            sent = self._sent.get(parcel.digest)
            if sent is not None:
                sent.uses -= 1
                if sent.uses == 0:
                    del self._sent[parcel.digest]

    def _forget_sent(self) -> None:
        """Forget the values that the scheduler has lost. Values that it still has stay with the parts that use them."""
        lost = [name for name, sent in self._sent.items() if sent.future.status in ("cancelled", "lost", "error")]
        for name in lost:
            del self._sent[name]

    def _reconnect(self) -> None:
        self.note(f"the connection to {self.address} is lost: trying to connect again")
        while not self._cancelled.is_set():
            try:
                self._client = self._connected()
                break
            except ClusterProblem:
                self._cancelled.wait(LOOK)
        self._sent.clear()
        for flight in self._flights:
            flight.future = self._submitted(flight.part, flight.used, flight.prepared)

    def _connected(self) -> Any:
        try:
            distributed: Any = import_module("distributed")
        except ImportError:
            raise ClusterProblem(_MISSING) from None
        try:
            return distributed.Client(self.address, timeout=CONNECTING, set_as_default=False, name="robbdd")
        except (OSError, TimeoutError, ValueError) as error:
            reason = str(error) or "it does not answer"
            raise ClusterProblem(f"there is no scheduler at {self.address}: {reason}") from None

    def _shares(self, workers: Iterable[str]) -> dict[str, int]:
        sizes = {flight.future.key: len(flight.part.indices) for flight in self._flights}
        try:
            found: Mapping[str, Sequence[str]] = self._client.processing()
        except (OSError, TimeoutError):
            return {}
        return {one: sum(sizes.get(key, 0) for key in found.get(one, ())) for one in workers}

    def _workers(self) -> dict[str, int]:
        try:
            found: dict[str, int] = self._client.nthreads()
        except (OSError, TimeoutError):
            return {}
        return found


def _unusable(error: object) -> str:
    if isinstance(error, ImportError):
        return "no robbdd-tools of this version"
    return f"an error: {error}"


def _other(there: Mapping[str, str]) -> Iterator[str]:
    return differences(versions(), there)


def _versions_there() -> Mapping[str, str]:
    return versions()


def _same(parcel: Parcel) -> Parcel:
    return parcel


def _on_worker(part: Part, used: Parcel, prepared: Parcel) -> PartResult:
    """Execute a part on the worker of the current task."""
    distributed: Any = import_module("distributed")
    worker = distributed.get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        task = worker.state.tasks.get(key)
        return task is not None and task.state == "executing"

    return execute_part(part, used, prepared, Path(worker.local_directory) / "robbdd", wanted)
