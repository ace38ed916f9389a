"""Parse Python that strangers wrote: as a syntax tree, never run, in bounded time and memory."""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Iterator
from typing import Literal

from archgen.plugin.importing import ForeignFileError, Span

MAX_CHARACTERS = 1_000_000
"""Launch files have a few thousand characters, the longest of known robots sixty thousand."""
_MAX_OPEN = 150
"""Brackets that are open at once: Python's own parser gives up at 200."""
_MAX_STRINGS_IN_STRINGS = 20
_WIDE_QUOTES = ('"""', "'''")
_BEGINNING = re.compile(r"#[^\n]*+|(?P<prefix>(?<![A-Za-z])[A-Za-z]{0,2})(?P<quote>\"\"\"|'''|\"|')")
"""Where a comment stands, or a string begins."""


class PythonRefusedError(Exception):
    """A text is no Python, or more than is read. Carries why, and where."""

    def __init__(self, message: str, line: int = 1, column: int = 1) -> None:
        super().__init__(message)
        self.message, self.line, self.column = message, line, column


def parse_python(text: str) -> ast.Module:
    """Return the syntax tree of a module. Raise PythonRefusedError."""
    if len(text) > MAX_CHARACTERS:
        raise PythonRefusedError(f"it has more than {MAX_CHARACTERS:,} characters, which no launch file has")
    try:
        tree = _parse_quietly(text, "exec")
    except PythonRefusedError as refusal:
        # Python 3.12 takes lines and quotes in braces of strings that an older one does not.
        try:
            tree = _parse_quietly("".join(_widen_format_strings(text)), "exec")
        except PythonRefusedError:
            raise refusal from None
    assert isinstance(tree, ast.Module)  # noqa: S101 - what this mode gives
    return tree


def _widen_format_strings(text: str) -> Iterator[str]:
    """Yield a text in pieces, with three quotes around strings `f"..."` that have lines or their own quotes in braces."""
    done = 0
    while (begin := _BEGINNING.search(text, done)) is not None:
        body, end = begin.end(), begin.end()
        if quote := begin["quote"]:
            is_format = "f" in begin["prefix"].lower()
            end = _find_string_end(text, body, quote, 0, is_format=is_format)
            inner = text[body : end - len(quote)]
            wide = next((each for each in _WIDE_QUOTES if each not in inner and not inner.endswith(each[0])), "")
            if is_format and wide and len(quote) == 1 and ("\n" in inner or quote in inner):
                yield f"{text[done : body - 1]}{wide}{inner}{wide}"
                done = end
        yield text[done:end]
        done = end
    yield text[done:]


def _find_string_end(text: str, place: int, quote: str, depth: int, *, is_format: bool) -> int:
    """Return where the string ends whose text begins at a place; the end of all text where it does not end."""
    open_brackets = 0
    while place < len(text):
        character = text[place]
        if open_brackets and character in "'\"" and depth < _MAX_STRINGS_IN_STRINGS:
            inner = text[place : place + 3] if text[place : place + 3] in _WIDE_QUOTES else character
            is_inner_format = text[place - 1] in "fF" or text[place - 2 : place].lower() == "fr"
            place = _find_string_end(text, place + len(inner), inner, depth + 1, is_format=is_inner_format)
            continue
        if not open_brackets and text.startswith(quote, place):
            return place + len(quote)
        if text.startswith(("{{", "}}"), place) and not open_brackets:
            place += 1
        elif is_format and character in "{[(" and (open_brackets or character == "{"):
            open_brackets += 1
        elif open_brackets and character in "}])":
            open_brackets -= 1
        place += 2 if character == "\\" else 1
    return len(text)


def parse_expression(text: str) -> ast.expr | None:
    """Return the syntax tree of a short expression; None for anything else."""
    if len(text) > 2000 or sum(map(text.count, "([{")) > _MAX_OPEN:  # noqa: PLR2004 - nobody writes such
        return None
    try:
        tree = _parse_quietly(text.strip(), "eval")
    except PythonRefusedError:
        return None
    return tree.body if isinstance(tree, ast.Expression) else None


def _parse_quietly(text: str, mode: Literal["exec", "eval"]) -> ast.AST:
    try:
        with warnings.catch_warnings():
            # Python warns of `\d` and `is 1`: that is the author's affair.
            warnings.simplefilter("ignore")
            return ast.parse(text, mode=mode)
    except SyntaxError as error:
        words = error.msg.removesuffix(".") if error.msg else "it is no Python"
        raise PythonRefusedError(words, error.lineno or 1, max(error.offset or 1, 1)) from None
    except (RecursionError, MemoryError):
        raise PythonRefusedError("its expressions nest deeper than Python reads") from None
    except ValueError as error:
        # Null bytes, before Python 3.11.4: the same words as a SyntaxError has later.
        raise PythonRefusedError(str(error)) from None


def decode_text(file: str, data: bytes) -> str:
    """Return the text of a file. Raise ForeignFileError."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise ForeignFileError("it is no UTF-8", Span(file, line, 1, line, 2), "save it as UTF-8") from None


def parse_launch_module(file: str, data: bytes) -> tuple[str, ast.Module]:
    """Return the text and the syntax tree of a file. Raise ForeignFileError for what is no Python."""
    text = decode_text(file, data)
    try:
        return text, parse_python(text)
    except PythonRefusedError as error:
        span = Span(file, error.line, error.column, error.line, error.column + 1)
        raise ForeignFileError(error.message, span, "archgen reads launch files as Python 3 does") from None
