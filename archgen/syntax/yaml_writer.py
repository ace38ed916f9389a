"""Write plain data as YAML that versions 1.1 and 1.2 read alike: block style, quoted where one of them would misread
it.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence

ElementPath = tuple[str | int, ...]
_PLAIN_SCALAR = re.compile(
    r"[A-Za-z0-9_/(<+^$][^\x00-\x1f\x7f-\xa0\u2028\u2029\ufeff\ufffe\uffff\ud800-\udfff#:,\[\]{}'\"]*\Z"
)
# What YAML 1.1 or 1.2 reads as something else than text: null, booleans, numbers, dates, sexagesimals (`12:30`), the
# merge key `<<` and the value key `=`.
_AMBIGUOUS_SCALAR = re.compile(
    r"(?:~|null|true|false|yes|no|on|off|y|n|[-+]?\.(?:inf|nan)|<<|=)\Z"
    r"|[-+.]?[0-9][0-9_]*(?:[.:eExXobB+\-][0-9a-fA-F_.:eE+\-TtZz ]*)?\Z",
    re.IGNORECASE,
)
_UNSAFE_IN_BLOCK = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x84\x86-\x9f\u2028\u2029\ufeff\ufffe\uffff\ud800-\udfff\t]")


def write_yaml(data: Mapping[str, object], comments: Mapping[ElementPath, str] | None = None) -> str:
    """Write a mapping of mappings, lists, text, numbers, booleans and None.

    `comments` puts `# text` behind the line on which the element at a path (keys and list positions) begins.
    """
    return "\n".join(_write_mapping(data, "", (), comments or {})) + "\n" if data else "{}\n"


def _write_mapping(
    data: Mapping[str, object], indent: str, parent_path: ElementPath, comments: Mapping[ElementPath, str]
) -> Iterator[str]:
    for key, value in data.items():
        element_path = (*parent_path, key)
        yield from _write_entry(f"{indent}{_format_key(key)}:", value, indent, element_path, comments)


def _write_entry(
    head: str, value: object, indent: str, element_path: ElementPath, comments: Mapping[ElementPath, str]
) -> Iterator[str]:
    comment = f"  # {comments[element_path]}" if element_path in comments else ""
    inner_indent = f"{indent}  "
    if isinstance(value, Mapping) and value:
        yield f"{head}{comment}"
        yield from _write_mapping(value, inner_indent, element_path, comments)
    elif isinstance(value, Sequence) and not isinstance(value, str) and value:
        yield f"{head}{comment}"
        for number, item in enumerate(value):
            yield from _write_item(item, inner_indent, (*element_path, number), comments)
    elif isinstance(value, str) and _fits_literal_block(value):
        lines = value.split("\n")
        chomping = "" if value.endswith("\n") else "-"
        yield f"{head} |{chomping}{comment}"
        yield from (f"{inner_indent}{line}" if line else "" for line in (lines[:-1] if chomping == "" else lines))
    else:
        yield f"{head} {format_scalar(value)}{comment}"


def _write_item(
    value: object, indent: str, element_path: ElementPath, comments: Mapping[ElementPath, str]
) -> Iterator[str]:
    """Yield the lines of a list's item. A mapping in it begins on its own line, so that every element has a line."""
    if isinstance(value, (Mapping, list, tuple)) and value:
        yield from _write_entry(f"{indent}-", value, indent, element_path, comments)
    else:
        comment = f"  # {comments[element_path]}" if element_path in comments else ""
        yield f"{indent}- {format_scalar(value)}{comment}"


def format_scalar(value: object) -> str:
    """Format one scalar, or an empty mapping or list, on one line."""
    if isinstance(value, str):
        return _format_text(value)
    if isinstance(value, (Mapping, list, tuple)):
        return "{}" if isinstance(value, Mapping) else "[]"
    return (
        {float("inf"): ".inf", float("-inf"): "-.inf"}.get(value, _format_float(value))
        if isinstance(value, float)
        else json.dumps(value)
    )


def format_flow(value: object) -> str:
    """Format a value on one line: mappings in braces, lists in brackets."""
    if isinstance(value, Mapping) and value:
        return "{" + ", ".join(f"{format_scalar(key)}: {format_flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, (list, tuple)) and value:
        return "[" + ", ".join(format_flow(item) for item in value) + "]"
    return format_scalar(value)


def write_paragraph(head: str, text: str, indent: str, width: int) -> Iterator[str]:
    """Yield the lines of a long text: folded (`>-`) where single blanks separate its words, else as `write_yaml`."""
    if text == " ".join(text.split()) and not _UNSAFE_IN_BLOCK.search(text):
        yield f"{head} >-"
        for line in textwrap.wrap(text, width - len(indent), break_long_words=False, break_on_hyphens=False):
            yield f"{indent}{line}"
    else:
        yield from _write_entry(head, text, indent[:-2], (), {})


def _format_float(value: float) -> str:
    return ".nan" if value != value else repr(value)  # noqa: PLR0124 - what tells NaN


def _format_key(key: str) -> str:
    return _format_text(key)


def _format_text(text: str) -> str:
    is_plain = _PLAIN_SCALAR.match(text) and not _AMBIGUOUS_SCALAR.match(text) and text[-1] not in " \t"
    return text if is_plain else _quote_text(text)


def _quote_text(text: str) -> str:
    """Quote a text. What YAML cannot hold (lone surrogates) becomes `?`."""
    # A JSON string is a double-quoted scalar of YAML, but for the characters in the table: YAML wants them escaped.
    return json.dumps(text.encode("utf-8", "replace").decode("utf-8"), ensure_ascii=False).translate(_CONTROL_ESCAPES)


_CONTROL_ESCAPES = {c: f"\\u{c:04x}" for c in (*range(0x7F, 0xA1), 0x2028, 0x2029, 0xFEFF, 0xFFFE, 0xFFFF)}


def _fits_literal_block(text: str) -> bool:
    """Return whether a literal block (`|`) holds this text exactly."""
    # A leading blank would be taken for indentation, and two line feeds at the end need `+`: such texts are quoted.
    if "\n" not in text or text[0] in " \n" or _UNSAFE_IN_BLOCK.search(text) or text.endswith("\n\n"):
        return False
    return all(line == line.rstrip() for line in text.split("\n"))
