"""The requests to the process that renders a user's template (see ``template_worker``)."""

from __future__ import annotations

import pickle
from base64 import b64decode, b64encode
from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class TemplateSource:
    """A request to compile a template. The answer is the list of its blocks."""

    file: str
    source: str


@dataclass(frozen=True, slots=True)
class BlockRequest:
    """A request to render a block. ``fresh`` has, by name, the values that differ from the last request."""

    block: str
    names: tuple[str, ...]
    fresh: Mapping[str, object]


Request = TemplateSource | BlockRequest


def encoded(request: Request) -> str:
    """Return a request in the form in which the worker reads it."""
    return b64encode(pickle.dumps(request)).decode("ascii") + "\n"


def decoded(line: str) -> Request:
    """Return the request on a line of the worker's input."""
    return pickle.loads(b64decode(line))
