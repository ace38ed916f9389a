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

from archgen.diagnostics import Span, find_closest
from archgen.frozen import dataclass

SELECTOR_KEYS = (
    *("tag", "owner", "status", "type", "medium", "role", "host", "package", "requirement", "behaviour", "finding"),
    *("node", "is", "library", "parameter", "property", "variant", "deprecated", "use_case"),
)
ALL_STEPS = -1
"""Any number of steps."""
# Blanks separate words except within quotes. A quote that is not closed runs to the end, and is reported.
_WORD_PATTERN = re.compile(r'(?:[^\s"]|"[^"]*"?)+')
_STEPS_BEFORE = re.compile(r"([0-9]*)\+")
_STEPS_AFTER = re.compile(r"\+([0-9]*)")
# A plain value ends before `..`, the mark of a range; single dots belong to it.
_ATOM_PATTERN = re.compile(
    r'(?:(?P<key>[^\s:+.",]+):)?(?:"(?P<quoted>[^"]*)"|(?P<plain>(?:(?!\.\.)[^\s+":,])+))',
)
_MAX_STEP_DIGITS = 6


@dataclass(frozen=True, slots=True)
class SelectorProblem:
    """A mistake in a selector, from `start` to `end` (in characters from 0, `end` exclusive)."""

    message: str
    start: int
    end: int
    severity: Literal["error", "warning"] = "error"
    help: str | None = None

    def locate(self, text: str, span: Span) -> Span:
        """Return the place of what it is about in a selector that stands at a place, quoted or not; else that of all."""
        # The span includes quotes if there are any: it is longer than the text by 0 or 2 columns. Anything else (escapes,
        # several lines) does not map to columns of the text.
        quote_width = span.end_column - span.column - len(text)
        if span.line != span.end_line or quote_width not in {0, 2}:
            return span
        start = span.column + quote_width // 2
        return span._replace(column=start + self.start, end_column=start + max(self.end, self.start + 1))


@dataclass(frozen=True, slots=True)
class SelectorAtom:
    """A path (then `key` is None), or a key with its value."""

    key: str | None
    value: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class SelectorWord:
    """One word. `steps_before` and `steps_after` may be `ALL_STEPS`, or 0 for none; `range_end` is the y of `x..y`."""

    atom: SelectorAtom
    is_negative: bool = False
    steps_before: int = 0
    steps_after: int = 0
    range_end: SelectorAtom | None = None


@dataclass(frozen=True, slots=True)
class ParsedSelector:
    """A parsed selector: its valid words, and the problems of the others."""

    words: tuple[SelectorWord, ...]
    problems: tuple[SelectorProblem, ...] = ()


def parse_selector(text: str) -> ParsedSelector:
    """Parse a selector. Words with mistakes are left out and reported as problems."""
    words: list[SelectorWord] = []
    problems: list[SelectorProblem] = []
    for match in _WORD_PATTERN.finditer(text):
        parsed_word = _parse_word(text, match.start(), match.end())
        if isinstance(parsed_word, SelectorProblem):
            problems.append(parsed_word)
            continue
        unknown_keys = tuple(_find_unknown_keys(parsed_word))
        problems += unknown_keys
        words += () if unknown_keys else (parsed_word,)
    if not words and not problems:
        problems.append(SelectorProblem("the selector is empty", 0, len(text), help=_FORMS_HELP))
    return ParsedSelector(tuple(words), tuple(problems))


def split_selector(text: str) -> Iterator[str]:
    """Yield the words of a selector as they are written, with their `-`."""
    return (match[0] for match in _WORD_PATTERN.finditer(text))


def _parse_word(text: str, start: int, end: int) -> SelectorWord | SelectorProblem:
    """Parse the word between two positions of a text."""
    reserved = _find_reserved(text, start, end)
    if reserved:
        return reserved
    is_negative = text[start] == "-"
    position = start + is_negative
    before = _STEPS_BEFORE.match(text, position, end)
    position = before.end() if before else position
    atom = _parse_atom(text, position, end)
    if isinstance(atom, SelectorProblem):
        return atom
    position = atom.end
    range_end: SelectorAtom | None = None
    after = _STEPS_AFTER.match(text, position, end)
    if after:
        position = after.end()
    # `1+x..y` is not in the grammar: steps and ranges exclude each other, and the rest is reported below.
    elif text.startswith("..", position) and not before:
        second_atom = _parse_atom(text, position + 2, end)
        if isinstance(second_atom, SelectorProblem):
            return second_atom
        range_end, position = second_atom, second_atom.end
    if position < end:
        return SelectorProblem(f"`{text[position:end]}` is more than a word can hold", position, end, help=_FORMS_HELP)
    # Longer numbers are refused: no architecture has that many steps, and int() of very long ones fails.
    long_counts = [match[1] for match in (before, after) if match and len(match[1]) > _MAX_STEP_DIGITS]
    if long_counts:
        return SelectorProblem(
            f"`{long_counts[0]}` steps are too many", start, end, help="leave the number out to take all of them"
        )
    return SelectorWord(atom, is_negative, _parse_steps(before), _parse_steps(after), range_end)


_FORMS_HELP = "a word is `x`, `+x`, `x+`, `2+x+1` or `x..y`, where x is a path or `key:value`"


def _find_reserved(text: str, start: int, end: int) -> SelectorProblem | None:
    """Return a problem for a comma outside quotes or a quote that is not closed, else None."""
    is_quoted = False
    for position in range(start, end):
        if text[position] == '"':
            is_quoted = not is_quoted
        elif text[position] == "," and not is_quoted:
            return SelectorProblem("`,` is reserved; words are separated by blanks", position, position + 1)
    if is_quoted:
        return SelectorProblem("the quote is not closed", start, end, help='write `type:"Point cloud"`')
    return None


def _parse_atom(text: str, start: int, end: int) -> SelectorAtom | SelectorProblem:
    """Parse a path, or a key with its value, at a position; it need not reach up to `end`."""
    match = _ATOM_PATTERN.match(text, start, end)
    if match is None:
        wrong_text = text[start:end]
        message = (
            f"a path or `key:value` is expected, not `{wrong_text}`"
            if wrong_text
            else "a path or `key:value` is missing"
        )
        return SelectorProblem(message, start if wrong_text else max(start - 1, 0), end, help=_FORMS_HELP)
    if text.startswith(":", match.end()) and match.end() < end:
        return SelectorProblem(
            f"`{match[0]}:` needs a value", start, end, help='write `tag:safety` or `type:"Point cloud"`'
        )
    value = match["quoted"] if match["quoted"] is not None else match["plain"]
    return SelectorAtom(match["key"], value, match.start(), match.end())


def _parse_steps(match: re.Match[str] | None) -> int:
    if match is None:
        return 0
    return int(match[1]) if match[1] else ALL_STEPS


def _find_unknown_keys(word: SelectorWord) -> Iterator[SelectorProblem]:
    for atom in (word.atom, word.range_end):
        if atom and atom.key is not None and atom.key not in SELECTOR_KEYS:
            guess = find_closest(atom.key, SELECTOR_KEYS)
            help_line = f"did you mean `{guess}:`?" if guess else f"keys are {', '.join(SELECTOR_KEYS)}"
            yield SelectorProblem(f"no key `{atom.key}`", atom.start, atom.start + len(atom.key), help=help_line)
