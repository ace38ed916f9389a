"""Elements that passes made: which passes, and where what they were made from is written."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.diagnostics import Span
from archgen.frozen import NamedTuple

ElementPlace = tuple[str, int, int]
"""File, line and column of an element; column 0 for whatever begins on that line."""


class MadeElement(NamedTuple):
    """What an element was made from."""

    passes: tuple[str, ...]
    """The passes that made or changed it, in the order in which they ran; none where it is only known from where it is."""
    place: str
    """File, line and column of what it was made from."""

    @property
    def sentence(self) -> str:
        """Return what is said of it, without its place."""
        names = " and ".join(f"`{name}`" for name in self.passes)
        return f"made by the pass{'es' * (len(self.passes) > 1)} {names} from" if names else "from"

    def __str__(self) -> str:
        return f"{self.sentence} {self.place}"


def find_made_element(made_elements: Mapping[ElementPlace, MadeElement], place: Span) -> MadeElement | None:
    """Return what an element that is written at a place was made from, None where no pass had a hand in it."""
    if not made_elements:
        return None
    exact = made_elements.get((place.file, place.line, place.column))
    return exact or made_elements.get((place.file, place.line, 0))
