"""The four plain shapes that every emitter draws: Graph, Table, Outline and Record (see `bars` for the Chart).

Views make them from the model and its analyses; emitters know nothing else, so a new format costs one template.
Everything in here is plain data (tuples, strings, numbers), and `plain()` turns it into dicts and lists.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

Record = Mapping[str, Any]
"""The resolved model as plain data: dicts, lists, strings, numbers, booleans, None."""


@dataclass(frozen=True, slots=True)
class Text:
    """A run of text. `ref` is the anchor of a section, table, figure or element page (emitters turn it into a link,
    and leave the text plain where the target is not part of the output); `url` is an address outside.
    """

    text: str
    ref: str | None = None
    url: str | None = None
    strong: bool = False
    emphasis: bool = False
    code: bool = False
    muted: bool = False
    line_break: bool = False
    """A line break stands before this run."""
    change: Literal["added", "removed", "changed"] | None = None
    """What it tells of: emitters may colour it; its words and sign say the same."""


Inlines = tuple[Text, ...]
Changed = Literal["added", "removed", "changed", "renamed"]
"""What happened to an element of a picture that shows two versions: told by the sign in its text and by its line."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: its heading and its share of the width."""

    title: str
    weight: float = 1.0
    align: Literal["left", "right", "centre"] = "left"


@dataclass(frozen=True, slots=True)
class Table:
    """A table with a caption. `anchor` is unique in the output. Rows have as many cells as there are columns.

    A table without rows is never made: say so in a paragraph instead.
    """

    anchor: str
    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Inlines, ...], ...]
    row_anchors: tuple[str | None, ...] = ()
    wide: bool = False
    """The page turns to landscape for it."""
    numbered: bool = True
    """It has a caption with a number and stands in the list of tables."""


def without_empty_columns(table: Table) -> Table:
    """Drop the columns in which no row says anything; the first one stays."""
    kept = [place for place in range(len(table.columns)) if place == 0 or any(row[place] for row in table.rows)]
    return dataclasses.replace(
        table,
        columns=tuple(table.columns[place] for place in kept),
        rows=tuple(tuple(row[place] for place in kept) for row in table.rows),
    )


Pace = Literal[
    "to_10_ms", "to_30_ms", "to_100_ms", "to_300_ms", "to_1_s", "slower", "unknown", "event", "on_demand", "once"
]
"""Steps of the period scale: how often something happens, else why it has no period."""


@dataclass(frozen=True, slots=True)
class Box:
    """A box of a graph.

    `style`: what it is; `emphasis`: `subject` (thick frame), `normal`, or `neighbour` (grey). `colour` is an index into
    the palette of group hues, None for no hue. `lines` stand below the title in small type. `ports_in` and `ports_out`
    (name, text) are rows at its sides. `side` puts neighbours at the outer ranks.
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
    ref: str | None = None
    tooltip: str = ""
    badge: Literal["error", "warning", "note"] | None = None
    fill: Pace | None = None
    """Fills the box by the period scale; frame and text tell apart what has no period."""
    change: Changed | None = None


@dataclass(frozen=True, slots=True)
class Arrow:
    """An edge of a graph, from box `tail` to box `head` (`id` is unique in the graph).

    `flows` says what runs along it, one sentence each (tooltip, and a table beside the picture); `count` is how many
    flows a merged arrow stands for, shown as its label in overviews.
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
    change: Changed | None = None


@dataclass(frozen=True, slots=True)
class Cluster:
    """A frame round boxes: a group, a host, a container. `parent` nests it in another."""

    id: str
    title: str
    lines: tuple[str, ...] = ()
    colour: int | None = None
    emphasis: Literal["subject", "normal", "neighbour"] = "normal"
    parent: str | None = None
    ref: str | None = None
    tooltip: str = ""


@dataclass(frozen=True, slots=True)
class Graph:
    """A picture. `id` is its file name without ending (slashes make folders: `groups/environment_state`).

    `layout` names the recipe: `flow` (one dot run), `group` (one cluster with neighbours at both sides), `two-step`
    (each cluster by itself, then the clusters as boxes), `overview` (boxes and merged arrows), `framed` (one dot run with
    frames round the boxes, for few of them; texts are set on the arrows afterwards).
    `asked` is the number of flows that the picture must account for: the arrows' counts add up to it.
    """

    id: str
    title: str
    layout: Literal["flow", "group", "two-step", "overview", "framed"]
    boxes: tuple[Box, ...]
    arrows: tuple[Arrow, ...]
    clusters: tuple[Cluster, ...] = ()
    direction: Literal["left-right", "top-bottom"] = "left-right"
    legend: tuple[str, ...] = ()
    """Which keys of the legend apply: names of styles, `width`, `colour`, `neighbour`, ..."""
    legend_colours: tuple[tuple[int, str], ...] = ()
    """Palette index and the text that it stands for, where colour means something else than the group."""
    notes: tuple[str, ...] = ()
    """What the picture leaves out or folds, said below it."""
    alt: str = ""
    """What the picture shows, for who cannot see it."""
    asked: int = 0


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph of text. `kind` `note`, `warning` and `error` stand out."""

    inlines: Inlines
    kind: Literal["text", "note", "warning", "error"] = "text"


@dataclass(frozen=True, slots=True)
class Markdown:
    """CommonMark from the project. `folder` (relative to the project) is where its pictures' paths begin.

    `shift` is added to the level of its headings, so that they nest below the section they stand in.
    """

    text: str
    folder: str = ""
    shift: int = 0


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture in the flow, by its graph's or chart's id. `anchor` is unique in the output."""

    anchor: str
    graph: str
    caption: str
    alt: str


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list, each item a line of text."""

    items: tuple[Inlines, ...]
    ordered: bool = False


@dataclass(frozen=True, slots=True)
class Facts:
    """A short two-column list of names and values (owner, status, host): a definition list or an unnumbered table."""

    rows: tuple[tuple[str, Inlines], ...]


Block = Paragraph | Markdown | Figure | Bullets | Facts | Table


@dataclass(frozen=True, slots=True)
class Section:
    """A heading with what stands below it. `anchor` is unique in the output; references to an element use its anchor.

    `appendix` sections are lettered. `page_break` begins a new page in paged outputs.
    """

    anchor: str
    title: str
    blocks: tuple[Block, ...] = ()
    sections: tuple[Section, ...] = ()
    appendix: bool = False
    page_break: bool = False


@dataclass(frozen=True, slots=True)
class Outline:
    """A document: what its title page says, and its sections."""

    title: str
    subtitle: str = ""
    facts: tuple[tuple[str, Inlines], ...] = ()
    """Lines of the title page: version, revision, partners."""
    notices: tuple[Paragraph, ...] = ()
    """What the reader must know before anything else (a part is shown, findings stand open)."""
    sections: tuple[Section, ...] = ()
    language: str = "en"


@dataclass(frozen=True, slots=True)
class Page:
    """A page of the site. `path` is relative to the site's folder (`components/a.b.html`); `anchor` is what references
    to it use; `crumbs` are (title, anchor) from the start page down. `kind` groups pages in the navigation.
    """

    path: str
    anchor: str
    title: str
    kind: str
    section: Section
    crumbs: tuple[tuple[str, str], ...] = ()
    lead: str = ""
    """One line below the title: what sort of thing this is, its status, its owner."""


def plain(value: object) -> Any:  # noqa: ANN401 - plain data has no narrower type
    """Turn a shape into dicts, lists and scalars, for templates and JSON. Each dataclass adds its name as `shape`."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {f.name: plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return {"shape": type(value).__name__.lower(), **fields}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (tuple, list)):
        return [plain(item) for item in value]
    return value
