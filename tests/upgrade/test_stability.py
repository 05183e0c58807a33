"""What ``docs/upgrading.md`` promises to stay: public names of Python, commands, options, and exit codes.

``promised.json`` has what the first version had. Removing something from it without a warning is a fault.
``ROBBDD_ACCEPT=1 pytest tests/upgrade/test_stability.py`` adds what is new, at each release.
"""

from __future__ import annotations

import argparse
import inspect
import json
import os
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import robbdd_tools
from kit import DOCS
from report_kit import ACCEPT
from robbdd_tools import commands
from robbdd_tools.cli import argument_parser
from robbdd_tools.commands.shell_completion import arguments_of, commands_of

PROMISED = Path(__file__).with_name("promised.json")
Promise = Mapping[str, list[str]]
"""Name of a function, class or command → its parameters or options; ``!`` is behind those that are required."""


def parameters(value: object) -> list[str]:
    """Return the parameters of a function; of a class, its public attributes and the parameters of its methods."""
    if not inspect.isclass(value):
        return list(_of_function("", value)) if callable(value) else []
    found: list[str] = []
    members: dict[str, object] = {}
    for owner in value.__mro__:
        # What enumerations and exceptions have from Python is not ours.
        if owner.__module__.startswith(robbdd_tools.__name__):
            members = {**dict.fromkeys(inspect.get_annotations(owner)), **vars(owner), **members}
    for name, member in sorted(members.items()):
        if not name.startswith("_"):
            found.append(name)
            function: object = getattr(member, "__func__", member)
            found += _of_function(f"{name}.", function) if inspect.isfunction(function) else ()
    return found


def _of_function(prefix: str, function: Any) -> Iterator[str]:
    for one in inspect.signature(function).parameters.values():
        required = one.default is one.empty and one.kind not in (one.VAR_POSITIONAL, one.VAR_KEYWORD)
        if one.name not in ("self", "cls"):
            yield f"{prefix}{one.name}{'!' if required else ''}"


def public_names(module: ModuleType) -> Promise:
    return {name: parameters(getattr(module, name)) for name in sorted(module.__all__)}


def options(name: str, parser: argparse.ArgumentParser) -> Iterator[tuple[str, list[str]]]:
    """Yield each command with its options, and with the arguments that it needs."""
    own: list[str] = []
    for action in arguments_of(parser):
        for word, command in commands_of(action).items():
            yield from options(f"{name} {word}", command)
        needed = action.nargs not in ("?", "*") and not commands_of(action)
        required = action.required if action.option_strings else needed
        own += [f"{one}{'!' if required else ''}" for one in action.option_strings or [action.dest]]
    yield name, own


def faults(promised: Promise, now: Promise, module: ModuleType | None = None) -> Iterator[str]:
    """Yield what no longer stays as it was promised. Names that a module gives with a warning may be missing."""
    for name, before in promised.items():
        if name not in now:
            if module is None or not warns(module, name):
                yield f"{name} is gone without a DeprecationWarning"
            continue
        for one in before:
            if one.rstrip("!") not in {found.rstrip("!") for found in now[name]}:
                yield f"{name}: {one.rstrip('!')} is gone"
        for one in now[name]:
            function = one.rpartition(".")[0]
            is_old = not function or function in before
            if one.endswith("!") and is_old and one not in before:
                yield f"{name}: {one.rstrip('!')} has become required"


def warns(module: ModuleType, name: str) -> bool:
    """Return whether a module gives a name with a ``DeprecationWarning``."""
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        found = getattr(module, name, None)
    return found is not None and any(issubclass(one.category, DeprecationWarning) for one in heard)


def test_public_names_commands_and_options_stay() -> None:
    now = {"names": public_names(robbdd_tools), "commands": dict(sorted(options("robbdd", argument_parser())))}
    if ACCEPT in os.environ:
        PROMISED.write_text(json.dumps(now, indent=1) + "\n", encoding="utf-8")
    promised: Mapping[str, Promise] = json.loads(PROMISED.read_text(encoding="utf-8"))
    assert list(faults(promised["names"], now["names"], robbdd_tools)) == []
    assert list(faults(promised["commands"], now["commands"])) == []
    assert {"load", "compare", "Run"} <= promised["names"].keys()
    assert "--jobs" in promised["commands"]["robbdd study run"]


def test_exit_codes_stay() -> None:
    assert (commands.OK, commands.FINDINGS, commands.FAILED, commands.CANNOT_TELL) == (0, 1, 2, 3)
    assert commands.signal_code(15) == 143


@pytest.mark.parametrize(
    ("now", "fault"),
    [
        ({"load": ["path!", "more"]}, []),
        ({"load": ["path", "more", "new"], "other": ["x!"]}, []),
        ({}, ["load is gone without a DeprecationWarning"]),
        ({"load": ["path!"]}, ["load: more is gone"]),
        ({"load": ["path!", "more!"]}, ["load: more has become required"]),
        ({"load": ["path!", "more", "new!"]}, ["load: new has become required"]),
        ({"load": ["path!", "more", "method.new!"]}, []),
    ],
)
def test_what_is_taken_away_is_found(now: Promise, fault: list[str]) -> None:
    assert list(faults({"load": ["path!", "more"]}, now, ModuleType("empty"))) == fault


def test_a_name_may_go_after_a_version_with_a_warning() -> None:
    module = ModuleType("warning")

    def given(name: str) -> object:
        warnings.warn(f"{name} is called otherwise", DeprecationWarning, stacklevel=2)
        return load

    def load() -> None: ...

    assert list(faults({"load": []}, {}, module)) == ["load is gone without a DeprecationWarning"]
    vars(module)["load"] = load
    assert list(faults({"load": []}, {}, module)) == ["load is gone without a DeprecationWarning"]
    del vars(module)["load"]
    vars(module)["__getattr__"] = given
    assert list(faults({"load": []}, {}, module)) == []


def test_a_replaced_name_of_the_package_is_the_new_one_with_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robbdd_tools, "_REPLACED", {"open_model": "load"})
    assert list(faults({"open_model": ["path!"]}, {}, robbdd_tools)) == []
    with pytest.warns(DeprecationWarning, match=r"robbdd_tools\.open_model goes in the next version: write load"):
        assert robbdd_tools.__getattr__("open_model") is robbdd_tools.load


def test_the_page_on_upgrading_states_what_this_test_enforces() -> None:
    page = (DOCS / "upgrading.md").read_text(encoding="utf-8")
    assert "names in `robbdd_tools.__all__`" in page
    assert "`DeprecationWarning`" in page
    assert "tests/upgrade/test_stability.py" in page
