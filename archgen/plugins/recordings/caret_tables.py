"""Read the tables of CARET as pandas saves them (CSV): latencies of callbacks and of paths.

Two forms. Records have a column of times (ns) for each event, called after what the event happened to:
`/node/callback_0/callback_start_timestamp`, and in paths `/topic/rclcpp_publish_timestamp/0`. Plots have two rows of headings,
the name and the figure with its unit: `/node/callback_0`, below it `callback_start_timestamp [ns]` and `latency [ms]`.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from fractions import Fraction

from archgen.plugin import dataclass
from archgen.plugin.findings import Severity
from archgen.plugin.timing import SampleCounter
from archgen.plugins.recordings.recorded_figures import (
    Oddities,
    OddityText,
    RecordedFigures,
    RecordingSource,
    SampleKind,
)
from archgen.plugins.recordings.recorded_names import RecordedNames, UnmappedError

_UNIT_NS = {"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9}
_EVENT_COLUMN = re.compile(r"(?P<name>/.+?)/(?P<event>\w+_timestamp)(?P<place>/\d+(?:_(?:min|max))?)?\Z")
_PLOT_COLUMN = re.compile(r"(?P<figure>\w+) \[(?P<unit>[^\]]*)\]\Z")
_NUMBER = re.compile(r"-?\d{1,25}(?:\.\d{0,25})?(?:[eE][+-]?\d{1,2})?\Z", re.ASCII)
_EMPTY_CELLS = frozenset({"", "nan", "NaN", "<NA>", "None"})
_MAX_COLUMNS = 10_000
_ODDITIES = {
    "unreadable": OddityText("{count} row{s} with a cell that is no number, this one first; not counted"),
    "backwards": OddityText(
        "{count} row{s} with an end before the beginning, this one first: a clock was set; not counted"
    ),
    "short": OddityText(
        "{count} row{s} with fewer cells than the heading, this one first: the file is cut off; not counted",
        rule="syntax-error",
    ),
    "lost": OddityText(
        "{count} row{s} of a path without an end, this one first: lost, or still on its way; not counted",
        severity=Severity.NOTE,
    ),
}


@dataclass(frozen=True, slots=True)
class _Figure:
    """What a table tells of one thing: a column with its factor to ns, or the time from one column to another."""

    kind: SampleKind
    name: str
    steps: tuple[str, ...]
    """Of a path: callbacks and topics in order."""
    start: int | None
    end: int
    factor: int
    samples: SampleCounter


def is_caret_heading(lines: Sequence[str]) -> bool:
    """Whether the first lines of a file are the headings of CARET's tables."""
    rows = [row for line in lines[:2] if (row := _split_row(line))]
    return any(map(_EVENT_COLUMN.match, rows[0] if rows else ())) or any(
        _PLOT_COLUMN.match(cell) for row in rows for cell in row
    )


def _split_row(line: str) -> list[str] | None:
    """Return the cells of a line, None where it is no row of a CSV."""
    try:
        return [cell.strip() for cell in next(csv.reader([line]), [])]
    except csv.Error:
        return None


def read_caret_table(source: RecordingSource, names: RecordedNames, figures: RecordedFigures) -> None:
    """Read a table. Raise RecordingError where a unit is unknown."""
    reader = _TableReader(source)
    for number, row in _read_rows(source):
        reader.read_row(number, row)
    figures.diagnostics += reader.oddities.diagnose(_ODDITIES)
    _hand_over(source, reader, names, figures)


def _read_rows(source: RecordingSource) -> Iterator[tuple[int, list[str]]]:
    """Yield the rows with their line; CARET's cells hold no line breaks."""
    for number, line in source.read_lines():
        if line.strip():
            row = _split_row(line)
            if row is None:
                raise source.refuse(number, "this is no row of a CSV", "save the table with `to_csv`", "syntax-error")
            yield number, row


class _TableReader:
    def __init__(self, source: RecordingSource) -> None:
        self.oddities = Oddities(source)
        self.figures: list[_Figure] = []
        self.unread_columns: list[str] = []
        self._source = source
        self._names: list[str] | None = None
        self._has_heading = False

    def read_row(self, number: int, row: list[str]) -> None:
        if not self._has_heading:
            self._read_heading(number, row)
        elif not any(row[1:]):
            # pandas writes the index's name in a row of its own.
            return
        else:
            for figure in self.figures:
                self._read_figure(number, row, figure)

    def _read_heading(self, number: int, row: list[str]) -> None:
        if len(row) > _MAX_COLUMNS:
            message = f"the table has more than {_MAX_COLUMNS:,} columns"
            raise self._source.refuse(number, message, "save fewer callbacks in one table", "too-large")
        if any(_PLOT_COLUMN.match(cell) for cell in row):
            self.figures += self._find_plot_figures(number, row)
            self._has_heading = True
        elif any(_EVENT_COLUMN.match(cell) for cell in row):
            self.figures += _find_record_figures(row)
            self._has_heading = True
        elif self._names is None:
            self._names = row
        else:
            message = "these are no headings of CARET's: they name neither times nor figures with units"
            raise self._source.refuse(number, message, "save what `to_dataframe()` gives with `to_csv`", "syntax-error")

    def _find_plot_figures(self, number: int, row: list[str]) -> Iterator[_Figure]:
        names = self._names or []
        name = ""
        for column, cell in enumerate(row):
            # pandas repeats the upper heading; a spreadsheet that merged it leaves the other cells empty.
            name = (names[column] if column < len(names) else "") or name
            match = _PLOT_COLUMN.match(cell)
            if match is None or match["figure"].endswith("_timestamp"):
                continue
            factor = _UNIT_NS.get(match["unit"])
            kind = _find_kind(match["figure"], row[column - 1] if column else "")
            if kind is None:
                self.unread_columns.append(f"{name} {cell}".strip())
            elif factor is None:
                message = f"`{match['unit']}` is no unit of time that CARET uses"
                raise self._source.refuse(number, message, f"write one of {', '.join(_UNIT_NS)}")
            else:
                yield _Figure(kind, name, (), None, column, factor, SampleCounter())

    def _read_figure(self, number: int, row: list[str], figure: _Figure) -> None:
        if figure.end >= len(row):
            self.oddities.note("short", number)
            return
        cells = [row[figure.end]] if figure.start is None else [row[figure.end], row[figure.start]]
        if any(cell in _EMPTY_CELLS for cell in cells):
            # Tables of several callbacks are as long as the longest of them.
            if figure.steps and cells[-1] not in _EMPTY_CELLS:
                self.oddities.note("lost", number)
            return
        if not all(_NUMBER.match(cell) for cell in cells):
            self.oddities.note("unreadable", number)
            return
        values = [Fraction(cell) * figure.factor for cell in cells]
        duration = values[0] - (values[1] if len(values) > 1 else 0)
        if duration < 0:
            self.oddities.note("backwards", number)
        else:
            figure.samples.add_sample(round(duration))


def _find_kind(figure: str, column_before: str) -> SampleKind | None:
    """Return what a plot's figure is, by the figure and the times beside it."""
    if figure == "response_time":
        return "latency"
    if not column_before.startswith("callback_start_timestamp"):
        return None
    return {"latency": "execution", "period": "period"}.get(figure)  # type: ignore[return-value]


def _find_record_figures(row: list[str]) -> Iterator[_Figure]:
    """Yield the figures of a table of events: one callback, or one path from its first column to its last."""
    events = [(column, match) for column, cell in enumerate(row) if (match := _EVENT_COLUMN.match(cell))]
    if any(match["place"] for _, match in events):
        steps = tuple(dict.fromkeys(match["name"] for _, match in events))
        yield _Figure("latency", "", steps, events[0][0], events[-1][0], 1, SampleCounter())
        return
    starts = {match["name"]: column for column, match in events if match["event"] == "callback_start_timestamp"}
    for column, match in events:
        if match["event"] == "callback_end_timestamp" and match["name"] in starts:
            yield _Figure("execution", match["name"], (), starts[match["name"]], column, 1, SampleCounter())


def _hand_over(source: RecordingSource, reader: _TableReader, names: RecordedNames, figures: RecordedFigures) -> None:
    span = source.span_of(1)
    for column in reader.unread_columns:
        figures.add_unmapped(column, 1, "archgen reads no figure of this kind", span)
    for figure in reader.figures:
        try:
            element, kind, is_partial = _find_element(figure, names)
        except UnmappedError as error:
            name = " - ".join(figure.steps) if figure.steps else figure.name
            figures.add_unmapped(name, figure.samples.count, str(error), span)
            continue
        figures.add_samples(element, kind, figure.samples, span)
        if is_partial:
            figures.partial_activities.add(element)


def _find_element(figure: _Figure, names: RecordedNames) -> tuple[str, SampleKind, bool]:
    """Return the element that a figure is of, and the kind of its samples. Raise UnmappedError."""
    if figure.kind == "latency":
        return _find_chain(figure, names), "latency", False
    node_name, callback = names.split_callback_name(figure.name)
    place = names.find_only_work(node_name, callback)
    if place.stored_input:
        if figure.kind == "period":
            raise UnmappedError("how often an input is stored is no figure of the design")
        return place.stored_input, "storing", False
    return place.activity, figure.kind, place.is_partial


def _find_chain(figure: _Figure, names: RecordedNames) -> str:
    if not figure.steps:
        if figure.name in names.chain_results:
            return figure.name
        raise UnmappedError("no chain of the design has this name")
    return names.find_chain([names.name_step(step) for step in figure.steps])
