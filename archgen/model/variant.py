"""Variants: the same project otherwise, such as in the simulator."""

from __future__ import annotations

from archgen.diagnostics import NO_SPAN, Span
from archgen.frozen import dataclass, field

BASE_NAME = "base"
"""What the project itself is called where variants are named."""


@dataclass(frozen=True, slots=True)
class WrittenChange:
    """One leaf that a variant writes: its keys from the top of the project, joined by dots, and its value as text."""

    path: str
    value: str


@dataclass(frozen=True, slots=True)
class Variant:
    """The project otherwise: what it is built on, what it takes out, and what it writes over.

    `of` are the ids of variants as written, known or not; `without` is a selector, `drop` paths of keys.
    """

    id: str
    title: str
    description: str | None = None
    of: tuple[str, ...] = ()
    without: str | None = None
    drop: tuple[str, ...] = ()
    changes: tuple[WrittenChange, ...] = ()
    at: Span = field(default=NO_SPAN, compare=False, repr=False)
