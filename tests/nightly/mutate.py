"""Damages texts and bytes at random, by the given source of randomness only."""

from __future__ import annotations

import re
from collections.abc import Sequence
from random import Random

_WORD = re.compile(r"[\w\-.:]+|\s+|[^\w\s]")
SIGNS = (
    "\x00",
    "\ufeff",
    "\u202e",
    "é",
    "🤖",
    "\ud800",
    "\r",
    "\r\n",
    "\u2028",
    "\t",
    '"',
    "'",
    "<",
    ">",
    "{",
    "}",
    "//",
    "\\",
)
NUMBERS = ("0", "-1", "1e400", "-1e400", "nan", "inf", "9" * 40, "0.1e-400", "1e9", "65536", "-0")
BYTES = (b"\x00", b"\xff", b"\x7f", b"\x80", b"\n", b"{", b'"')


def any_text(random: Random, most: int = 400) -> str:
    """Return a text of random letters, signs of every plane included."""
    letters = (
        chr(random.choice((random.randrange(32, 127), random.randrange(0x250), random.randrange(0x110000))))
        for _ in range(random.randrange(most))
    )
    return "".join(letters)


def damaged_text(random: Random, text: str, others: Sequence[str], times: int = 4) -> str:
    """Return a text with tokens removed, repeated, swapped, or replaced by ones of ``others`` or odd signs."""
    tokens = _WORD.findall(text)
    for _ in range(random.randrange(1, times + 1)):
        if not tokens:
            break
        place, other = random.randrange(len(tokens)), random.randrange(len(tokens))
        length = random.choice((1, 1, 1, 2, 5, 30))
        match random.randrange(8):
            case 0:
                del tokens[place : place + length]
            case 1:
                tokens[place:place] = tokens[other : other + length]
            case 2:
                tokens[place], tokens[other] = tokens[other], tokens[place]
            case 3:
                tokens[place] = random.choice(SIGNS)
            case 4:
                tokens[place] = random.choice(NUMBERS)
            case 5:
                foreign = _WORD.findall(random.choice(others)) or [""]
                start = random.randrange(len(foreign))
                tokens[place:place] = foreign[start : start + length]
            case 6:
                tokens[place] = any_text(random, 12)
            case _:
                del tokens[place:]
    return "".join(tokens)


def damaged_bytes(random: Random, data: bytes, times: int = 6) -> bytes:
    """Return bytes with some of them flipped, removed, repeated or cut off."""
    found = bytearray(data)
    for _ in range(random.randrange(1, times + 1)):
        if not found:
            return bytes(random.randrange(256) for _ in range(random.randrange(64)))
        place = random.randrange(len(found))
        length = random.choice((1, 1, 4, 16, 256))
        match random.randrange(6):
            case 0:
                found[place] ^= 1 << random.randrange(8)
            case 1:
                found[place : place + length] = bytes(random.randrange(256) for _ in range(length))
            case 2:
                del found[place : place + length]
            case 3:
                found[place:place] = found[place : place + length]
            case 4:
                found[place:place] = random.choice(BYTES)
            case _:
                del found[place:]
    return bytes(found)


def encoded(text: str) -> bytes:
    """Return a text as the bytes of a file, even if it is invalid Unicode."""
    return text.encode("utf-8", "surrogatepass")
