"""The shapes of pictures: Graph, Chart and SequenceChart without places, which emitters lay out; Sheet with places."""

from __future__ import annotations

import dataclasses
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
    its text is grey. `gaps` counts the bars with something unknown before it in time: each pushes it by one width.
    """

    title: str
    segments: tuple[BarSegment, ...]
    value: str = ""
    start: float = 0.0
    gaps: int = 0
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


ElementChange = Literal["added", "removed", "changed", "renamed"]
"""What happened to an element of a picture that shows two versions; its text and its line style show it."""


PeriodStep = Literal[
    "to_10_ms", "to_30_ms", "to_100_ms", "to_300_ms", "to_1_s", "slower", "unknown", "event", "on_demand", "once"
]
"""Steps of the period scale, or why something has no period."""


@dataclass(frozen=True, slots=True)
class Box:
    """A box of a graph.

    `style` says what it is; `emphasis` is `subject` (thick frame), `normal` or `neighbour` (grey). `colour` is an index
    into the palette of group hues, None for no hue. `lines` follow the title in small type. `ports_in` and `ports_out`
    are rows (name, text) at its sides. `side` puts neighbours at the outer ranks. A `composed` box is a closed component
    of components, a `port` stands at the rim of an open one.
    """

    id: str
    title: str
    lines: tuple[str, ...] = ()
    style: Literal[
        "component",
        "source",
        "sink",
        "reactive",
        "group",
        "node",
        "topic",
        "service",
        "action",
        "external",
        "physical",
        "host",
        "container",
        "partner",
        "composed",
        "port",
        "fold",
        "link",
    ] = "component"
    emphasis: Literal["subject", "normal", "neighbour"] = "normal"
    status: Literal["existing", "adapted", "planned"] | None = None
    colour: int | None = None
    cluster: str | None = None
    side: Literal["left", "right"] | None = None
    ports_in: tuple[tuple[str, str], ...] = ()
    ports_out: tuple[tuple[str, str], ...] = ()
    rows: tuple[tuple[str, str], ...] = ()
    """A table below the lines: a name and what is to say of it; without the latter the name is a heading."""
    load: tuple[float | None, str] | None = None
    """A bar below the title: the share of 100 that is used, None where it is unknown, and its words."""
    ref: str | None = None
    tooltip: str = ""
    badge: Literal["error", "warning", "note"] | None = None
    badge_count: int = 0
    """How many findings the badge stands for, where the box stands for more than itself; 0 where it does not."""
    fill: PeriodStep | None = None
    """Fills the box by the period scale; frame and text distinguish what has no period."""
    change: ElementChange | None = None
    broken: bool = False
    """Whether a change breaks what it reads; a line says whose it is."""
    members: tuple[tuple[int | None, int], ...] = ()
    """What it stands for, a square each: palette index (None: grey) and how many."""


@dataclass(frozen=True, slots=True)
class Arrow:
    """An edge of a graph, from box `tail` to box `head`; `id` is unique in the graph.

    `flows` says what runs along it, one sentence each (for the tooltip, and for a table beside the picture). `count` is
    how many flows a merged arrow represents; overviews show it as the label.
    """

    id: str
    tail: str
    head: str
    label: str = ""
    tail_port: str | None = None
    head_port: str | None = None
    style: Literal["data", "physical", "service", "action", "internal", "link"] = "data"
    count: int = 1
    colour: int | None = None
    optional: bool = False
    faded: bool = False
    flows: tuple[str, ...] = ()
    ref: str | None = None
    change: ElementChange | None = None
    broken: bool = False
    """Whether a change of what runs along it breaks another partner."""
    is_made: bool = False
    """Whether nobody wrote it: `autoconnect` joined its ends."""
    medium: str = ""
    """How what it travels over is called, if that is data but no ROS."""


@dataclass(frozen=True, slots=True)
class Cluster:
    """A frame around boxes: a group, a host, a container; `parent` nests it in another cluster."""

    id: str
    title: str
    lines: tuple[str, ...] = ()
    colour: int | None = None
    emphasis: Literal["subject", "normal", "neighbour"] = "normal"
    parent: str | None = None
    ref: str | None = None
    tooltip: str = ""


UPRIGHT = "_upright"
"""Behind the id of a picture: the same for paper and narrow screens."""
GraphKind = Literal[
    "overview",
    "components",
    "group",
    "component",
    "composed",
    "implementation",
    "ros",
    "hosts",
    "frames",
    "start",
    "timing",
    "group-timing",
    "view",
    "agreement",
    "component-changes",
    "node-changes",
]
"""What a graph shows. docs/backends.md describes each."""


@dataclass(frozen=True, slots=True)
class Graph:
    """A picture; `id` is its file name without extension, where a slash makes a folder (`groups/environment_state`).

    `kind` says what it shows, so that templates need not take the id apart.

    `layout` names the recipe: `flow` (one run of dot), `group` (one cluster with neighbours at both sides), `two-step`
    (each cluster by itself, then the clusters as boxes), `overview` (boxes in columns, one line for each pair), `framed` (one run of dot
    with frames around the boxes, for small graphs; labels are placed on the arrows afterwards). `asked` is the number
    of flows that the picture must account for: the arrows' counts add up to it.
    """

    id: str
    title: str
    layout: Literal["flow", "group", "two-step", "overview", "framed"]
    boxes: tuple[Box, ...]
    arrows: tuple[Arrow, ...]
    clusters: tuple[Cluster, ...] = ()
    direction: Literal["left-right", "top-bottom"] | None = None
    """Which way the project wants the flow to run; None: as the layout reads best, `flow` and `group` to the right."""
    legend: tuple[str, ...] = ()
    """Which keys of the legend apply: names of styles, `count`, `neighbour`, ..."""
    legend_colours: tuple[tuple[int, str], ...] = ()
    """Palette index and its meaning, where colour stands for something other than the group."""
    notes: tuple[str, ...] = ()
    """What the picture leaves out or folds; shown below it."""
    alt: str = ""
    """What the picture shows, for readers who cannot see it."""
    asked: int = 0
    # By keyword and without a default: a new picture must say what it shows.
    kind: GraphKind = dataclasses.field(kw_only=True)


SheetColour = Literal[
    "text",
    "muted",
    "paper",
    "line",
    "tint",
    "blank",
    "step1",
    "step2",
    "step3",
    "step4",
    "blue",
    "amber",
    "violet",
    "green",
    "red",
    "unknown",
]
"""What a part of a sheet is drawn in; `step1` to `step4` are a scale, `unknown` is hatched."""


@dataclass(frozen=True, slots=True)
class SheetBar:
    """A rectangle of a sheet by its left upper corner, with a text in its middle if it has one."""

    x: float
    y: float
    width: float
    height: float
    fill: SheetColour = "blue"
    rim: SheetColour | None = None
    dashed: bool = False
    rounded: bool = False
    behind: bool = False
    """Whether lines pass over it; it has neither label nor link then."""
    label: str = ""
    ref: str | None = None
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class SheetText:
    """A line of text of a sheet that begins at x, ends there (`right`) or has its middle there; y is its middle."""

    x: float
    y: float
    text: str
    size: float = 8.5
    bold: bool = False
    side: Literal["left", "right", "middle"] = "left"
    ink: SheetColour = "text"
    ref: str | None = None
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class SheetLine:
    """A line of a sheet through points, with an arrow head at its end if it is one."""

    points: tuple[tuple[float, float], ...]
    width: float = 1.0
    ink: SheetColour = "line"
    head: bool = True
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A picture whose parts have their places, in points, y downwards; `id` and `title` are as in Graph."""

    id: str
    title: str
    bars: tuple[SheetBar, ...]
    texts: tuple[SheetText, ...]
    lines: tuple[SheetLine, ...] = ()
    notes: tuple[str, ...] = ()
    alt: str = ""


Drawing = Graph | Chart | SequenceChart | Sheet
"""What a Figure may show."""
