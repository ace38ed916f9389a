"""Parse Python that strangers wrote: as a syntax tree, never run, in bounded time and memory."""

from __future__ import annotations

import ast
import warnings
from typing import Literal

from archgen.plugin.importing import ForeignFileError, Span

MAX_CHARACTERS = 1_000_000
"""Launch files have a few thousand characters, the longest of known robots sixty thousand."""
_MAX_OPEN = 150
"""Brackets that are open at once: Python's own parser gives up at 200."""


class PythonRefusedError(Exception):
    """A text is no Python, or more than is read. Carries why, and where."""

    def __init__(self, message: str, line: int = 1, column: int = 1) -> None:
        super().__init__(message)
        self.message, self.line, self.column = message, line, column


def parse_python(text: str) -> ast.Module:
    """Return the syntax tree of a module. Raise PythonRefusedError."""
    if len(text) > MAX_CHARACTERS:
        msg = f"it has more than {MAX_CHARACTERS:,} characters, which no launch file has"
        raise PythonRefusedError(msg)
    tree = _parse_quietly(text, "exec")
    assert isinstance(tree, ast.Module)  # noqa: S101 - what this mode gives
    return tree


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
        msg = "its expressions nest deeper than Python reads"
        raise PythonRefusedError(msg) from None
    except ValueError as error:
        # Null bytes, before Python 3.11.4: the same words as a SyntaxError has later.
        raise PythonRefusedError(str(error)) from None


def decode_text(file: str, data: bytes) -> str:
    """Return the text of a file. Raise ForeignFileError."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        words = "it is no UTF-8"
        raise ForeignFileError(words, Span(file, line, 1, line, 2), "save it as UTF-8") from None


def parse_launch_module(file: str, data: bytes) -> tuple[str, ast.Module]:
    """Return the text and the syntax tree of a file. Raise ForeignFileError for what is no Python."""
    text = decode_text(file, data)
    try:
        return text, parse_python(text)
    except PythonRefusedError as error:
        span = Span(file, error.line, error.column, error.line, error.column + 1)
        raise ForeignFileError(error.message, span, "archgen reads launch files as Python 3 does") from None
