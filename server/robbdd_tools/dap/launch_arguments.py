"""The arguments of *launch*: a model and the selection of one of its executions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from robbdd_tools.base.exceptions import RobbddError
from robbdd_tools.base.plain import from_plain
from robbdd_tools.workbench.clause_debugging import DebugRequest
from robbdd_tools.workbench.folder import Keeping
from robbdd_tools.workbench.plan import Selection

Kind = TypeVar("Kind")
NAMES: dict[type, str] = {str: "a text", int: "a number", bool: "true or false"}


class InvalidArguments(RobbddError):
    """Arguments of a request have the wrong form; the message names the argument."""


def debug_request(arguments: Mapping[str, Any]) -> DebugRequest:
    """Return the request that the arguments of *launch* describe. Raises ``InvalidArguments``."""
    program = _one(arguments, "program", str)
    if not program:
        raise InvalidArguments("'program' is missing: name the .bdd or .bddx file whose scenario is debugged")
    folder = Path(_one(arguments, "cwd", str) or Path.cwd())
    names = [name for name in (_one(arguments, "scenario", str),) if name]
    try:
        substitutions = from_plain(dict[str, str], arguments.get("bhv") or {})
        files = from_plain(tuple[str, ...], arguments.get("scenex") or [])
    except TypeError:
        form = "'bhv' must map implementations to behaviours of the catalog, and 'scenex' must be a list of files"
        raise InvalidArguments(form) from None
    selection = Selection(
        names, where=_one(arguments, "where", str), seed=_one(arguments, "seed", int), substitutions=substitutions
    )
    store = _one(arguments, "store", str)
    return DebugRequest(
        (folder / program).absolute(),
        selection,
        _one(arguments, "variation", int),
        _one(arguments, "repetition", int),
        tuple(folder / name for name in files),
        Keeping(store=None if store is None else folder / store, keep=not _one(arguments, "noStore", bool)),
        bool(_one(arguments, "python", bool)),
    )


def _one(arguments: Mapping[str, Any], name: str, kind: type[Kind]) -> Kind | None:
    value = arguments.get(name)
    if value is None:
        return None
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise InvalidArguments(f"'{name}' must be {NAMES[kind]}, not {value!r}")
    return value
