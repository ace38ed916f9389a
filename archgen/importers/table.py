"""Import tables of components and connections as plain data of the language.

Two shapes are read, in one table or in several: a row for each component (its group, what it does, its inputs and
outputs), and a row for each connection (from, to, what flows). A table below another one has headings of its own.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

from archgen.diagnostic import Diagnostic, Severity
from archgen.importers import cells, columns, connections, declare, finish, nodes, ports, rows
from archgen.importers.cells import Row
from archgen.importers.columns import Headings
from archgen.importers.draft import Draft
from archgen.importers.rows import Record
from archgen.source import Sources, Span


@dataclass(frozen=True, slots=True)
class Imported:
    """What was imported: `data` by the language's sections (empty where nothing could be imported), and diagnostics."""

    data: Mapping[str, Any]
    diagnostics: tuple[Diagnostic, ...]
    sources: Sources


def read(files: Sequence[tuple[str, bytes]], distro: str | None) -> Imported:
    """Import tables given as (name, bytes). Messages are looked up for the distribution."""
    draft, sources = Draft(), Sources()
    records: list[Record] = []
    for name, data in files:
        text, found = cells.decode(name, data)
        draft.diagnostics.extend(found)
        sources.add(name, text)
        if text:
            records += _records(draft, name, text)
    _take(draft, records)
    broken = any(d.severity is Severity.ERROR for d in draft.diagnostics)
    made = {} if broken else finish.data(draft, distro)
    if not made and not broken:
        whole = Span.of_file(files[0][0])
        help_line = "a row names a component, or connects two"
        empty = Diagnostic("missing-key", "no row names a component", whole, Severity.ERROR, help=help_line)
        draft.diagnostics.append(empty)
    # In the order in which the files were given, then by place: the passes found them in another order.
    ordered = sorted(draft.diagnostics, key=lambda d: ([n for n, _ in files].index(d.span.file), d.key[1:]))
    return Imported(made, tuple(ordered), sources)


def _take(draft: Draft, records: Sequence[Record]) -> None:
    """Import records in passes: declarations first, so that connections may name elements declared below them."""
    for record in records:
        declare.declare(draft, record)
    # A table of connections alone declares no component: then each name is new, and none is a slip.
    draft.complete = any(draft.components())
    for record in records:
        ports.outputs(draft, record)
    for record in records:
        connections.connect(draft, record)
    for record in records:
        ports.inputs(draft, record)
    for record in records:
        nodes.take(draft, record)


def _records(draft: Draft, name: str, text: str) -> list[Record]:
    """Return the rows below headings."""
    given, text = cells.separator(text)
    try:
        found: list[Diagnostic] = []
        mark = given or _mark(name, text)
        table = list(cells.rows(name, text, mark, found))
    except cells.TooLargeError as error:
        draft.diagnostics.append(error.diagnostic)
        return []
    draft.diagnostics.extend(found)
    made = list(_below_headings(draft, table))
    if not made and not any(map(columns.headings, table)):
        message = "no row has headings that archgen knows"
        help_line = "name the columns: Group, Component, Description, Inputs, Outputs; or From, Output, To, Input, Type"
        draft.diagnostics.append(Diagnostic("missing-key", message, Span.of_file(name), Severity.ERROR, help=help_line))
    return made


def _mark(name: str, text: str) -> str:
    """Guess the separator: the one with which most headings are recognised in the first rows, else the one with most
    cells.
    """
    # The first 50 rows decide, and they may be long: a cut keeps four trial parses cheap.
    start = text[:100_000]

    def weight(mark: str) -> tuple[int, int]:
        table: list[Row] = []
        with contextlib.suppress(cells.TooLargeError):
            table.extend(islice(cells.rows(name, start, mark, []), 50))
        known = (columns.headings(row) for row in table)
        return max((len(found.keys) for found in known if found), default=0), max(map(len, table), default=0)

    return max(",;\t|", key=weight)


def _below_headings(draft: Draft, table: Sequence[Row]) -> Iterator[Record]:
    """Yield the records below each row of headings, and report what is lost."""
    heads: Headings | None = None
    above: dict[str, Any] = {}
    lost: dict[int, int] = {}
    for row in table:
        # Later headings must be complete, else a row of data could be taken for headings.
        new = columns.headings(row) if heads is None else columns.again(row)
        if new:
            _say_unknown(draft, heads, lost)
            heads, above, lost = new, {}, {}
        elif heads is None:
            _say_row(draft, row, "stands above the headings")
        else:
            for column in row:
                if column not in heads.keys:
                    lost[column] = lost.get(column, 0) + 1
                    if column not in heads.unknown and not heads.kind:
                        cell = row[column]
                        draft.say(
                            "unknown-key",
                            "this cell stands below no heading and was not taken",
                            cell.at,
                            "give its column a heading",
                        )
            record = rows.record(heads, row, above)
            if record:
                yield record
            else:
                _say_row(draft, row, "says nothing below headings that archgen knows")
    _say_unknown(draft, heads, lost)


def _say_row(draft: Draft, row: Row, why: str) -> None:
    first = row[min(row)]
    draft.say(
        "wrong-value", f"this row {why} and was not taken", first.at, "if it matters, put it below known headings"
    )


def _say_unknown(draft: Draft, heads: Headings | None, lost: Mapping[int, int]) -> None:
    """Report once for each column that its cells were not imported."""
    for column, cell in heads.unknown.items() if heads else ():
        count = lost.get(column, 0)
        if count:
            many = f"{count} cells below it were" if count > 1 else "the cell below it was"
            help_line = "rename the column if it is one of: " + ", ".join(dict.fromkeys(columns.MEANING.values()))
            draft.say(
                "unknown-key",
                f"the column `{cell.line}` is not known, or is the second of its kind: {many} not taken",
                cell.at,
                help_line,
            )
