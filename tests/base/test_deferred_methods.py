"""Classes with deferred methods behave as classes whose methods are compiled at once."""

import dataclasses
import inspect
import pickle
import subprocess
import sys
from collections.abc import Callable
from dataclasses import InitVar, dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import attr._make
import attrs
import pytest

from robbdd_tools.base import deferred_methods as module
from robbdd_tools.base.deferred_methods import deferred_methods
from robbdd_tools.base.diagnostic import Edit
from robbdd_tools.base.document import Span

LIBRARIES = ((dataclasses, "_create_fn"), (attr._make, "_linecache_and_compile"))


def _classes() -> SimpleNamespace:
    """Define classes of all kinds that the package and the types of the protocol have."""

    @dataclass(frozen=True, slots=True)
    class Frozen:
        number: int
        words: tuple[str, ...] = ()

    @dataclass(order=True, unsafe_hash=True)
    class Ordered:
        number: int
        parts: list[int] = field(default_factory=list[int], hash=False)
        given: InitVar[int] = 0
        name: str = field(default="", kw_only=True)

        def __post_init__(self, given: int) -> None:
            self.number += given

    @dataclass(frozen=True, slots=True)
    class Derived(Frozen):
        more: int = 7

    @dataclass
    class OwnWords:
        number: int

        def __repr__(self) -> str:
            return f"own {self.number}"

    @attrs.define
    class Position:
        line: int = attrs.field(validator=attrs.validators.instance_of(int))
        name: str = attrs.field(default="a")

    @attrs.frozen(order=True)
    class Key:
        name: str
        arguments: int = 0

    return SimpleNamespace(**locals())


OUTCOMES: tuple[Callable[[SimpleNamespace], Any], ...] = (
    lambda c: repr(c.Frozen(1, ("a",))),
    lambda c: c.Frozen(1) == c.Frozen(1),
    lambda c: c.Frozen(1) == c.Derived(1),
    lambda c: hash(c.Frozen(1)) == hash(c.Frozen(1)),
    lambda c: hash(c.OwnWords(1)),
    lambda c: setattr(c.Frozen(1), "number", 2),
    lambda c: delattr(c.Derived(1), "more"),
    lambda c: c.Frozen(),
    lambda c: c.Frozen(1, 2, 3),
    lambda c: c.Frozen(other=1),
    lambda c: repr(replace(c.Derived(1, more=2), number=3)),
    lambda c: repr(c.Derived(1)),
    lambda c: repr(c.Ordered(1, given=2, name="x")),
    lambda c: c.Ordered(1, [], 0, "x"),
    lambda c: (c.Ordered(1) < c.Ordered(2), c.Ordered(1) >= c.Ordered(2), c.Ordered(1) < 3),
    lambda c: c.Ordered(1).parts is c.Ordered(1).parts,
    lambda c: hash(c.Ordered(1, [2])) == hash(c.Ordered(1, [3])),
    lambda c: repr(c.OwnWords(1)),
    lambda c: repr(c.Position(1)),
    lambda c: c.Position("1"),
    lambda c: setattr(c.Position(1), "line", "1"),
    lambda c: c.Position(1) == c.Position(1, name="a"),
    lambda c: hash(c.Position(1)),
    lambda c: repr(attrs.evolve(c.Position(1), name="b")),
    lambda c: repr(c.Key(name="a", arguments=3)),
    lambda c: (c.Key("a") < c.Key("b"), hash(c.Key("a")) == hash(c.Key("a"))),
    lambda c: setattr(c.Key("a"), "name", "b"),
    lambda c: c.Key(nothing=1),
    lambda c: [type(value).__name__ for value in attrs.astuple(c.Position(1))],
)


def _outcome(work: Callable[[SimpleNamespace], Any], classes: SimpleNamespace) -> str:
    try:
        return repr(work(classes))
    except Exception as error:  # whatever a compiled method raises
        return f"{type(error).__name__}: {error}"


@pytest.mark.parametrize("number", range(len(OUTCOMES)))
def test_a_first_and_a_second_call_give_what_compiled_methods_give(number: int) -> None:
    at_once = _classes()
    with deferred_methods():
        deferred = _classes()
    expected = _outcome(OUTCOMES[number], at_once)
    assert [_outcome(OUTCOMES[number], deferred) for _ in range(2)] == [expected] * 2


def test_methods_are_compiled_at_their_first_call_and_then_take_their_place() -> None:
    with deferred_methods():
        made = _classes()
    first = {kind: made.__dict__[kind].__init__ for kind in ("Frozen", "Position")}
    assert all(inspect.getmodule(method.__code__) is module for method in first.values())
    made.Frozen(1)
    made.Position(1)
    for kind, deferred in first.items():
        compiled = made.__dict__[kind].__init__
        assert compiled is not deferred
        assert compiled.__code__.co_filename != module.__file__
        names = ("__name__", "__qualname__", "__module__", "__doc__")
        ordinary = getattr(_classes(), kind).__init__
        assert [getattr(compiled, name) for name in names] == [getattr(ordinary, name) for name in names]
        assert compiled.__annotations__ == ordinary.__annotations__


def test_a_method_of_a_base_class_takes_its_place_in_the_base_class() -> None:
    with deferred_methods():

        @dataclass(frozen=True)
        class Base:
            number: int

        class Derived(Base):
            pass

    assert Derived(1) == Derived(1)
    assert "__init__" not in vars(Derived)
    assert inspect.getmodule(Base.__init__.__code__) is not module


def test_the_libraries_compile_at_once_outside_of_the_context() -> None:
    before = [getattr(library, name) for library, name in LIBRARIES]

    def fail() -> None:
        with deferred_methods():
            assert [getattr(library, name) for library, name in LIBRARIES] != before
            raise ValueError("inside")

    with pytest.raises(ValueError, match="inside"):
        fail()
    assert [getattr(library, name) for library, name in LIBRARIES] == before


def test_libraries_of_another_form_compile_as_always(monkeypatch: pytest.MonkeyPatch) -> None:
    # dataclasses itself needs its function; Python 3.13 has none of this name.
    monkeypatch.delattr(dataclasses, "_create_fn")
    with deferred_methods():
        assert not hasattr(dataclasses, "_create_fn")

        @attrs.define
        class Position:
            line: int

    assert not hasattr(dataclasses, "_create_fn")
    assert repr(Position(1)).endswith("Position(line=1)")


def test_what_else_a_script_of_attrs_defines_is_compiled_for_whoever_reads_it() -> None:
    compiled: list[str] = []

    def compile_script(script: str, filename: str, globals: dict[str, Any]) -> dict[str, Any]:
        compiled.append(filename)
        exec(script, globals, found := {})  # as attrs does
        return found

    made = module.defer_script(compile_script)("helper = 4\ndef __init__(self):\n    self.x = 1\n", "a", {})
    method = made["__init__"]
    assert compiled == []
    assert made["helper"] == 4
    assert method(SimpleNamespace()) is None
    assert compiled == ["a"]
    with pytest.raises(KeyError):
        made["nothing"]


def test_instances_can_be_pickled() -> None:
    script = (
        "from robbdd_tools.base.deferred_methods import deferred_methods\n"
        "with deferred_methods():\n"
        "    from robbdd_tools.base.diagnostic import Edit\n"
        "    from robbdd_tools.base.document import Span\n"
        "import pickle, sys\n"
        "sys.stdout.buffer.write(pickle.dumps(Edit('a', Span(1, 2), 'b')))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
    assert pickle.loads(done.stdout) == Edit("a", Span(1, 2), "b")


def test_the_language_server_compiles_only_methods_that_it_calls() -> None:
    script = (
        "from robbdd_tools.lsp.main import load_server\n"
        "server = load_server()\n"
        "from lsprotocol.types import CallHierarchyItem\n"
        "from robbdd_tools.graph.acceptance_model import AcceptanceModel\n"
        "for kind in (CallHierarchyItem, AcceptanceModel):\n"
        "    print(kind.__init__.__code__.co_filename.endswith('deferred_methods.py'))\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True, text=True)
    assert done.stdout.split() == ["True", "True"]
