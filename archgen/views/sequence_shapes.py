"""The shape SequenceChart: who says what to whom, one below the other. A Figure may show one wherever it could show a Graph.

Class and field names are a public interface: templates read them (docs/backends.md), so they must not change.
"""

from __future__ import annotations

from typing import Literal

from archgen.frozen import dataclass

MessageStyle = Literal["data", "service", "action", "physical", "broken", "inner"]


@dataclass(frozen=True, slots=True)
class Lifeline:
    """Who takes part: a box with a line below it. `colour` is an index into the palette of group hues, None for no hue."""

    title: str
    kind: Literal["actor", "component", "composed", "unknown"] = "component"
    colour: int | None = None
    ref: str | None = None
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class SequenceMessage:
    """A step: an arrow from one lifeline to another, by their positions; both the same for what happens inside.

    `text` stands above the arrow behind `number`, the lines of `detail` in small type below the text.
    """

    number: int
    tail: int
    head: int
    text: str = ""
    detail: str = ""
    style: MessageStyle = "data"
    ref: str | None = None
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class SequenceChart:
    """A sequence of steps; `id` and `title` are as in Graph."""

    id: str
    title: str
    lifelines: tuple[Lifeline, ...]
    messages: tuple[SequenceMessage, ...]
    legend: tuple[str, ...] = ()
    """Which styles of messages the legend explains."""
    notes: tuple[str, ...] = ()
    alt: str = ""
