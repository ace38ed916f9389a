"""The shape Chart: bars along one scale. A Figure may show a Chart wherever it could show a Graph.

Why a shape of its own and not a layout of Graph: docs/decisions/0003-charts.md.
"""

from __future__ import annotations

from typing import Literal

from archgen.frozen import dataclass
from archgen.views.graph_shapes import Graph
from archgen.views.sequence_shapes import SequenceChart

SegmentKind = Literal[
    "sampling",
    "response",
    "link",
    "load",
    "other_load",
    "met",
    "missed",
    "late_wait",
    "unproven",
    "open",
    "best",
    "gap",
]
"""What a piece of a bar is; nothing is drawn for a `gap`."""


@dataclass(frozen=True, slots=True)
class BarSegment:
    """A piece of a bar, its length in the chart's unit; None is unknown, drawn hatched with a question mark.

    `label` is drawn inside only where there is room, so `tooltip` repeats it.
    """

    length: float | None
    kind: SegmentKind
    label: str = ""
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class ChartBar:
    """A row of a chart: a title, a bar that begins at `start`, and its value as text at the right.

    `mark` is a tick on the bar's scale. `is_outside`: counted in the sum although it lies outside the selected part;
    its text is grey.
    """

    title: str
    segments: tuple[BarSegment, ...]
    value: str = ""
    start: float = 0.0
    mark: float | None = None
    strong: bool = False
    ref: str | None = None
    is_outside: bool = False


@dataclass(frozen=True, slots=True)
class Chart:
    """Bars along one scale: terms of a sum below each other against a limit, or shares of a whole.

    `id` and `title` are as in Graph. `limit` (position, text) is a line across all bars.
    """

    id: str
    title: str
    unit: str
    bars: tuple[ChartBar, ...]
    limit: tuple[float, str] | None = None
    conclusion: str = ""
    """What follows from the picture, as a sentence above it."""
    legend: tuple[str, ...] = ()
    """Which kinds of segment (and `mark`, `unknown`) the legend explains, each as `kind` or `kind: words`."""
    notes: tuple[str, ...] = ()
    alt: str = ""


Drawing = Graph | Chart | SequenceChart
"""What a Figure may show."""
