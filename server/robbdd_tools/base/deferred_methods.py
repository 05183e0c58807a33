"""Compile the generated methods of classes at their first call.

``dataclasses`` and ``attrs`` write the methods of a class as text, and compile them when the class is made. That is
about half of the time that it takes to import a thousand classes. Few of these methods are called before a language
server shows its first diagnostics, and many never.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Generator
from contextlib import contextmanager
from types import FunctionType, ModuleType
from typing import Any, cast

_Maker = Callable[..., Any]
_DEFINED = re.compile(r"^def (\w+)\(", re.MULTILINE)


@contextmanager
def deferred_methods() -> Generator[None]:
    """Defer compiling the methods of all data classes that are defined within this context.

    Both libraries compile in one function, which is private. A version without this function compiles as always.
    """
    with _replaced(dataclasses, "_create_fn", _defer_function), _replaced(_attrs(), _ATTRS_COMPILER, defer_script):
        yield


_ATTRS_COMPILER = "_linecache_and_compile"


def _attrs() -> ModuleType | None:
    try:
        import attr._make
    except ImportError:
        return None
    return attr._make


@contextmanager
def _replaced(module: ModuleType | None, name: str, deferring: Callable[[_Maker], _Maker]) -> Generator[None]:
    original = getattr(module, name, None)
    if module is None or not callable(original):
        yield
        return
    setattr(module, name, deferring(original))
    try:
        yield
    finally:
        setattr(module, name, original)


def _defer_function(create: _Maker) -> _Maker:
    """Defer the function of ``dataclasses`` that makes one method."""

    def deferring(name: str, *arguments: Any, **keywords: Any) -> FunctionType:
        namespace: dict[str, Any] = keywords.get("globals") or {}
        return _deferred(name, lambda: create(name, *arguments, **keywords), namespace.get("__name__", "builtins"))

    return deferring


def defer_script(compile_script: _Maker) -> _Maker:
    """Defer the function of ``attrs`` that makes all methods of a class from one text. It returns them by name."""

    def deferring(script: str, *arguments: Any, **keywords: Any) -> dict[str, Any]:
        methods = _Script(lambda: compile_script(script, *arguments, **keywords))
        for name in _DEFINED.findall(script):
            methods[name] = _deferred(name, lambda name=name: methods.compiled()[name])
        return methods

    return deferring


class _Script(dict[str, Any]):
    """The deferred methods of a class by name. Access to any other name compiles the text."""

    def __init__(self, compile_script: Callable[[], dict[str, Any]]) -> None:
        super().__init__()
        self._compile = compile_script
        self._compiled: dict[str, Any] | None = None

    def __missing__(self, name: str) -> Any:
        return self.compiled()[name]

    def compiled(self) -> dict[str, Any]:
        """Return everything that the text defines."""
        if self._compiled is None:
            self._compiled = self._compile()
        return self._compiled


def _deferred(name: str, compile_method: Callable[[], FunctionType], module: str = "builtins") -> FunctionType:
    """Return a stand-in for a method. At its first call, it compiles the method and puts it into the class."""
    compiled: list[FunctionType] = []

    def method(self: Any, /, *arguments: Any, **keywords: Any) -> Any:
        if not compiled:
            compiled.append(_with_attributes_of(cast("FunctionType", method), compile_method()))
        for owner in type(self).__mro__:
            if owner.__dict__.get(name) is method:
                setattr(owner, name, compiled[0])
        return compiled[0](self, *arguments, **keywords)

    method.__name__ = method.__qualname__ = name
    method.__module__ = module
    method.__annotations__ = {}
    return cast("FunctionType", method)


def _with_attributes_of(method: FunctionType, compiled: FunctionType) -> FunctionType:
    """Copy to a compiled method the attributes that a library has set on its stand-in."""
    compiled.__qualname__, compiled.__module__, compiled.__doc__ = (
        method.__qualname__,
        method.__module__,
        method.__doc__,
    )
    compiled.__annotations__ |= method.__annotations__
    compiled.__dict__.update(method.__dict__)
    return compiled
