"""Names of generic types with the types that they stand for: `Envelope<Pose>`, `Pair<Pose, List<Twist>>`.

Whether such a name is one of a generic type, the project decides: `<` may stand in the name of any type.
"""

from __future__ import annotations

import re
from functools import lru_cache
from itertools import pairwise

from archgen.frozen import NamedTuple

MAX_NAME_LENGTH = 200
"""The length of a type's name: generic types in generic types end here."""
_MAX_READ_LENGTH = 2 * MAX_NAME_LENGTH
_MARK = re.compile(r"<=[0-9]+|[<>,]")
"""What divides a name; the bound of a text (`string<=10`) does not."""


class GenericName(NamedTuple):
    """A name in its parts: `Pair<Pose, List<Twist>>` is `Pair` with `Pose` and `List<Twist>`; a plain name has none."""

    base: str
    arguments: tuple[str, ...] = ()


@lru_cache(4096)
def read_generic_name(name: str) -> GenericName:
    """Return the parts of a name; a name whose brackets do not close is plain, and so is one that nobody can read."""
    start = name.find("<")
    # Each level of brackets is read once more with the level around it.
    if start < 1 or not name.endswith(">") or len(name) > _MAX_READ_LENGTH:
        return GenericName(name)
    cuts, depth = [start], 0
    for mark in _MARK.finditer(name, start):
        depth += {"<": 1, ">": -1}.get(mark[0], 0)
        if mark[0] == "," and depth == 1:
            cuts.append(mark.start())
        elif depth == 0 and mark.end() < len(name):
            return GenericName(name)
    cuts.append(len(name) - 1)
    arguments = tuple(name[begin + 1 : end].strip() for begin, end in pairwise(cuts))
    return GenericName(name[:start].strip(), arguments) if depth == 0 and all(arguments) else GenericName(name)


def write_generic_name(name: str) -> str:
    """Return a name with its blanks as they are compared: none inside of brackets, one behind a comma."""
    if not read_generic_name(name).arguments:
        return name
    return re.sub(r"(?:(?<!\s)\s++)?+,\s*+", ", ", re.sub(r"(?:(?<!\s)\s++)?+([<>])(?!=[0-9])\s*+", r"\1", name))
