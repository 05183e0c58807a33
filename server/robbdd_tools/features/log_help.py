"""Complete and describe the names in logs of real robots, from the summaries that a background process makes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from robbdd_tools.features.markdown import code, literal
from robbdd_tools.logs.log_files import log_path
from robbdd_tools.logs.summary_cache import known_summary
from robbdd_tools.syntax import tree
from robbdd_tools.syntax.symbols import walk

if TYPE_CHECKING:
    from robbdd_tools.base.document import Span
    from robbdd_tools.logs.log_summary import LogSummary
    from robbdd_tools.names.project import Snapshot

_LOG = re.compile(r"\brobot\s+log\b[^{}]*\{")
_PATH = re.compile(r"\bpath\s*:\s*([\"'])([^\"'\n]*)\1")
_PART = re.compile(r"\b(?P<part>base\s+frames|frames|world\s+frame|joint\s+topics|events|grips)\s*:")
_PROVIDER = re.compile(r"\b(?P<part>(?:ros|trinary)\s+topic|type|reference-frame)\s*:\s*\Z")
_TYPED_TOPIC = re.compile(r"\btopic\s*:\s*[\"']([^\"'\n]*)[\"']\s*type\s*:\s*\Z")
_FIELD = re.compile(r"(/[^\s.]+)\.([^\s]*)\Z")
_JOINT = re.compile(r"(?:joint|effort)\s+(\S*)\Z")
_TOPIC = re.compile(r"(?:wrench\s+)?(/?[^\s.]*)\Z")
Choice = tuple[str, str, str, str]
"""A name, its kind, facts about it, and the part of it that is already typed."""


def log_choices(uri: str, text: str, offset: int) -> Iterator[Choice]:
    """Yield the completions of a name of a log in open quotes at an offset of a ``.bddx``. The text may be broken."""
    line = text.rfind("\n", 0, offset) + 1
    quote = max(text.rfind('"', line, offset), text.rfind("'", line, offset))
    if quote < 0:
        return
    before, typed = text[:quote], text[quote + 1 : offset]
    provider = _PROVIDER.search(before)
    starts = [found.end() for found in _LOG.finditer(before)]
    if provider is not None:
        wanted = " ".join(provider["part"].split())
        of_topic = _TYPED_TOPIC.search(before)
        for summary in _summaries(uri, text):
            yield from _of_provider(summary, wanted, of_topic[1] if of_topic else "", typed)
    elif starts:
        part = list(_PART.finditer(before, starts[-1]))
        summary = next(_summaries(uri, text[starts[-1] :]), None)
        if part and summary is not None:
            yield from _of_part(summary, " ".join(part[-1]["part"].split()), typed)


def _summaries(uri: str, text: str) -> Iterator[LogSummary]:
    """Yield the known summaries of the logs that a text names, in its order."""
    for found in _PATH.finditer(text):
        path = log_path(uri, found[2])
        summary = None if path is None else known_summary(path)
        if summary is not None:
            yield summary


def _of_provider(summary: LogSummary, part: str, topic: str, typed: str) -> Iterator[Choice]:
    if part == "reference-frame":
        yield from _frames(summary, typed)
    elif part == "type":
        known = summary.topics.get(topic)
        kinds = {one.type: name for name, one in summary.topics.items() if known in (None, one)}
        yield from ((kind, "type", f"on {name}", typed) for kind, name in sorted(kinds.items()) if kind)
    else:
        yield from _topics(summary, typed)


def _of_part(summary: LogSummary, part: str, typed: str) -> Iterator[Choice]:
    match part:
        case "events" | "grips":
            if part == "grips" and (joint := _JOINT.search(typed)):
                names = sorted({name for joints in summary.joints.values() for name in joints})
                yield from ((name, "joint", "", joint[1]) for name in names)
            elif field := _FIELD.search(typed):
                topic = summary.topics.get(field[1])
                yield from ((path, "field", kind, field[2]) for path, kind in (topic.fields if topic else ()))
            elif named := _TOPIC.fullmatch(typed):
                yield from _topics(summary, named[1])
        case "joint topics":
            yield from ((topic, "topic", topic_facts(summary, topic), typed) for topic in summary.joints)
        case _:
            yield from _frames(summary, typed)


def _topics(summary: LogSummary, typed: str) -> Iterator[Choice]:
    yield from ((name, "topic", topic_facts(summary, name), typed) for name in summary.topics)


def _frames(summary: LogSummary, typed: str) -> Iterator[Choice]:
    yield from ((name, "frame", frame_facts(summary, name), typed) for name in sorted(summary.names_of_frames()))


def topic_facts(summary: LogSummary, topic: str) -> str:
    """Return the type, the number of messages and the rate of a topic, in words."""
    one = summary.topics.get(topic)
    if one is None:
        return ""
    return f"{one.type or 'unknown type'}, {one.count:,} messages, {summary.rate(topic):.3g} Hz"


def frame_facts(summary: LogSummary, name: str) -> str:
    """Return the parent, the rate and the period of a frame's poses, in words."""
    frame = summary.frames.get(name)
    if frame is None:
        return "root of the frames"
    below = f"in {frame.parent}" if frame.parent else "without parent"
    if frame.static:
        return f"{below}, static"
    return f"{below}, {frame.count:,} poses, {frame.rate:.3g} Hz, from {frame.first:.2f} s to {frame.last:.2f} s"


def log_name_at(snapshot: Snapshot, uri: str, offset: int) -> tuple[Span, str] | None:
    """Return the span and the description, in Markdown, of the name of a log at an offset."""
    file = snapshot.file(uri)
    for placed in file.declarations if file is not None else ():
        root = placed.declaration.tree
        if not placed.span.contains(offset) or root is None:
            continue
        for text, part in _texts(root):
            span = text.span.shifted(placed.offset)
            if span.contains(offset) and file is not None:
                found = _described(uri, file.document.text, root, text, part)
                return None if found is None else (span, found)
    return None


def _texts(root: tree.ChunkTree) -> Iterator[tuple[tree.Text, str]]:
    """Yield the names of logs in a declaration, each with its kind."""
    match root:
        case tree.RobotLog():
            yield root.path, "path"
            yield from ((one.text, "frame") for one in (*root.frames, *root.bases))
            yield from ((one.text, "topic") for one in root.joints)
            yield from ((one.signal, "signal") for one in (*root.events, *root.grips))
            if root.world is not None:
                yield root.world, "frame"
        case tree.Provider() | tree.Policy():
            for node in walk(root):
                match node:
                    case tree.RosTopic() | tree.TrinaryTopic():
                        yield node.topic, "topic"
                    case tree.Transforms():
                        yield node.frame, "frame"
                    case _:
                        pass
        case _:
            pass


def _described(uri: str, text: str, root: tree.ChunkTree, name: tree.Text, part: str) -> str | None:
    own = log_path(uri, root.path.value) if isinstance(root, tree.RobotLog) else None
    known = known_summary(own) if own is not None else next(_summaries(uri, text), None)
    if known is None:
        return None
    if part == "path":
        return _described_log(known)
    value = name.value
    if part == "signal":
        topics = [word for word in re.split(r"[\s.]", value) if word in known.topics]
        value, part = (topics[0], "topic") if topics else (value, "")
    if part == "topic" and value in known.topics:
        return f"**topic** {code(value)}\n\n{literal(topic_facts(known, value))}"
    if part == "frame" and value.lstrip("/") in known.names_of_frames():
        return f"**frame** {code(value)}\n\n{literal(frame_facts(known, value.lstrip('/')))}"
    return None


def _described_log(summary: LogSummary) -> str:
    if summary.problem:
        return f"**log**\n\n{literal(summary.problem)}"
    topics = "".join(f"\n- {code(name)}: {literal(topic_facts(summary, name))}" for name in summary.topics)
    frames = "".join(f"\n- {code(name)}: {literal(frame_facts(summary, name))}" for name in summary.frames)
    listed = [f"\n\nTopics:\n{topics}" if topics else "", f"\n\nFrames:\n{frames}" if frames else ""]
    return f"**log** of {summary.end:.2f} s{''.join(listed)}"
