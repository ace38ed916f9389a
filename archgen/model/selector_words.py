"""The parser of the selector language: `2+driving.safety_supervisor tag:safety -sensing.*`.

    selector = word {blank word}
    word     = ["-"] term
    term     = [N]"+"atom | atom"+"[N] | [N]"+"atom"+"[N] | atom | atom".."atom
    atom     = path | key":"value

`model.selector_evaluation` says what the words mean.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Literal

from archgen.frozen import dataclass
from archgen.suggest import closest

KEYS = (
    "tag",
    "owner",
    "status",
    "type",
    "medium",
    "role",
    "host",
    "package",
    "requirement",
    "behaviour",
    "finding",
    "node",
)
ALL = -1
"""Any number of steps."""
# Blanks separate words except within quotes. A quote that is not closed runs to the end, and is reported.
_WORD = re.compile(r'(?:[^\s"]|"[^"]*"?)+')
_STEPS_BEFORE = re.compile(r"([0-9]*)\+")
_STEPS_AFTER = re.compile(r"\+([0-9]*)")
# A plain value ends before `..`, the mark of a range; single dots belong to it.
_ATOM = re.compile(
    r'(?:(?P<key>[^\s:+.",]+):)?(?:"(?P<quoted>[^"]*)"|(?P<plain>(?:(?!\.\.)[^\s+":,])+))',
)
_DIGITS = 6


@dataclass(frozen=True, slots=True)
class Problem:
    """A mistake in a selector, from `start` to `end` (in characters from 0, `end` exclusive)."""

    message: str
    start: int
    end: int
    severity: Literal["error", "warning"] = "error"
    help: str | None = None


@dataclass(frozen=True, slots=True)
class Atom:
    """A path (then `key` is None), or a key with its value."""

    key: str | None
    value: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Word:
    """One word. `steps_before` and `steps_after` may be `ALL_STEPS`, or 0 for none; `range_end` is the y of `x..y`."""

    atom: Atom
    negative: bool = False
    before: int = 0
    after: int = 0
    to: Atom | None = None


@dataclass(frozen=True, slots=True)
class Selector:
    """A parsed selector: its valid words, and the problems of the others."""

    words: tuple[Word, ...]
    problems: tuple[Problem, ...] = ()


def parse(text: str) -> Selector:
    """Parse a selector. Words with mistakes are left out and reported as problems."""
    words: list[Word] = []
    problems: list[Problem] = []
    for match in _WORD.finditer(text):
        read = _word(text, match.start(), match.end())
        if isinstance(read, Problem):
            problems.append(read)
            continue
        unknown = tuple(_unknown_keys(read))
        problems += unknown
        words += () if unknown else (read,)
    if not words and not problems:
        problems.append(Problem("the selector is empty", 0, len(text), help=_FORMS))
    return Selector(tuple(words), tuple(problems))


def _word(text: str, start: int, end: int) -> Word | Problem:
    """Parse the word between two positions of a text."""
    reserved = _reserved(text, start, end)
    if reserved:
        return reserved
    negative = text[start] == "-"
    here = start + negative
    before = _STEPS_BEFORE.match(text, here, end)
    here = before.end() if before else here
    atom = _atom(text, here, end)
    if isinstance(atom, Problem):
        return atom
    here = atom.end
    to: Atom | None = None
    after = _STEPS_AFTER.match(text, here, end)
    if after:
        here = after.end()
    # `1+x..y` is not in the grammar: steps and ranges exclude each other, and the rest is reported below.
    elif text.startswith("..", here) and not before:
        other = _atom(text, here + 2, end)
        if isinstance(other, Problem):
            return other
        to, here = other, other.end
    if here < end:
        return Problem(f"`{text[here:end]}` is more than a word can hold", here, end, help=_FORMS)
    # Longer numbers are refused: no architecture has that many steps, and int() of very long ones fails.
    counts = [match[1] for match in (before, after) if match and len(match[1]) > _DIGITS]
    if counts:
        return Problem(f"`{counts[0]}` steps are too many", start, end, help="leave the number out to take all of them")
    return Word(atom, negative, _steps(before), _steps(after), to)


_FORMS = "a word is `x`, `+x`, `x+`, `2+x+1` or `x..y`, where x is a path or `key:value`"


def _reserved(text: str, start: int, end: int) -> Problem | None:
    """Return a problem for a comma outside quotes or a quote that is not closed, else None."""
    quoted = False
    for position in range(start, end):
        if text[position] == '"':
            quoted = not quoted
        elif text[position] == "," and not quoted:
            return Problem("`,` is reserved; words are separated by blanks", position, position + 1)
    if quoted:
        return Problem("the quote is not closed", start, end, help='write `type:"Point cloud"`')
    return None


def _atom(text: str, start: int, end: int) -> Atom | Problem:
    """Parse a path, or a key with its value, at a position; it need not reach up to `end`."""
    match = _ATOM.match(text, start, end)
    if match is None:
        found = text[start:end]
        message = f"a path or `key:value` is expected, not `{found}`" if found else "a path or `key:value` is missing"
        return Problem(message, start if found else max(start - 1, 0), end, help=_FORMS)
    if text.startswith(":", match.end()) and match.end() < end:
        return Problem(f"`{match[0]}:` needs a value", start, end, help='write `tag:safety` or `type:"Point cloud"`')
    value = match["quoted"] if match["quoted"] is not None else match["plain"]
    return Atom(match["key"], value, match.start(), match.end())


def _steps(match: re.Match[str] | None) -> int:
    if match is None:
        return 0
    return int(match[1]) if match[1] else ALL


def _unknown_keys(word: Word) -> Iterator[Problem]:
    for atom in (word.atom, word.to):
        if atom and atom.key is not None and atom.key not in KEYS:
            guess = closest(atom.key, KEYS)
            help_line = f"did you mean `{guess}:`?" if guess else f"keys are {', '.join(KEYS)}"
            yield Problem(f"no key `{atom.key}`", atom.start, atom.start + len(atom.key), help=help_line)
