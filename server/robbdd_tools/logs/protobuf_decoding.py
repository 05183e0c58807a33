"""Decode Protobuf messages by the definitions in an MCAP file. No other module uses protobuf."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robbdd_tools.logs.log_contents import UnreadableLog

if TYPE_CHECKING:
    from google.protobuf.descriptor_pb2 import FileDescriptorProto
    from google.protobuf.descriptor_pool import DescriptorPool
    from google.protobuf.message import Message

DEEPEST = 4
"""Messages that are not set have their defaults up to this depth."""
NO_PROTOBUF = "reading Protobuf messages needs the extra 'logs': pip install 'robbdd-tools[logs]'"


def protobuf_decoder(name: str, definitions: bytes) -> Callable[[bytes], dict[str, Any]]:
    """Return the function that decodes messages of a type to plain data; a field that is not set has its default.

    ``definitions`` are a ``FileDescriptorSet``. Raises ``UnreadableLog`` without protobuf, and its errors for damaged
    definitions.
    """
    try:
        from google.protobuf.descriptor_pb2 import FileDescriptorSet
        from google.protobuf.descriptor_pool import DescriptorPool
        from google.protobuf.message_factory import GetMessageClass
    except ImportError:
        raise UnreadableLog(NO_PROTOBUF) from None
    pool = DescriptorPool()
    files = {one.name: one for one in FileDescriptorSet.FromString(definitions).file}
    for file in list(files):
        _add(pool, file, files)
    kind = GetMessageClass(pool.FindMessageTypeByName(name))
    return lambda data: _plain(kind.FromString(data))


def _add(pool: DescriptorPool, name: str, files: dict[str, FileDescriptorProto]) -> None:
    """Add a file after those that it imports: writers need not order them."""
    file = files.pop(name, None)
    if file is not None:
        for imported in file.dependency:
            _add(pool, imported, files)
        pool.Add(file)


def _plain(message: Message, depth: int = 0) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for field in message.DESCRIPTOR.fields:
        value: Any = getattr(message, field.name)
        if field.message_type is None:
            found[field.name] = list(value) if field.is_repeated else value
        elif field.message_type.GetOptions().map_entry:
            found[field.name] = dict(value)
        else:
            found[field.name] = [_plain(one) for one in value] if field.is_repeated else {}
            # A type may contain itself, so defaults of defaults end somewhere.
            if not field.is_repeated and (message.HasField(field.name) or depth < DEEPEST):
                found[field.name] = _plain(value, depth + 1)
    return found
