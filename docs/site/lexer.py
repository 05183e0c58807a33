"""Colours of RobBDD text and of graphs on the site. The keywords are those of the grammars."""

from collections.abc import Sequence
from typing import ClassVar

from pygments.lexer import RegexLexer, inherit, words
from pygments.lexers.rdf import TurtleLexer  # pyright: ignore[reportMissingTypeStubs] -- its stubs lack this file
from pygments.token import Comment, Keyword, Name, Number, Punctuation, String, Text

from robbdd_tools.features.semantic_tokens import words_of_grammar
from robbdd_tools.syntax.parse import LANGUAGES

KEYWORDS = sorted({word for language in LANGUAGES for word in words_of_grammar(language)}, key=len, reverse=True)


class RobbddLexer(RegexLexer):
    """Words, names, texts, numbers and comments of all file kinds."""

    name = "RobBDD"
    aliases: ClassVar[Sequence[str]] = ["robbdd"]
    tokens: ClassVar[dict[str, list[tuple[object, object]]]] = {
        "root": [
            (r"//[^\n]*", Comment.Single),
            (r"\"[^\"\n]*\"|'[^'\n]*'", String),
            (r"<[\w.\-]+>", Name.Variable),
            (words(KEYWORDS, prefix=r"(?<![\w-])", suffix=r"(?![\w-])"), Keyword),
            (r"-?\d[\d.]*", Number),
            (r"[\w.\-]+", Name),
            (r"[^\w\s]", Punctuation),
            (r"\s+", Text),
        ]
    }


class GraphLexer(TurtleLexer):
    """Turtle with numbers such as ``2e-01``, which the lexer of Pygments does not know."""

    tokens: ClassVar[dict[str, list[object]]] = {"root": [(r"[+-]?\d+(?:\.\d+)?[eE][+-]?\d+", Number.Float), inherit]}
