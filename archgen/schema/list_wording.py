"""Word what is wrong with text that stands where a list is asked, and with several ids in one entry of a list."""

from __future__ import annotations

import re
import shlex
from typing import Any

from archgen.schema.language_schema import resolve_part

_ID = re.compile(r"[A-Za-z/~][A-Za-z0-9._/~-]*\Z", re.ASCII)
"""An id or the name of a topic."""
_LOWER_PATH = re.compile(r"[a-z][a-z0-9_.]*\Z")
_SEPARATOR = re.compile(r"(?:(?<!\s)\s++)?+(?:[,;]|->)\s*+|(?<!\s)\s++(?:and|&)\s++")
_UNQUOTED_TEXT = re.compile(r"[A-Za-z0-9_/][\w ./@+-]*\Z", re.ASCII)
_RANGE = re.compile(r"(\d{1,4})\s*(?:-|\.\.\.?)\s*(\d{1,4})\Z", re.ASCII)
_ENDS = re.compile(r"([+-]?\d+(?:\.\d+)?)\s*(?:-|\.\.\.?|,|;|to)\s*([+-]?\d+(?:\.\d+)?)\Z", re.ASCII)
_NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?\Z", re.ASCII)
_SHELL_SIGN = re.compile(r"[$&|;<>`*?~]")
_MAX_RANGE = 16
"""A longer list of numbers is not written out."""
_MAX_LENGTH = 1000
"""Longer text is no list of ids that somebody wrote by hand."""


def split_ids(text: str, schema_part: dict[str, Any]) -> list[str]:
    """Return the entries of a list that is written as one text, such as `R-1, R-4`; empty where it is no such list.

    `schema_part` is that of the list. Where its entries may be sentences, every part must be one word; words without
    a comma between them are ids only if each of them is in lower case, or holds a digit where sentences are allowed.
    """
    if len(text) > _MAX_LENGTH:
        return []
    pattern = resolve_part(schema_part.get("items", {})).get("pattern")
    parts = [part for part in _SEPARATOR.split(text.strip().strip("[]")) if part]
    if len(parts) == 1:
        parts = text.split()
        # `Head Camera` is a title, `head camera` perhaps two ids.
        is_id = re.compile(r"\d").search if pattern is None else _LOWER_PATH.match
        if not all(map(is_id, parts)):
            return []
    is_entry = re.compile(pattern).search if pattern else _ID.match
    return parts if len(parts) > 1 and all(map(is_entry, parts)) else []


def suggest_list(text: str, schema_part: dict[str, Any]) -> str:
    """Return a text as the list in brackets that was most likely meant."""
    entries = _list_range(text, schema_part) or split_ids(text, schema_part) or [text]
    return f"[{', '.join(map(_quote_entry, entries))}]"


def describe_list(text: str, schema_part: dict[str, Any]) -> str:
    """Return a line that says how a text is written as the list that is asked for."""
    is_range = schema_part.get("title") == "Range"
    return _describe_range(text) if is_range else f"write `{suggest_list(text, schema_part)}`"


def _describe_range(text: str) -> str:
    """Return a line that says how a range is written; both ends, where the text names them (`1-9`, `0..30`)."""
    start = "write its least and its greatest value:"
    if ends := _ENDS.match(text.strip()):
        least, greatest = sorted((ends[1], ends[2]), key=float)
        return f"{start} `[{least}, {greatest}]`"
    if not _NUMBER.match(text.strip()):
        return f"{start} `[0, 10]`, or `[0, .inf]` for no upper end"
    end = text.strip()
    least, greatest = (end, "0") if end.startswith("-") else ("0", end)
    return f"{start} `[{least}, {greatest}]`, or `[{end}, .inf]` for no upper end"


def suggest_words(text: str) -> str:
    """Return a line for a shell as the list of words that was most likely meant, with what no shell will do."""
    try:
        words = shlex.split(text[:_MAX_LENGTH])
    except ValueError:  # a quote that is not closed
        words = text[:_MAX_LENGTH].split()
    note = "; no shell reads it" if _SHELL_SIGN.search(text) else ""
    return f"write its words as a list: `[{', '.join(map(_quote_entry, words))}]`{note}"


def _list_range(text: str, schema_part: dict[str, Any]) -> list[str]:
    """Return the numbers from the first to the last that a text such as `0-3` names; empty where it names none."""
    ends = _RANGE.match(text.strip())
    if ends is None or "integer" not in resolve_part(schema_part.get("items", {})).get("type", ()):
        return []
    first, last = int(ends[1]), int(ends[2])
    return [str(number) for number in range(first, last + 1)] if last - first < _MAX_RANGE else []


def _quote_entry(text: str) -> str:
    """Return a text as an entry of a list in brackets: quoted where YAML would read it as something else."""
    return text if _UNQUOTED_TEXT.match(text) else f'"{text}"'
