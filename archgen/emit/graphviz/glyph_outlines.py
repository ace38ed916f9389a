"""Letters that cairo wrote into an svg as outlines, in fewer bytes: the same curves, step by step from point to point.

Four fifths of a picture in a report are letters, since each picture has its own. Steps are shorter than coordinates.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache

_SYMBOL = re.compile(rb'<symbol overflow="visible" id="(glyph[0-9-]+)">\n.*?</symbol>\n', re.DOTALL)
_USE = re.compile(rb'href="#(glyph[0-9-]+)"')
_PATH = re.compile(rb' d="([^"]*)"')
_TOKEN = re.compile(rb"[A-Za-z]|-?[0-9.]+")
_NUMBERS_BY_COMMAND = {b"M": 2, b"L": 2, b"C": 6, b"Z": 0}
_LEADING_ZERO = re.compile(r"^(-?)0\.")
_UNIT = 100
"""Hundredths of a point: as exact as what cairo's numbers are cut to."""


def shorten_glyphs(svg: bytes) -> bytes:
    """Return an svg whose letters are outlined in steps, without those that no text has."""
    used_ids = set(_USE.findall(svg))
    return _SYMBOL.sub(
        lambda found: (
            _PATH.sub(lambda found: b' d="%s"' % shorten_path(found[1]), found[0]) if found[1] in used_ids else b""
        ),
        svg,
    )


@lru_cache(4096)
def shorten_path(path: bytes) -> bytes:
    """Return a path of absolute lines and curves as one of steps; any other path as it is."""
    tokens = _TOKEN.findall(path)
    pieces: list[str] = []
    point, first_point = (0, 0), (0, 0)
    position = 0
    while position < len(tokens):
        command = tokens[position]
        count = _NUMBERS_BY_COMMAND.get(command)
        numbers = [round(float(token) * _UNIT) for token in tokens[position + 1 : position + 1 + (count or 0)]]
        if count is None or len(numbers) < count:
            return path
        position += 1 + count
        if not count:
            pieces.append("z")
            point = first_point
            continue
        if command == b"M" and pieces and position == len(tokens):
            break  # cairo ends with a move to where it is
        pieces.append(
            command.decode().lower() + _join_steps(number - point[at % 2] for at, number in enumerate(numbers))
        )
        point = (numbers[-2], numbers[-1])
        first_point = point if command == b"M" else first_point
    return "".join(pieces).encode()


def _join_steps(steps: Iterable[int]) -> str:
    """Write numbers, a blank between them only where no sign parts them."""
    texts = [_LEADING_ZERO.sub(r"\1.", f"{step / _UNIT:.2f}".rstrip("0").rstrip(".")) for step in steps]
    return "".join([text if text[0] == "-" or not at else f" {text}" for at, text in enumerate(texts)])
