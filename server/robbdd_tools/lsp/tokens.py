"""Encode semantic tokens: standard types, which every theme colours, with concepts of the language as modifiers.

A theme without support for RobBDD colours by type. In any client, other themes can distinguish a story from a template
by the modifier (``class.story``).
"""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary

from lsprotocol import types

from robbdd_tools.base.document import Document
from robbdd_tools.features import semantic_tokens as feature
from robbdd_tools.features.semantic_tokens import Coloured, Token, coloured, semantic_tokens
from robbdd_tools.lsp.convert import Converter, document_of
from robbdd_tools.lsp.server import RobbddServer
from robbdd_tools.names.project import Snapshot
from robbdd_tools.syntax.declaration import SymbolKind

_TYPES = types.SemanticTokenTypes
APPEARANCES: Mapping[str, tuple[str, ...]] = {
    feature.COMMENT: (_TYPES.Comment.value,),
    feature.STRING: (_TYPES.String.value,),
    feature.NUMBER: (_TYPES.Number.value,),
    feature.KEYWORD: (_TYPES.Keyword.value,),
    feature.TIME: (_TYPES.Modifier.value, "time"),
    feature.PREDICATE: (_TYPES.Function.value, "predicate", "defaultLibrary"),
    feature.ACTION: (_TYPES.Method.value, "behaviour", "defaultLibrary"),
    feature.ARGUMENT: (_TYPES.Parameter.value,),
    feature.CODE: (_TYPES.Macro.value,),
    feature.PROPERTY: (_TYPES.Property.value,),
    SymbolKind.NAMESPACE: (_TYPES.Namespace.value,),
    SymbolKind.STORY: (_TYPES.Class.value, "story"),
    SymbolKind.TEMPLATE: (_TYPES.Class.value, "template"),
    SymbolKind.VARIANT: (_TYPES.Interface.value, "variant"),
    SymbolKind.FLUENT: (_TYPES.Property.value, "clause"),
    SymbolKind.BEHAVIOUR: (_TYPES.Method.value, "behaviour"),
    SymbolKind.BEHAVIOUR_TREE: (_TYPES.Struct.value, "behaviour"),
    SymbolKind.TREE_NODE: (_TYPES.Property.value, "behaviour"),
    SymbolKind.EVENT: (_TYPES.Event.value,),
    SymbolKind.TASK: (_TYPES.EnumMember.value, "task"),
    SymbolKind.REQUIREMENT: (_TYPES.EnumMember.value, "requirement"),
    SymbolKind.PREDICATE: (_TYPES.Function.value, "predicate"),
    SymbolKind.PARAMETER: (_TYPES.Parameter.value,),
    SymbolKind.VARIABLE: (_TYPES.Variable.value,),
    SymbolKind.SET_VARIABLE: (_TYPES.Variable.value, "set"),
    SymbolKind.OBJECT: (_TYPES.EnumMember.value, "object"),
    SymbolKind.WORKSPACE: (_TYPES.EnumMember.value, "workspace"),
    SymbolKind.AGENT: (_TYPES.EnumMember.value, "agent"),
    SymbolKind.OBJECT_SET: (_TYPES.Enum.value, "set", "object"),
    SymbolKind.WORKSPACE_SET: (_TYPES.Enum.value, "set", "workspace"),
    SymbolKind.AGENT_SET: (_TYPES.Enum.value, "set", "agent"),
    SymbolKind.CONSTANT_SET: (_TYPES.Enum.value, "set"),
    SymbolKind.COMPOSITION: (_TYPES.Struct.value, "composition"),
    SymbolKind.SCENE: (_TYPES.Struct.value, "scene"),
    SymbolKind.SCENE_INSTANCE: (_TYPES.Struct.value, "scene", "execution"),
    SymbolKind.DISTRIBUTION: (_TYPES.Type.value, "distribution"),
    SymbolKind.TREE_TEMPLATE: (_TYPES.Class.value, "tree"),
    SymbolKind.TREE: (_TYPES.Struct.value, "tree"),
    SymbolKind.TREE_INSTANCE: (_TYPES.Struct.value, "tree"),
    SymbolKind.GRAPH: (_TYPES.Struct.value, "tree"),
    SymbolKind.BODY: (_TYPES.Property.value, "body"),
    SymbolKind.FRAME: (_TYPES.Property.value, "frame"),
    SymbolKind.POSE: (_TYPES.Property.value, "pose"),
    SymbolKind.JOINT: (_TYPES.Property.value, "joint"),
    SymbolKind.MODEL: (_TYPES.Property.value, "model"),
    SymbolKind.SENSOR: (_TYPES.Property.value, "sensor"),
    SymbolKind.IMPLEMENTATION: (_TYPES.Method.value, "execution"),
    SymbolKind.PROVIDER: (_TYPES.Function.value, "observation"),
    SymbolKind.OBSERVATION: (_TYPES.Property.value, "observation"),
    SymbolKind.POLICY: (_TYPES.Function.value, "policy"),
    SymbolKind.ROBOT_LOG: (_TYPES.Property.value, "observation"),
    SymbolKind.EXECUTION: (_TYPES.Class.value, "execution"),
}
"""Concept → its token type, then its modifiers."""

_DECLARATION = types.SemanticTokenModifiers.Declaration.value
LEGEND = types.SemanticTokensLegend(
    token_types=list(dict.fromkeys(look[0] for look in APPEARANCES.values())),
    token_modifiers=list(dict.fromkeys([_DECLARATION, *(word for look in APPEARANCES.values() for word in look[1:])])),
)
_TYPE_NUMBERS = {name: number for number, name in enumerate(LEGEND.token_types)}
_MODIFIER_BITS = {name: 1 << number for number, name in enumerate(LEGEND.token_modifiers)}
_NUMBERS = {
    concept: (_TYPE_NUMBERS[look[0]], sum(_MODIFIER_BITS[word] for word in look[1:]))
    for concept, look in APPEARANCES.items()
}


@dataclass
class SentTokens:
    """The tokens that the client has of each document. They are stored so that only changes must be sent.

    They are arrays of C integers, because the tokens of a long file are joined and compared after each keystroke.
    """

    _count: int = 0
    _sent: dict[str, tuple[str, bytes]] = field(default_factory=dict[str, tuple[str, bytes]])

    def whole(self, uri: str, data: array[int]) -> types.SemanticTokens:
        """Return all tokens of a document with a new result identifier."""
        return types.SemanticTokens(data=data.tolist(), result_id=self._replace(uri, data))

    def difference(self, uri: str, previous: str, data: array[int]) -> types.SemanticTokens | types.SemanticTokensDelta:
        """Return the changes since an earlier result. If that result is no longer known, return all tokens."""
        known, before = self._sent.get(uri, ("", b""))
        if known != previous:
            return self.whole(uri, data)
        result = self._replace(uri, data)
        now, size = data.tobytes(), data.itemsize
        start = _common(before, now) // size
        end = min(_common(before, now, from_end=True) // size, min(len(before), len(now)) // size - start)
        deleted, inserted = len(before) // size - start - end, data[start : len(data) - end].tolist()
        edits = [types.SemanticTokensEdit(start=start, delete_count=deleted, data=inserted)]
        return types.SemanticTokensDelta(edits=edits if deleted or inserted else [], result_id=result)

    def _replace(self, uri: str, data: array[int]) -> str:
        self._count += 1
        self._sent[uri] = (str(self._count), data.tobytes())
        return str(self._count)

    def forget(self, uri: str) -> None:
        """Drop the tokens of a closed document."""
        self._sent.pop(uri, None)


def encoded(convert: Converter, document: Document, tokens: Sequence[Token]) -> list[int]:
    """Return tokens in the form of the protocol: five numbers each, with places relative to the previous token."""
    data: list[int] = []
    line, column = 0, 0
    for token in tokens:
        start = convert.position(document, token.span.start)
        length = convert.units(document.text[token.span.start : token.span.end])
        kind, modifiers = _NUMBERS[token.concept]
        if token.is_declaration:
            modifiers |= _MODIFIER_BITS[_DECLARATION]
        column = start.character - (column if start.line == line else 0)
        data += (start.line - line, column, length, kind, modifiers)
        line, column = start.line, start.character
    return data


@dataclass(frozen=True, slots=True)
class _Encoded:
    """The encoding of a piece of a document: the numbers of its tokens without the place of the first one.

    The places of the first and the last token have lines counted from the piece's first line. A token on that line has
    a column counted from the start of the piece.
    """

    convert: Converter
    first: tuple[int, int]
    last: tuple[int, int]
    data: array[int]


class Encoder:
    """Encodes whole documents. The encodings of unchanged pieces are cached."""

    def __init__(self) -> None:
        self._kept: WeakKeyDictionary[Coloured, _Encoded] = WeakKeyDictionary()

    def whole(self, convert: Converter, document: Document, pieces: Sequence[tuple[int, Coloured]]) -> array[int]:
        """Return the encoded tokens of a document, which are given as pieces with their offsets."""
        data = array("I")
        starts, line, column = document.line_starts, 0, 0
        for offset, piece in pieces:
            if not piece.tokens:
                continue
            above = document.line_at(offset)
            begin = convert.units(document.text[starts[above] : offset]) if starts[above] < offset else 0
            known = self._kept.get(piece)
            if known is None or known.convert is not convert:
                known = self._kept[piece] = _encoded_piece(convert, document, (offset, piece), (above, begin))
            down, right = known.first
            right += 0 if down else begin
            down += above
            data.append(down - line)
            data.append(right - (column if down == line else 0))
            data.extend(known.data)
            line, column = known.last
            column += 0 if line else begin
            line += above
        return data


def _encoded_piece(
    convert: Converter, document: Document, piece: tuple[int, Coloured], start: tuple[int, int]
) -> _Encoded:
    offset, coloured_text = piece
    tokens = [Token(one.span.shifted(offset), one.concept, one.is_declaration) for one in coloured_text.tokens]

    def place(token: Token) -> tuple[int, int]:
        position = convert.position(document, token.span.start)
        line = position.line - start[0]
        return line, position.character - (0 if line else start[1])

    data = array("I", encoded(convert, document, tokens)[2:])
    return _Encoded(convert, place(tokens[0]), place(tokens[-1]), data)


def register_tokens(server: RobbddServer) -> None:
    """Add the methods to a server."""
    sent = SentTokens()
    server.when_closed.append(sent.forget)

    encoder = Encoder()

    async def data_of(ls: RobbddServer, uri: str) -> array[int]:
        def find(snapshot: Snapshot) -> array[int]:
            return encoder.whole(ls.convert, document_of(snapshot, uri), coloured(snapshot, uri))

        return await ls.analyse(find)

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    async def whole(ls: RobbddServer, params: types.SemanticTokensParams) -> types.SemanticTokens:
        uri = params.text_document.uri
        return sent.whole(uri, await data_of(ls, uri))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL_DELTA, LEGEND)
    async def difference(
        ls: RobbddServer, params: types.SemanticTokensDeltaParams
    ) -> types.SemanticTokens | types.SemanticTokensDelta:
        uri = params.text_document.uri
        return sent.difference(uri, params.previous_result_id, await data_of(ls, uri))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, LEGEND)
    async def part(ls: RobbddServer, params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
        def find(snapshot: Snapshot) -> list[int]:
            document = document_of(snapshot, params.text_document.uri)
            within = ls.convert.span(document, params.range)
            return encoded(ls.convert, document, semantic_tokens(snapshot, document.uri, within))

        return types.SemanticTokens(data=await ls.analyse(find))


def _common(one: bytes, other: bytes, *, from_end: bool = False) -> int:
    """Return the length of the common beginning, or the common end, of two results. It is found by bisection."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if from_end:
            is_same = one[len(one) - middle : len(one) - low] == other[len(other) - middle : len(other) - low]
        else:
            is_same = one[low:middle] == other[low:middle]
        low, high = (middle, high) if is_same else (low, middle - 1)
    return low
