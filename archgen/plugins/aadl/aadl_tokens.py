"""The tokens of an AADL text, one after the other, and where they stand."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import NamedTuple

from archgen.plugin.importing import Span

# An annex is one token: its text is of another language, and ends where its first `**}` stands.
_TOKEN = re.compile(
    r"""
      (?P<blank>\s+|--[^\n]*)
    | (?P<annex>\{\*\*)
    | (?P<number>[0-9](?:_?[0-9])*\#[0-9A-Fa-f](?:_?[0-9A-Fa-f])*\#(?:[eE]\+?[0-9]+)?
        |[0-9](?:_?[0-9])*(?:\.[0-9](?:_?[0-9])*)?(?:[eE][+-]?[0-9]+)?)
    | (?P<name>[^\W\d]\w*)
    | (?P<text>"(?:[^"\\]++|""|\\.)*+")
    | (?P<sign>\+=>|=>|<->|->|-\[|\]->|::|\.\.|\*\*|[-+*;:,.(){}\[\]^@<>/])
    """,
    re.VERBOSE | re.DOTALL,
)
END, OPEN_ANNEX = "end of the file", "annex without an end"
MAX_TOKENS = 4_000_000
"""So many are a model of 500,000 elements, which take about 1 GB of memory."""


class TooManyTokensError(Exception):
    """A model has more tokens than anybody writes; `offset` is where the first one too many stands."""

    def __init__(self, offset: int) -> None:
        super().__init__(offset)
        self.offset = offset


class Token(NamedTuple):
    """A token: `kind` is name, number, text, sign, annex, stray (what begins no token), OPEN_ANNEX or END."""

    kind: str
    text: str
    offset: int
    word: str
    """The text by which it is compared: words of AADL count in any case."""

    @property
    def end(self) -> int:
        """Return the offset behind its last character."""
        return self.offset + len(self.text)


class AadlText:
    """The text of a file, which tells lines and columns of offsets."""

    def __init__(self, file: str, text: str) -> None:
        """Take the text of `file`, by the name under which messages tell of it."""
        self.file, self.text = file, text
        self._line_starts = [0, *(match.end() for match in re.finditer(r"\n", text))]

    def span(self, start: int, end: int) -> Span:
        """Return the span between two offsets."""
        return Span(self.file, *self._place(start), *self._place(max(start, end)))

    def _place(self, offset: int) -> tuple[int, int]:
        line = bisect_right(self._line_starts, offset)
        return line, offset - self._line_starts[line - 1] + 1


def scan_tokens(text: str, max_tokens: int = MAX_TOKENS) -> Iterator[Token]:
    """Yield the tokens of a text without blanks and comments; END is the last, again and again.

    Raise TooManyTokensError.
    """
    offset, size, match_token, tokens_left = 0, len(text), _TOKEN.match, max_tokens
    while offset < size:
        match = match_token(text, offset)
        kind = match.lastgroup or "" if match else "stray"
        if match and kind == "blank":
            offset = match.end()
            continue
        tokens_left -= 1
        if tokens_left < 0:
            raise TooManyTokensError(offset)
        if match is None:
            yield Token(kind, text[offset], offset, text[offset])
            offset += 1
            continue
        if kind == "annex":
            end = text.find("**}", offset + 3)
            if end < 0:
                yield Token(OPEN_ANNEX, "{**", offset, "{**")
                break
            yield Token(kind, text[offset : end + 3], offset, "")
            offset = end + 3
            continue
        token_text = match.group()
        yield Token(kind, token_text, offset, token_text.lower() if kind == "name" else token_text)
        offset = match.end()
    while True:
        yield Token(END, "", size, "")


def unquote_text(token: Token) -> str:
    """Return what a token of kind text says, without its quotes."""
    return token.text[1:-1].replace('""', '"').replace('\\"', '"')
