"""Follow the keys of a file: what stands at a path, from the sections down through ids, kinds and keys.

A path says more than its last key: an input may be called `tags`, and what stands below `hints` is another program's.
"""

from __future__ import annotations

from collections.abc import Iterable

from archgen.language.language_tables import ENTRIES, ITEMS, KEYS, LIST_ORDERS

SLICE = "slice"
"""The part that a whole file is."""
OWN_DATA = ""
"""The part of what the language has no word for: data of other programs, and keys that nobody knows."""


def find_inner_part(part: str, step: str | int) -> str:
    """Return the part that a key of a mapping leads to, or the number of an item of a list. Keys go before ids."""
    if isinstance(step, int):
        return ITEMS.get(part, OWN_DATA)
    if (inner := KEYS.get(part, {}).get(step)) is not None:
        return inner
    if (entry := ENTRIES.get(part)) is not None:
        return entry
    # A path may leave the numbers of items out.
    return find_inner_part(ITEMS[part], step) if part in ITEMS else OWN_DATA


def find_part(path: Iterable[str | int]) -> str:
    """Return the part that stands at a path, which begins with a section."""
    part = SLICE
    for step in path:
        part = find_inner_part(part, step)
    return part


def find_list_order(path: Iterable[str | int]) -> str:
    """Return what the order of a list at a path means: `counts`, `free`, `gathered` or `headed`."""
    return LIST_ORDERS.get(find_part(path), "counts")
