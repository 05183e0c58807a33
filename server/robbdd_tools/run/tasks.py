"""Group the scenarios of a run into tasks. Each task is executed by one agent."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from robbdd_tools.protocol.specs import Manifest


def grouped(manifest: Manifest, indices: Iterable[int]) -> Iterator[tuple[int, ...]]:
    """Group the scenarios that share an execution. A group is at the position of its first scenario."""
    together: dict[int | str, list[int]] = {}
    for index in indices:
        tree = manifest.scenarios[index].tree
        together.setdefault(index if tree is None else tree.name, []).append(index)
    return map(tuple, together.values())


def earlier_than(index: int, task: Iterable[int]) -> tuple[int, ...]:
    """Return the scenarios of a task with a number below ``index``."""
    return tuple(waiting for waiting in task if waiting < index)
