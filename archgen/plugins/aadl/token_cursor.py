"""Go through the tokens of an AADL text: expect, look ahead, tell errors, and find where to go on behind one.

The tokens of an AADL text, one after the other, and where they stand.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import NamedTuple, NoReturn, TypeVar

from archgen.plugin import dataclass
from archgen.plugin.generating import AADL_KEYWORDS
from archgen.plugin.importing import Span

# An annex is one token: its text is of another language, and ends where its first `**}` stands.
_TOKEN = re.compile(
    r"""
      (?P<blank>\s+|--[^\n]*)
    | (?P<annex>\{\*\*.*?\*\*\})
    | (?P<open>\{\*\*)
    | (?P<number>[0-9](?:_?[0-9])*\#[0-9A-Fa-f](?:_?[0-9A-Fa-f])*\#(?:[eE]\+?[0-9]+)?
        |[0-9](?:_?[0-9])*(?:\.[0-9](?:_?[0-9])*)?(?:[eE][+-]?[0-9]+)?)
    | (?P<name>[^\W\d]\w*)
    | (?P<text>"(?:[^"\\]++|""|\\.)*+")
    | (?P<sign>\+=>|=>|<->|->|-\[|\]->|::|\.\.|\*\*|[-+*;:,.(){}\[\]^@<>/])
    | (?P<stray>"(?:[^"\\]++|""|\\.)*+|.)  # a text without an end is one, too: else each quote in it is tried up to the end
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
    tokens_left = max_tokens
    for match in _TOKEN.finditer(text):
        kind = OPEN_ANNEX if match.lastgroup == "open" else match.lastgroup or ""
        if kind == "blank":
            continue
        tokens_left -= 1
        if tokens_left < 0:
            raise TooManyTokensError(match.start())
        token_text = match.group()
        yield Token(kind, token_text, match.start(), token_text.lower() if kind == "name" else token_text)
        if kind == OPEN_ANNEX:
            break
    while True:
        yield Token(END, "", len(text), "")


def unquote_text(token: Token) -> str:
    """Return what a token of kind text says, without its quotes."""
    return token.text[1:-1].replace('""', '"').replace('\\"', '"')


Entry = TypeVar("Entry")
MAX_DEPTH = 60
"""How deep values, bindings and types may stand in one another."""
_MAX_SHOWN = 40
SECTION_WORDS = frozenset(
    [
        "features", "subcomponents", "connections", "calls", "flows", "modes", "properties", "prototypes", "annex",
        "end", "private", "public"
    ]
)  # fmt: skip
RESERVED_WORDS = AADL_KEYWORDS - {"client", "none", "server"}
"""Words that name nothing. `internal`, `none` and such are told by their place alone: models use them as names."""


@dataclass(frozen=True, slots=True)
class SyntaxFault:
    """What is wrong with the text at a place, and how to mend it."""

    message: str
    span: Span
    help_line: str = ""


class AadlSyntaxError(Exception):
    """The parser met what it did not expect; whoever knows where to go on catches it."""

    def __init__(self, message: str, token: Token, help_line: str = "") -> None:
        super().__init__(message)
        self.message, self.token, self.help_line = message, token, help_line


class TokenCursor:
    """A place among the tokens of a text; `faults` are all errors that were met."""

    def __init__(self, source: AadlText, max_tokens: int = MAX_TOKENS) -> None:
        """Stand before the first token; behind `max_tokens` going on raises TooManyTokensError."""
        self.source = source
        self.faults: list[SyntaxFault] = []
        self._tokens = scan_tokens(source.text, max_tokens)
        self._ahead: deque[Token] = deque()
        self._depth = 0
        self.last_end = 0
        self.token_count = 0
        """How many tokens were left behind."""
        self.token = next(self._tokens)

    def peek(self, distance: int = 1) -> Token:
        """Return the token that stands so far behind the present one."""
        missing = distance - len(self._ahead)
        if missing > 0:
            self._ahead += islice(self._tokens, missing)
        return self._ahead[distance - 1]

    def advance(self) -> Token:
        """Go on by a token, and return the one that was left."""
        token = self.token
        self.token_count += 1
        self.last_end = token.offset + len(token.text)
        self.token = self._ahead.popleft() if self._ahead else next(self._tokens)
        return token

    def at(self, *words: str) -> bool:
        """Whether these words or signs come next, in this order."""
        if self.token.word != words[0] or self.token.kind == "text":
            return False
        return all(self.peek(index).word == word for index, word in enumerate(words[1:], 1))

    def accept(self, *words: str) -> bool:
        """Go behind these words or signs if they come next."""
        if not self.at(*words):
            return False
        for _ in words:
            self.advance()
        return True

    def expect(self, *words: str) -> Token:
        """Go behind these words or signs. Raise AadlSyntaxError where something else comes."""
        for word in words:
            if not self.at(word):
                self.fail(f"`{word}` is missing here, before {describe_token(self.token)}")
            last = self.advance()
        return last

    def expect_name(self, what: str) -> str:
        """Return the name that comes next. Raise AadlSyntaxError where none does."""
        if self.token.kind != "name" or self.token.word in RESERVED_WORDS:
            found = describe_token(self.token)
            reserved = self.token.kind == "name"
            words = f"{found} is a word of AADL, and no name of {what}" if reserved else f"{found} is no name of {what}"
            self.fail(words)
        return self.advance().text

    def expect_path(self, what: str) -> str:
        """Return a name with `::` and `.` in it, as `talking::talker.impl`."""
        parts = [self.expect_name(what)]
        while self.at("::") or self.at("."):
            parts += [self.advance().text, self.expect_name(what)]
        return "".join(parts)

    def expect_declared(self, what: str) -> str:
        """Return the name that comes next, and go behind the `:` that follows it."""
        name = self.expect_name(what)
        self.expect(":")
        return name

    def expect_end(self, opened: str, name: str, closing: Callable[[], str]) -> None:
        """Go behind `end name;`; another name than that of what is open is told."""
        end = self.expect("end")
        found = closing()
        if found.lower() != name.lower():
            words = f"this ends `{found}`, but what is open is {opened}`{name}`"
            self.tell(AadlSyntaxError(words, end, f"write `end {name};`"))
        self.expect(";")

    def parse_separated(self, parse_entry: Callable[[], Entry], separator: str) -> list[Entry]:
        """Return entries with a sign between them, one or more."""
        entries = [parse_entry()]
        while self.accept(separator):
            entries.append(parse_entry())
        return entries

    def walk_entries(self, end: str, separator: str) -> Iterator[None]:
        """Yield before each entry up to the sign behind them; between them stands another one."""
        while not self.accept(end):
            yield
            if not self.at(end):
                self.expect(separator)

    @contextmanager
    def deeper(self) -> Iterator[None]:
        """Go down by one level. Raise AadlSyntaxError where that is too deep."""
        self._depth += 1
        try:
            if self._depth > MAX_DEPTH:
                self.fail(f"this stands more than {MAX_DEPTH} levels deep")
            yield
        finally:
            self._depth -= 1

    def make_error(self, message: str, help_line: str = "") -> AadlSyntaxError:
        """Return an error at the present token, for the caller to tell."""
        return AadlSyntaxError(message, self.token, help_line)

    def fail(self, message: str, help_line: str = "") -> NoReturn:
        """Raise an error at the present token."""
        raise self.make_error(message, help_line)

    def tell(self, error: AadlSyntaxError) -> None:
        """Remember an error."""
        span = self.source.span(error.token.offset, error.token.end)
        if not self.faults or self.faults[-1].span != span:
            self.faults.append(SyntaxFault(error.message, span, error.help_line))

    def span_from(self, start: int) -> Span:
        """Return the span from an offset to the last token that was left."""
        return self.source.span(start, self.last_end)

    def skip_statement(self) -> None:
        """Go behind the next `;` that stands in no brackets, or up to the next section or the end."""
        depth = 0
        while self.token.kind != END:
            word = self.token.word
            if word in {"(", "{", "[", "-["}:
                depth += 1
            elif word in {")", "}", "]", "]->"}:
                depth = max(0, depth - 1)
            elif word == ";" and not depth:
                self.advance()
                return
            if self._begins_section(word):
                return
            self.advance()

    def _begins_section(self, word: str) -> bool:
        if self.token.kind != "name" or word not in SECTION_WORDS:
            return False
        if word == "end":
            # `end to end flow` begins an entry.
            return not self.at("end", "to") and self.peek().kind == "name"
        # Words of sections stand within entries, too: `requires modes`, `in modes`, `{properties}`.
        return self.peek().kind in {"name", END} and not (word == "flows" and self.peek().word == "=>")

    def parse_entries(self, parse_entry: Callable[[], None], is_end: Callable[[], bool]) -> None:
        """Parse entries up to where the section ends; an error in one is told, and the next goes on behind it."""
        while self.token.kind != END and not is_end():
            before = self.token
            try:
                parse_entry()
            except AadlSyntaxError as error:
                self.tell(error)
                self.skip_statement()
                if self.token is before:
                    self.advance()


def describe_token(token: Token) -> str:
    """Return a token as messages name it, cut if it is long."""
    if token.kind == END:
        return "the end of the file"
    if token.kind == OPEN_ANNEX:
        return "an annex without its end `**}`"
    if token.kind == "annex":
        return "an annex"
    if token.kind == "stray" and token.text == '"':
        return "a text without an end"
    text = token.text if len(token.text) <= _MAX_SHOWN else f"{token.text[: _MAX_SHOWN - 3]}..."
    return f"`{text}`" if text.isprintable() else repr(text)
