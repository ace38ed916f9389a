"""Phrase syntax errors of YAML files: what the parser reports becomes a diagnostic that says what to do.

libyaml and PyYAML's own parser word some problems differently; the texts below match both.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from archgen.diagnostic import Diagnostic, Label
from archgen.source import Span

HALF = re.compile("[\ud800-\udfff]")
"""Half of a character beyond U+FFFF (a surrogate), which no text may hold alone. libyaml refuses it by itself."""
QUOTE = 'put the text in quotes: "..."'
_FORBIDDEN = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ud800-\udfff\ufeff\ufffe\uffff]")


class Problem(NamedTuple):
    """What the parser reports: its message, and where, counted from 0.

    `context_start` is the line and column at which the construct that it was reading begins.
    """

    words: str
    line: int
    column: int
    context: str = ""
    begun: tuple[int, int] | None = None


class _Words(NamedTuple):
    """Our text for a problem. `label` is shown where the construct began; with `at_start` the finding itself is."""

    message: str
    help: str | None = None
    label: str | None = None
    at_start: bool = False


def forbidden_character(file: str, text: str) -> Diagnostic | None:
    """Report the first character that no YAML file may hold; None if there is none."""
    match = _FORBIDDEN.search(text)
    if match is None:
        return None
    before = text[: match.start()].replace("\r\n", "\n").replace("\r", "\n").split("\n")
    at = Span(file, len(before), len(before[-1]) + 1, len(before), len(before[-1]) + 2)
    message = f"the control character U+{ord(match[0]):04X} cannot stand in YAML"
    return Diagnostic("syntax-error", message, at, help="delete it")


def explain(file: str, text: str, problem: Problem) -> Diagnostic:
    """Phrase a problem that the parser reports."""
    lines = re.split(r"\r\n|\r|\n", text)
    at = _clamp(lines, problem.line, problem.column)
    words = _words(lines[at[0]], at[1], problem)
    begun = problem.begun
    if words.at_start and begun is not None:
        return Diagnostic("syntax-error", words.message, _span(file, lines, begun), help=words.help)
    labels = (Label(_span(file, lines, begun), words.label),) if words.label and begun and begun != at else ()
    return Diagnostic("syntax-error", words.message, _span(file, lines, at), labels=labels, help=words.help)


def duplicate(key: str, at: Span, first: Span) -> Diagnostic:
    """Report a key that one mapping has twice."""
    labels = (Label(first, "first written here"),)
    return Diagnostic("duplicate-key", f"the key `{key}` is written twice", at, labels=labels, help="keep one of them")


def recursive(anchor: str, at: Span, begun: Span) -> Diagnostic:
    """Report an alias inside the value that it stands for."""
    label = Label(Span(begun.file, begun.line, begun.column, begun.line, begun.column + 1), "begins here")
    message = f"`*{anchor}` stands inside of what it stands for"
    return Diagnostic("recursive-alias", message, at, labels=(label,), help="write out what is meant")


def _clamp(lines: list[str], line: int, column: int) -> tuple[int, int]:
    """Move a position behind the end of the text to the end of its last line that is not blank."""
    # The parser notices an unclosed bracket at the end of the file, which may be many blank lines below.
    last = len(lines) - 1
    while last > 0 and not lines[last].strip():
        last -= 1
    if line > last:
        return last, len(lines[last])
    return line, min(column, len(lines[line]))


def _span(file: str, lines: list[str], at: tuple[int, int]) -> Span:
    line, column = _clamp(lines, *at)
    return Span(file, line + 1, column + 1, line + 1, column + 1 + (column < len(lines[line])))


def _words(line: str, column: int, problem: Problem) -> _Words:
    found = problem.words
    if "mapping values are not allowed" in found:
        return _second_colon(line, column)
    if "cannot start any token" in found:
        return _bad_start(line[column : column + 1])
    if "node content" in found:
        return _bad_node(line[column : column + 1])
    if "expected key" in found or "expected <block end>" in found or "'-' indicator" in found:
        return _out_of_place(line, column)
    if "',' or ']'" in found or "',' or '}'" in found:
        return _unclosed(found, problem)
    fixed = (words for needle, words in _FIXED if needle in found or needle in problem.context)
    return next(fixed, _Words("this is not YAML", "compare it with the lines around it, or put text in quotes"))


_TAB = _Words("a tab cannot stand in the indentation", "indent with blanks")


def _second_colon(line: str, column: int) -> _Words:
    if re.search(r":\s", line[:column]):
        return _Words("a second `: ` in one line: text that holds `: ` must be quoted", QUOTE)
    help_line = "check the indentation, and that the key above ends in `:`"
    return _Words("a key cannot stand here: what is above is text", help_line)


def _bad_start(character: str) -> _Words:
    if character == "\t":
        return _TAB
    return _Words(
        f"text cannot begin with `{character}`" if character != "`" else "text cannot begin with a backtick", QUOTE
    )


def _bad_node(character: str) -> _Words:
    if character == ":":
        return _Words("a key is missing before `:`", "write `key: value`")
    if not character:
        return _Words("the text ends where a value should stand", "close what is open: `]` ends a list, `}` a mapping")
    return _Words(f"a value cannot begin with `{character}`", QUOTE)


def _out_of_place(line: str, column: int) -> _Words:
    if line[:column].strip(" -"):
        return _Words("the value ends before this", "put the whole text in one pair of quotes")
    if line[column : column + 1] == "-":
        return _Words("a list entry stands where a key is expected", "indent the list below its key")
    help_line = "keys of one mapping begin in the same column, and so do the entries of one list"
    return _Words("this line does not belong to anything above it", help_line, "what is open begins here")


def _unclosed(found: str, problem: Problem) -> _Words:
    opening, closing = ("[", "]") if "]" in found else ("{", "}")
    if problem.begun is not None and problem.begun[0] != problem.line:
        return _Words(f"this `{opening}` is not closed", f"write `{closing}` at its end", at_start=True)
    help_line = f"separate entries with `,`, end with `{closing}`, and quote text that holds `: `, brackets or braces"
    return _Words(f"`,` or `{closing}` is missing before this", help_line, f"this `{opening}` is open")


# Parts of the parser's message or context, and our text; the first match wins. "hexdecimal" is libyaml's spelling.
_FIXED: tuple[tuple[str, _Words], ...] = (
    ("tab character", _TAB),
    (
        "sequence entries are not allowed",
        _Words("a list cannot begin on the line of its key", "begin it on the next line"),
    ),
    ("mapping keys are not allowed", _Words("text cannot begin with `? `", QUOTE)),
    (
        "could not find expected ':'",
        _Words("a key without `:`", "write `key: value`, or indent the text below its key", at_start=True),
    ),
    ("unexpected end of stream", _Words("this quote is never closed", "close it, or take it out", at_start=True)),
    ("unexpected document", _Words("this quote is never closed", "close it, or take it out", at_start=True)),
    ("escape c", _Words("an unknown escape in double quotes", "write `\\\\` for a backslash, or use single quotes")),
    ("hexdecimal", _Words("an unknown escape in double quotes", "write `\\\\` for a backslash, or use single quotes")),
    ("hexadecimal", _Words("an unknown escape in double quotes", "write `\\\\` for a backslash, or use single quotes")),
    (
        "scanning a block scalar",
        _Words("text cannot begin with `>` or `|`: these open a block of lines", QUOTE, at_start=True),
    ),
    ("scanning an anchor", _Words("text cannot begin with `&`", QUOTE, at_start=True)),
    ("scanning an alias", _Words("text cannot begin with `*`", QUOTE, at_start=True)),
    (" tag", _Words("text cannot begin with `!`", QUOTE, at_start=True)),
    (" directive", _Words("a line cannot begin with `%`", "put the text in quotes", at_start=True)),
    ("incompatible YAML", _Words("this version of YAML is not read", "take the line out: archgen reads YAML 1.2")),
    ("found unexpected ':'", _Words("the `:` has no blank after it", "write `key: value`")),
    (
        "<document start>",
        _Words("this does not belong to what is above it", "keys of one mapping begin in the same column"),
    ),
    ("did not find expected ':'", _Words("a key without `:`", "write `key: value`", at_start=True)),
)
