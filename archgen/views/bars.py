"""The shape Chart: bars along one scale. A Figure may show one where it could show a Graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from archgen.views.shapes import Graph


@dataclass(frozen=True, slots=True)
class Stretch:
    """A piece of a bar, in the chart's unit; `length` None is unknown, drawn hatched with a question mark at the end.

    `label` stands inside where there is room for it, so `tooltip` says it too.
    """

    length: float | None
    kind: Literal["sampling", "response", "link", "load", "other_load", "met", "missed", "open", "best"]
    label: str = ""
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class Bar:
    """A row of a chart: a title, a bar that begins at `start`, and its figure at the right. `mark` is a tick on it.

    What is `around` belongs to the sum but not to the part that is shown: its texts are grey.
    """

    title: str
    stretches: tuple[Stretch, ...]
    value: str = ""
    start: float = 0.0
    mark: float | None = None
    strong: bool = False
    ref: str | None = None
    around: bool = False


@dataclass(frozen=True, slots=True)
class Chart:
    """Bars along one scale: terms of a sum one below the other against a limit, or shares of a whole.

    `id` and `title` are as in Graph. `limit` (place, text) is a line across all bars.
    """

    id: str
    title: str
    unit: str
    bars: tuple[Bar, ...]
    limit: tuple[float, str] | None = None
    said: str = ""
    """What follows from the picture, in a sentence above it."""
    legend: tuple[str, ...] = ()
    """Which kinds of stretch (and `mark`, `unknown`) the legend explains, each as `kind` or `kind: words`."""
    notes: tuple[str, ...] = ()
    alt: str = ""


Drawing = Graph | Chart
"""What a Figure may show."""
