"""What users do to a text: replace, delete and duplicate words, cut a line, undo."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import islice

WORDS = re.compile(r"[\w\-]+|[^\w\s]")
PIECES = (
    "",
    " ",
    "\n",
    "}",
    "{",
    "(",
    ")",
    '"',
    "// ",
    "<",
    "Event (ns=t) e\n",
    "Task (ns=t) start\n",
    "\nScenario Template ",
    'import "lab.scene"\n',
    'import "main.bdd"\n',
    "ns t = 'urn:x:'\n",
    "obj set (ns=env) parts { object bolt }\n",
    "before <pick-start>",
    "\n        Scenario again {",
    "Scenario ",
    "}\n}\n",
    "<part>",
    "é🤖",
    "\r\n",
)


@dataclass(frozen=True)
class Edit:
    """Something that a user does in one of the files, at a place given as a fraction of its length.

    ``replace`` writes a text over some letters; ``delete`` and ``duplicate`` take the next words, as many as
    ``length``; ``half`` leaves only the first ``length`` letters of the line; ``undo`` takes back the file's last edit.
    """

    file: int
    kind: str
    place: float
    length: int
    text: str

    def apply(self, history: list[str]) -> str:
        """Return the new text, which joins the history of the file's texts; undoing shortens it."""
        if self.kind == "undo" and len(history) > 1:
            history.pop()
            return history[-1]
        text = history[-1]
        start = int(self.place * len(text))
        match self.kind:
            case "delete" | "duplicate":
                words = WORDS.finditer(text, start)
                spans = [found.span() for found in islice(words, min(self.length, 5))] or [(start, start)]
                begin, end = spans[0][0], spans[-1][1]
                piece = "" if self.kind == "delete" else f"{text[begin:end]} {text[begin:end]}"
            case "half":
                line = text.rfind("\n", 0, start) + 1
                end = text.find("\n", start) if "\n" in text[start:] else len(text)
                begin, piece = min(line + self.length, end), ""
            case _:
                begin, end, piece = start, start + self.length, self.text
        history.append(text[:begin] + piece + text[end:])
        return history[-1]
