"""Names in the order in which people count: `g2` before `g10`."""

from __future__ import annotations

import re
from functools import lru_cache

_NUMBER = re.compile(r"([0-9]{1,18})")
"""Longer rows of digits are no numbers that anybody counts by."""


NaturalOrder = tuple[tuple[tuple[int, int, str], ...], str]


@lru_cache(4096)
def order_naturally(name: str) -> NaturalOrder:
    """Return what a name sorts by: its numbers by their value, its letters whatever their case, at last as it is written."""
    parts = _NUMBER.split(name.casefold())
    return tuple((0, int(part), "") if at % 2 else (1, 0, part) for at, part in enumerate(parts)), name
