"""Write plain data as YAML that versions 1.1 and 1.2 read alike: block style, quoted where one of them would misread
it.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence

from archgen.diagnostics import make_visible, replace_surrogates

ElementPath = tuple[str | int, ...]


class PlainText(str):
    """A scalar as somebody wrote it without quotes, such as `1.10`: it is written so again."""

    __slots__ = ()


class FlowMapping(dict[str, object]):
    """A mapping that is written in braces where it fits the line and no comment belongs into it."""

    __slots__ = ()


_MAX_FLOW_LINE = 120
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
    one_line_comments = {path: make_visible(text) for path, text in (comments or {}).items()}
    return "\n".join(_write_mapping(data, "", (), one_line_comments)) + "\n" if data else "{}\n"


def _write_mapping(
    data: Mapping[str, object], indent: str, parent_path: ElementPath, comments: Mapping[ElementPath, str]
) -> Iterator[str]:
    for key, value in data.items():
        element_path = (*parent_path, key)
        yield from _write_entry(f"{indent}{_format_text(key)}:", value, indent, element_path, comments)


def _write_entry(
    head: str, value: object, indent: str, element_path: ElementPath, comments: Mapping[ElementPath, str]
) -> Iterator[str]:
    comment = f"  # {comments[element_path]}" if element_path in comments else ""
    inner_indent = f"{indent}  "
    if isinstance(value, FlowMapping) and value:
        line = f"{head} {format_flow(value)}"
        depth = len(element_path)
        if len(line) <= _MAX_FLOW_LINE and not any(len(p) > depth and p[:depth] == element_path for p in comments):
            yield f"{line}{comment}"
            return
    if isinstance(value, Mapping) and value:
        yield f"{head}{comment}"
        yield from _write_mapping(value, inner_indent, element_path, comments)
    elif isinstance(value, Sequence) and not isinstance(value, str) and value:
        yield f"{head}{comment}"
        for number, item in enumerate(value):
            yield from _write_item(item, inner_indent, (*element_path, number), comments)
    elif isinstance(value, str) and fits_literal_block(value):
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
    if isinstance(value, PlainText):
        return str(value)
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
        return "{" + ", ".join(f"{_format_item(key)}: {_format_item(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, (list, tuple)) and value:
        return "[" + ", ".join(_format_item(item) for item in value) + "]"
    return format_scalar(value)


def _format_item(value: object) -> str:
    """Format what stands inside braces or brackets."""
    if isinstance(value, str):
        return _quote_text(value) if needs_quotes(value, in_flow=True) else value
    return format_flow(value)


def _format_float(value: float) -> str:
    return ".nan" if value != value else repr(value)  # noqa: PLR0124 - what tells NaN


def _format_text(text: str) -> str:
    return _quote_text(text) if needs_quotes(text) else text


def needs_quotes(text: str, *, in_flow: bool = False) -> bool:
    """Return whether a reader of YAML 1.1 or 1.2 might take this text, unquoted, for something else.

    `in_flow` is inside braces or brackets.
    """
    # PyYAML ends a plain scalar in braces at any question mark.
    if in_flow and "?" in text:
        return True
    return not _PLAIN_SCALAR.match(text) or bool(_AMBIGUOUS_SCALAR.match(text)) or text[-1] in " \t"


def has_unsafe_characters(text: str) -> bool:
    """Return whether a text holds characters that no block scalar keeps, such as tabs."""
    return bool(_UNSAFE_IN_BLOCK.search(text))


def _quote_text(text: str) -> str:
    # A JSON string is a double-quoted scalar of YAML, but for the characters in the table: YAML wants them escaped.
    return json.dumps(replace_surrogates(text), ensure_ascii=False).translate(_CONTROL_ESCAPES)


_CONTROL_ESCAPES = {c: f"\\u{c:04x}" for c in (*range(0x7F, 0xA1), 0x2028, 0x2029, 0xFEFF, 0xFFFE, 0xFFFF)}


def fits_literal_block(text: str) -> bool:
    """Return whether a literal block (`|`) holds this text exactly."""
    # A leading blank would be taken for indentation, and two line feeds at the end need `+`: such texts are quoted.
    if "\n" not in text or text[0] in " \n" or has_unsafe_characters(text) or text.endswith("\n\n"):
        return False
    return all(line == line.rstrip() for line in text.split("\n"))
