"""Complete, describe and find the names of model parts in scene instances, from the text of the model files."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.base.document import Span
from robbdd_tools.base.files import UnreadableFile, path_to_uri, uri_to_path
from robbdd_tools.base.model_parts import model_parts
from robbdd_tools.base.model_paths import package_share
from robbdd_tools.base.source_texts import load_source
from robbdd_tools.checks.model_file import model_path
from robbdd_tools.checks.model_name import ACCEPTED, WANTED, part_names, parts_named
from robbdd_tools.features.markdown import code, literal
from robbdd_tools.features.outside_place import OutsidePlace
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk_at

if TYPE_CHECKING:
    from pathlib import Path

    from robbdd_tools.base.model_part import ModelPart
    from robbdd_tools.base.model_parts import ModelParts
    from robbdd_tools.names.project import Snapshot

_TEXT = r"""(?:"[^"\n]*"|'[^'\n]*')"""
_ENTRIES = {
    "map body": re.compile(r"\bmap\s+body\s*<[^<>\n]*>\s*to\s*\Z"),
    "tool": re.compile(r"\btool\s*:\s*\Z"),
    "on": re.compile(r"\bon\s*:\s*\Z"),
    "actuator": re.compile(r"\bactuator\s*:\s*\Z"),
    "joint": re.compile(r"\bjoint\s*:\s*\Z"),
    "pads": re.compile(rf"\bpads\s*:\s*(?:{_TEXT}\s*,\s*)*\Z"),
}
_MODEL = re.compile(r"\bmodel\s+[\w-]+\s+(?:as\s+)?(?:mjcf|urdf)\s*\{")
_SYSTEM = re.compile(rf"\bsys\s+path\s*=\s*({_TEXT})")
_GRIPPER = re.compile(r"\bgripper\s*\{\s*(?:sys|ros)\b")
_OF_GRIPPER = ("tool", "actuator", "pads")
"""Entries that name parts of the gripper, where it has a file of its own."""
_ROS = re.compile(rf"\bros\s+pkg\s*=\s*({_TEXT})\s*,\s*path\s*=\s*({_TEXT})")
_NAME = re.compile(r"\bname\s*=\s*([\"'])")
MAX_SHOWN = 8
"""Maximum number of names of each kind that the description of a file lists."""
PART_KINDS = {"body": "bodies", "joint": "joints", "site": "sites", "geom": "geoms", "actuator": "actuators"}
"""Kind of a part → its plural."""


def part_choices(uri: str, text: str, offset: int) -> Iterator[tuple[str, str, str, str]]:
    """Yield the completions of a part's name in open quotes at an offset of a scene instance's text.

    Each one has a name, a kind, the facts about the part, and the typed part of the name. The text may be broken: the
    model is the last one that begins before the offset.
    """
    own = uri_to_path(uri)
    line = text.rfind("\n", 0, offset) + 1
    quote = max(text.rfind('"', line, offset), text.rfind("'", line, offset))
    entry = None if quote < 0 else next((one for one, form in _ENTRIES.items() if form.search(text, 0, quote)), None)
    if own is None or entry is None:
        return
    path = _path_in_text(text, quote, own.parent, entry in _OF_GRIPPER)
    if path is None or not path.is_file():
        return
    typed = text[quote + 1 : offset]
    for part in model_parts(path).names(*WANTED[entry]):
        yield part.name, part.kind, ", ".join((part.word, *part.facts)), typed


def part_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, ModelPart] | None:
    """Return the part of a model file that the text at an offset names, and the absolute span of the text."""
    own, file = uri_to_path(uri), snapshot.file(uri)
    for placed in file.declarations if file is not None and own is not None else ():
        if own is not None and placed.span.contains(offset):
            for named in part_names(placed.declaration):
                span = named.text.span.shifted(placed.offset)
                parts = parts_named(named, own.parent) if span.contains(offset) else None
                part = None if parts is None else parts.find(named.text.value, *ACCEPTED[named.entry])
                if part is not None:
                    return span, part
    return None


def file_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, Path] | None:
    """Return the model file whose path is at an offset, and the absolute span of the path."""
    own, file = uri_to_path(uri), snapshot.file(uri)
    for placed in file.declarations if file is not None and own is not None else ():
        root = placed.declaration.tree
        if own is None or not isinstance(root, tree.SceneInstance) or not placed.span.contains(offset):
            continue
        for node in walk_at(root, offset - placed.offset):
            if isinstance(node, tree.SystemPath | tree.RosPath):
                path, span = model_path(own.parent, node), node.path.span.shifted(placed.offset)
                return (span, path) if path is not None and path.is_file() and span.contains(offset) else None
    return None


def part_definition(part: ModelPart) -> OutsidePlace:
    """Return the place of a part in its file: the place of its name or, if it has none, of its element."""
    text = _text(part.path)
    end = text.find(">", part.start)
    found = _NAME.search(text, part.start, end if end >= 0 else len(text))
    start = part.start if found is None else found.end()
    stop = start if found is None else start + len(part.name)
    return OutsidePlace(path_to_uri(part.path), text, Span(start, stop))


def file_definition(path: Path) -> OutsidePlace:
    """Return the start of a model file."""
    return OutsidePlace(path_to_uri(path), "", Span(0, 0))


def describe_part(part: ModelPart) -> str:
    """Describe a part by the facts in its file."""
    line = _text(part.path).count("\n", 0, part.start) + 1
    owner = [f"of the body {code(part.owner)}"] if part.owner and part.kind != "body" else []
    owner += [f"in the body {code(part.owner)}"] if part.owner and part.kind == "body" else []
    lines = [f"- {literal(fact)}" for fact in part.facts]
    title = " ".join((f"**{part.word}** {code(part.name)}", *owner))
    return "\n\n".join(filter(None, (title, "\n".join(lines), code(f"{part.path.name}:{line}"))))


def describe_file(path: Path) -> str:
    """Describe a model file by the names of its parts."""
    parts = model_parts(path)
    if not parts.format:
        return f"**model file** {code(path.name)}\n\n{literal(parts.problem)}"
    title = f"**{parts.format.upper()} model** {code(parts.title or path.name)}"
    lines = [f"- {words}" for kind in PART_KINDS if (words := _counted(parts, kind))]
    return f"{title}\n\n" + "\n".join((*lines, *(f"- {literal(reason)}" for reason in parts.missing)))


def _counted(parts: ModelParts, kind: str) -> str:
    names = [part.name for part in parts.names(kind)]
    if not names:
        return ""
    more = f" and {len(names) - MAX_SHOWN} more" if len(names) > MAX_SHOWN else ""
    word = kind if len(names) == 1 else PART_KINDS[kind]
    return f"{len(names)} {word}: {', '.join(map(code, names[:MAX_SHOWN]))}{more}"


def _path_in_text(text: str, offset: int, folder: Path, of_gripper: bool) -> Path | None:
    """Return the path of the model whose block contains an offset: that of its gripper, if it has one and is wanted."""
    starts = [found.end() for found in _MODEL.finditer(text, 0, offset)]
    if not starts:
        return None
    following = _MODEL.search(text, offset)
    block = text[starts[-1] : following.start() if following is not None else len(text)]
    mounted = _GRIPPER.search(block) if of_gripper else None
    block = block if mounted is None else block[mounted.start() :]
    system, ros = _SYSTEM.search(block), _ROS.search(block)
    try:
        if system is not None:
            return folder.joinpath(system[1][1:-1]).expanduser()
    except RuntimeError:
        # The home folder of an unknown user.
        return None
    share = None if ros is None else package_share(ros[1][1:-1])[0]
    return None if ros is None or share is None else share / ros[2][1:-1]


def _text(path: Path) -> str:
    try:
        return load_source(path)
    except UnreadableFile:
        return ""
