"""Write plain data as YAML that versions 1.1 and 1.2 read alike: block style, quoted where one of them would misread
it.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence

Place = tuple[str | int, ...]
_PLAIN = re.compile(
    r"[A-Za-z0-9_/(<+^$][^\x00-\x1f\x7f-\xa0\u2028\u2029\ufeff\ufffe\uffff\ud800-\udfff#:,\[\]{}'\"]*\Z"
)
# What YAML 1.1 or 1.2 reads as something else than text: null, booleans, numbers, dates, sexagesimals (`12:30`), the
# merge key `<<` and the value key `=`.
_OTHERWISE = re.compile(
    r"(?:~|null|true|false|yes|no|on|off|y|n|[-+]?\.(?:inf|nan)|<<|=)\Z"
    r"|[-+.]?[0-9][0-9_]*(?:[.:eExXobB+\-][0-9a-fA-F_.:eE+\-TtZz ]*)?\Z",
    re.IGNORECASE,
)
_UNSAFE_BLOCK = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x84\x86-\x9f\u2028\u2029\ufeff\ufffe\uffff\ud800-\udfff\t]")


def write(data: Mapping[str, object], comments: Mapping[Place, str] | None = None) -> str:
    """Write a mapping of mappings, lists, text, numbers, booleans and None.

    `comments` puts `# text` behind the line on which the element at a path (keys and list positions) begins.
    """
    return "\n".join(_mapping(data, "", (), comments or {})) + "\n" if data else "{}\n"


def _mapping(data: Mapping[str, object], indent: str, place: Place, comments: Mapping[Place, str]) -> Iterator[str]:
    for key, value in data.items():
        here = (*place, key)
        yield from _entry(f"{indent}{_key(key)}:", value, indent, here, comments)


def _entry(head: str, value: object, indent: str, here: Place, comments: Mapping[Place, str]) -> Iterator[str]:
    comment = f"  # {comments[here]}" if here in comments else ""
    inner = f"{indent}  "
    if isinstance(value, Mapping) and value:
        yield f"{head}{comment}"
        yield from _mapping(value, inner, here, comments)
    elif isinstance(value, Sequence) and not isinstance(value, str) and value:
        yield f"{head}{comment}"
        for number, item in enumerate(value):
            yield from _item(item, inner, (*here, number), comments)
    elif isinstance(value, str) and _block(value):
        lines = value.split("\n")
        chomping = "" if value.endswith("\n") else "-"
        yield f"{head} |{chomping}{comment}"
        yield from (f"{inner}{line}" if line else "" for line in (lines[:-1] if chomping == "" else lines))
    else:
        yield f"{head} {scalar(value)}{comment}"


def _item(value: object, indent: str, here: Place, comments: Mapping[Place, str]) -> Iterator[str]:
    """Yield the lines of a list's item. A mapping in it begins on its own line, so that every element has a line."""
    if isinstance(value, (Mapping, list, tuple)) and value:
        yield from _entry(f"{indent}-", value, indent, here, comments)
    else:
        comment = f"  # {comments[here]}" if here in comments else ""
        yield f"{indent}- {scalar(value)}{comment}"


def scalar(value: object) -> str:
    """Format one scalar, or an empty mapping or list, on one line."""
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, (Mapping, list, tuple)):
        return "{}" if isinstance(value, Mapping) else "[]"
    return (
        {float("inf"): ".inf", float("-inf"): "-.inf"}.get(value, _number(value))
        if isinstance(value, float)
        else json.dumps(value)
    )


def flow(value: object) -> str:
    """Format a value on one line: mappings in braces, lists in brackets."""
    if isinstance(value, Mapping) and value:
        return "{" + ", ".join(f"{scalar(key)}: {flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, (list, tuple)) and value:
        return "[" + ", ".join(flow(item) for item in value) + "]"
    return scalar(value)


def paragraph(head: str, text: str, indent: str, width: int) -> Iterator[str]:
    """Yield the lines of a long text: folded (`>-`) where single blanks separate its words, else as `write_yaml`."""
    if text == " ".join(text.split()) and not _UNSAFE_BLOCK.search(text):
        yield f"{head} >-"
        for line in textwrap.wrap(text, width - len(indent), break_long_words=False, break_on_hyphens=False):
            yield f"{indent}{line}"
    else:
        yield from _entry(head, text, indent[:-2], (), {})


def _number(value: float) -> str:
    return ".nan" if value != value else repr(value)  # noqa: PLR0124 - what tells NaN


def _key(key: str) -> str:
    return _text(key)


def _text(text: str) -> str:
    plain = _PLAIN.match(text) and not _OTHERWISE.match(text) and text[-1] not in " \t"
    return text if plain else _quoted(text)


def _quoted(text: str) -> str:
    """Quote a text. What YAML cannot hold (lone surrogates) becomes `?`."""
    # A JSON string is a double-quoted scalar of YAML, but for the characters in the table: YAML wants them escaped.
    return json.dumps(text.encode("utf-8", "replace").decode("utf-8"), ensure_ascii=False).translate(_ESCAPES)


_ESCAPES = {c: f"\\u{c:04x}" for c in (*range(0x7F, 0xA1), 0x2028, 0x2029, 0xFEFF, 0xFFFE, 0xFFFF)}


def _block(text: str) -> bool:
    """Return whether a literal block (`|`) holds this text exactly."""
    # A leading blank would be taken for indentation, and two line feeds at the end need `+`: such texts are quoted.
    if "\n" not in text or text[0] in " \n" or _UNSAFE_BLOCK.search(text) or text.endswith("\n\n"):
        return False
    return all(line == line.rstrip() for line in text.split("\n"))
