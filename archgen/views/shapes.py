"""The plain shapes that emitters draw: Table, Outline and Record here, pictures in `picture_shapes`.

Views make them from the model and its analyses. Emitters know nothing else, so a new format costs one template.
Everything here is plain data (tuples, strings, numbers), and `shape_to_plain` turns it into dicts and lists. Class and
field names are a public interface: templates read them (docs/backends.md), so they must not change.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Iterable, Mapping
from functools import cache
from typing import Any, Literal

from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.views.matrix_shapes import Matrix

Record = Mapping[str, Any]
"""The resolved model as plain data: dicts, lists, strings, numbers, booleans, None."""


Status = Literal["met", "not proven", "missed", "open", "uncovered", "error", "warning", "note", "changed"]
"""States that documents tell in one language of colours and icons: verdicts on deadlines and loads (`met`, `not proven`,
`missed`, `open` where a figure is owed), what nobody serves (`uncovered`), severities of findings, and `changed`.
"""


@dataclass(frozen=True, slots=True)
class Meter:
    """A bar: the share of a whole (above 1 where it exceeds it), and its state. The rest of a partial one is unknown."""

    share: float
    status: Status
    is_partial: bool = False


@dataclass(frozen=True, slots=True)
class Text:
    """A run of text.

    `ref` is the anchor of a section, table, figure or element page. Emitters turn it into a link, or leave plain text
    where the target is not part of the output. `url` is an address on the web.
    """

    text: str
    ref: str | None = None
    url: str | None = None
    strong: bool = False
    emphasis: bool = False
    code: bool = False
    muted: bool = False
    line_break: bool = False
    """A line break precedes this run."""
    change: Literal["added", "removed", "changed"] | None = None
    """The change that this run reports. Emitters may colour it; its words say the same without colour."""
    sort_number: str | None = None
    """The exact number in its base unit (ns, Hz, B, B/s, a share) that a table sorts by: `20000000`, `1/3`. A cell
    without one sorts behind the cells of its column that have one.
    """
    status: Status | None = None
    """The state that this run tells. Emitters may show it as a coloured chip; its words say the same."""
    is_lower: bool = False
    """The figure is at least so much though it has no sign: a best case, a deadline. Emitters round it down."""
    is_place: bool = False
    """Whether this is a place in the project's files, `FILE:LINE`. One without an address may be offered to be copied."""
    is_number: bool = False
    """The run stands for the label of the figure or table that `ref` leads to: `Figure 3` in place of its text."""
    meter: Meter | None = None
    """A bar that repeats a figure of the same row; emitters may leave it out."""
    pieces: tuple[WaterfallPiece, ...] = ()
    """Stretches of time on an axis, which repeat figures of the same row; emitters may leave them out."""


Inlines = tuple[Text, ...]


def split_anchor(anchor: str) -> tuple[str, str]:
    """Return the kind that the anchor of a section or a page begins with, and the id: of `group:sensing`, for instance."""
    kind, _, subject = anchor.partition(":")
    return kind, subject


ColumnAlignment = Literal["left", "right", "centre"]


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: its heading, its share of the width and its alignment.

    `key` is what code calls it, whatever its heading: a column without one is only shown.
    """

    title: str
    weight: float = 1.0
    align: ColumnAlignment = "left"
    key: str = ""


def make_columns(*columns: str | tuple[str, float] | tuple[str, float, ColumnAlignment] | Column) -> tuple[Column, ...]:
    """Return columns by their headings, those with a weight and an alignment as tuples."""
    return tuple(
        each if isinstance(each, Column) else Column(each) if isinstance(each, str) else Column(*each)
        for each in columns
    )


@dataclass(frozen=True, slots=True)
class Table:
    """A table with a caption; each row has as many cells as there are columns.

    `anchor` is unique in the output. A table without rows is never made: say so in a paragraph instead.
    """

    anchor: str
    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Inlines, ...], ...]
    row_anchors: tuple[str | None, ...] = ()
    wide: bool = False
    """The page turns to landscape for this table."""
    numbered: bool = True
    """The caption has a number, and the table is in the list of tables."""
    dense: bool = False
    """Set in small type: one of many, to be looked up."""

    @property
    def kind(self) -> str:
        """What the table is, of whatever element: `table:inputs` of `table:inputs/sensing.camera`."""
        return self.anchor.partition("/")[0]


def keep_columns(table: Table, indices: Iterable[int]) -> Table:
    """Return a table with some of its columns."""
    kept = tuple(indices)
    return replace(
        table,
        columns=tuple(table.columns[index] for index in kept),
        rows=tuple(tuple(row[index] for index in kept) for row in table.rows),
    )


def drop_empty_columns(table: Table) -> Table:
    """Drop the columns that are empty in every row; the first column always stays."""
    return keep_columns(
        table, (index for index in range(len(table.columns)) if index == 0 or any(row[index] for row in table.rows))
    )


def drop_column(table: Table, key: str) -> Table:
    """Drop the column of a key."""
    return keep_columns(table, (index for index, column in enumerate(table.columns) if column.key != key))


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph of text; kinds other than `text` are highlighted."""

    inlines: Inlines
    kind: Literal["text", "note", "warning", "error"] = "text"


@dataclass(frozen=True, slots=True)
class Markdown:
    """CommonMark written by the project.

    `folder`, relative to the project, is the base of picture paths. `shift` is added to heading levels, so that they
    nest below the section that contains the text.
    """

    text: str
    folder: str = ""
    shift: int = 0


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture between other blocks, by the id of its graph or chart; `anchor` is unique in the output.

    `graph` keeps its name although it may name a chart: templates read it.
    """

    anchor: str
    graph: str
    caption: str
    alt: str
    numbered: bool = True
    """The picture has a caption with a number, and is in the list of figures."""
    max_height: float = 0
    """How high it is at most on paper, in mm, as long as it can be read; 0: as the page has room."""
    narrow: str | None = None
    """The id of the picture that narrow screens show in its place."""

    @property
    def kind(self) -> str:
        """What the picture shows, of whatever element: `figure:groups` of `figure:groups/sensing`."""
        return self.anchor.partition("/")[0]


@dataclass(frozen=True, slots=True)
class Bullets:
    """A list of lines of text."""

    items: tuple[Inlines, ...]
    ordered: bool = False


FactRow = tuple[str, Inlines]


class Fact(NamedTuple):
    """A fact of an element. `key` is what code calls it, whatever documents do; one without a key is only shown."""

    key: str
    title: str
    value: Inlines


@dataclass(frozen=True, slots=True)
class Facts:
    """Names and values in two columns (owner, status, host): a definition list or an unnumbered table."""

    rows: tuple[FactRow, ...]
    row_anchors: tuple[str | None, ...] = ()


def show_facts(facts: Iterable[Fact], without: Collection[str] = ()) -> Facts:
    """Return facts as a block, without those of some keys, and those of which nothing is known."""
    return show_known((fact.title, fact.value) for fact in facts if fact.key not in without)


def show_known(facts: Iterable[tuple[str, Inlines]]) -> Facts:
    """Return facts as a block, without those of which nothing is known."""
    return Facts(tuple(fact for fact in facts if fact[1]))


Block = Paragraph | Markdown | Figure | Bullets | Facts | Table


@dataclass(frozen=True, slots=True)
class Section:
    """A heading with its blocks and subsections.

    `anchor` is unique in the output; references to an element use the element's anchor. `appendix` sections are
    lettered. `page_break` starts a new page in paged outputs.
    """

    anchor: str
    title: str
    blocks: tuple[Block, ...] = ()
    sections: tuple[Section, ...] = ()
    appendix: bool = False
    page_break: bool = False

    @property
    def kind(self) -> str:
        """What the section is about: `group` of `group:sensing`."""
        return split_anchor(self.anchor)[0]

    @property
    def subject(self) -> str:
        """The id of what the section is about: `sensing` of `group:sensing`."""
        return split_anchor(self.anchor)[1]


@dataclass(frozen=True, slots=True)
class Outline:
    """A document: its title page and its sections."""

    title: str
    subtitle: str = ""
    facts: tuple[tuple[str, Inlines], ...] = ()
    """Lines of the title page: version, revision, partners."""
    notices: tuple[Paragraph, ...] = ()
    """What the reader must know first, for example that only a part is shown or that there are errors."""
    sections: tuple[Section, ...] = ()
    language: str = "en"
    title_table: Table | None = None
    """The partners, on the title page."""
    front_sections: tuple[Section, ...] = ()
    """What stands before the contents, without numbers: history, abbreviations."""
    properties: Mapping[str, str] = field(default_factory=dict)
    """What the document says of itself by name: number, date, authors."""
    lists: tuple[str, ...] = ("figures", "tables")
    """The lists behind the contents."""
    has_large_paper: bool = True
    """Pictures may take sheets of twice the size."""
    has_narrow_margins: bool = False
    """Each section is to fit a page."""


@dataclass(frozen=True, slots=True)
class KeyFigure:
    """A figure of a dashboard: `value` of `total` (empty for a mere count), the reason below it, the page to go to."""

    title: str
    value: str
    total: str
    note: Inlines
    ref: str


@dataclass(frozen=True, slots=True)
class DashboardCard:
    """A card of a dashboard, with the link to the whole of it. `width` is its share of twelve; `kind` its layout."""

    title: str
    blocks: tuple[Block, ...]
    width: int
    remark: str = ""
    link: Text | None = None
    kind: str = ""


@dataclass(frozen=True, slots=True)
class Dashboard:
    """A page at a glance: figures, then cards."""

    figures: tuple[KeyFigure, ...]
    cards: tuple[DashboardCard, ...]


@dataclass(frozen=True, slots=True)
class WaterfallPiece:
    """A stretch of a bar, from one share of the axis to another. A cut one is longer than it is drawn."""

    kind: Literal["sampling", "response", "link", "unknown"]
    start: float
    end: float
    tip: str = ""
    is_cut: bool = False


@dataclass(frozen=True, slots=True)
class WaterfallStep:
    """A step: who takes the time, his owner and place below, and the pieces with their words."""

    title: Text
    note: Inlines
    pieces: tuple[WaterfallPiece, ...]
    words: str


@dataclass(frozen=True, slots=True)
class Waterfall:
    """Where a time goes: all of it on a true scale against its limit, then step by step on an axis that may be cut.

    Without a `total`, steps are all there is: they are then things side by side, such as the chains of a project.
    Positions are shares of an axis. `limits` are those of the limit on both axes, None where it is beyond.
    """

    lead: Inlines
    total: tuple[WaterfallPiece, ...]
    labels: tuple[tuple[float, str], ...]
    """Words below the whole, each at its position."""
    limits: tuple[float | None, float | None]
    limit_text: str
    ticks: tuple[tuple[float, str], ...]
    steps: tuple[WaterfallStep, ...]
    remark: str
    figures: tuple[KeyFigure, ...]
    cards: tuple[DashboardCard, ...]
    title: str = "Where the time goes"
    legend: tuple[tuple[str, str], ...] = (
        ("sampling", "waits to be read"),
        ("response", "responds"),
        ("link", "link"),
        ("unknown", "unknown"),
    )
    """What the kinds of pieces mean; those that are drawn are shown."""


@dataclass(frozen=True, slots=True)
class Page:
    """A page of the site.

    `path` is relative to the site's folder (`components/a.b.html`); `anchor` is what references to the page use;
    `crumbs` are (title, anchor) pairs from the start page down. `kind` groups pages in the navigation.
    """

    path: str
    anchor: str
    title: str
    kind: str
    section: Section
    crumbs: tuple[tuple[str, str], ...] = ()
    lead: str = ""
    """One line below the title: what kind of thing this is, its status, its owner."""
    verdict: Inlines = ()
    """The state of the thing, beside the title."""
    place: Text | None = None
    """Where the thing is written."""
    dashboard: Dashboard | None = None
    """What stands above the page's section, at a glance; the pages that it links to say the same at length."""
    matrix: Matrix | None = None
    """A matrix above the page's section."""
    waterfall: Waterfall | None = None
    """Where time goes, above the page's section: that of a chain, of a host, of all chains."""
    mark: Literal["open", "missed", "error"] | None = None
    """What the navigation marks: something here is open, a deadline is missed, or there is an error."""
    is_empty: bool = False
    """Whether there is nothing on it yet: only the paths of other pages lead to it, the navigation does not."""
    is_changed: bool = False
    """Whether this differs from the version that the site is compared with; the navigation marks that, too."""


def shape_to_plain(value: object) -> Any:  # noqa: ANN401 - plain data has no narrower type
    """Turn a shape into dicts, lists and scalars, for templates and JSON; dataclasses add their name as `shape`.

    Runs of text that are equal become the same dict, which nobody may write to: documents repeat most of their words.
    """
    return _to_plain(value, {})


def _to_plain(value: object, runs: dict[Text, dict[str, Any]]) -> Any:  # noqa: ANN401 - as above
    if value.__class__ in _SCALARS:
        return value
    # A meter of 1 and one of 1.0 are equal, and are not written alike.
    if isinstance(value, Text) and not value.meter and not value.pieces:
        if value not in runs:
            runs[value] = _tag_fields(value, runs)
        return runs[value]
    if isinstance(value, (tuple, list)):
        return [_to_plain(item, runs) for item in value]
    if isinstance(value, Mapping):
        return {str(key): _to_plain(item, runs) for key, item in value.items()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return _tag_fields(value, runs)
    # An enumeration is its text or its number.
    return str.__str__(value) if isinstance(value, str) else int(value) if isinstance(value, int) else value


_SCALARS = frozenset({str, int, float, bool, type(None)})


def _tag_fields(value: Any, runs: dict[Text, dict[str, Any]]) -> dict[str, Any]:  # noqa: ANN401 - any dataclass
    # Templates branch on this tag (`block.shape`), so renaming a shape class breaks users' backends.
    fields = {name: _to_plain(getattr(value, name), runs) for name in _name_fields(value.__class__)}
    return {"shape": value.__class__.__name__.lower(), **fields}


@cache
def _name_fields(shape: type) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(shape))
