"""Read what was observed on the robot, to be compared with the design (docs/timing.md).

A file is YAML (`measured: {ID: {rate: 29.7 Hz, wcet: 41 ms}}`) or CSV with a header (`id,rate,wcet`). Ids are those of
activities or topics; every figure is a quantity with its unit.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence

from archgen.diagnostic import Diagnostic
from archgen.model.quantity import Quantity, parse
from archgen.source import Span
from archgen.suggest import did_you_mean
from archgen.syntax import yaml
from archgen.syntax.tree import Scalar, Table
from archgen.timing.measured import KEYS, Observation


def read(file: str, text: str) -> tuple[tuple[Observation, ...], tuple[Diagnostic, ...]]:
    """Read observations from a file's text: CSV if its name ends in `.csv`, else YAML."""
    found: list[Diagnostic] = []
    rows = _csv(file, text, found) if file.lower().endswith(".csv") else _yaml(file, text, found)
    return tuple(rows), tuple(found)


def _yaml(file: str, text: str, found: list[Diagnostic]) -> Iterator[Observation]:
    document, problems = yaml.parse(file, text)
    found += problems
    if document is None:
        return
    body = document.root.get("measured")
    if not isinstance(body, Table):
        message = "`measured`, the mapping of what was observed, is missing"
        help_line = "write `measured: {ID: {rate: 10 Hz}}`"
        found.append(Diagnostic("missing-key", message, document.root.at, help=help_line))
        return
    for entry in body:
        if not isinstance(entry.value, Table):
            found.append(_wrong(f"`{entry.key}` takes a mapping of figures", entry.at))
            continue
        cells = [(e.key, e.value.text if isinstance(e.value, Scalar) else None, e.at, e.value.at) for e in entry.value]
        yield Observation(entry.key, dict(_figures(cells, found)), entry.at)


def _csv(file: str, text: str, found: list[Diagnostic]) -> Iterator[Observation]:
    reader = csv.reader(io.StringIO(text), skipinitialspace=True)
    header: list[str] = []
    try:
        for row in reader:
            # The csv module tells lines but no columns, and of a row with line breaks in quotes only the last line.
            at = Span(file, reader.line_num, 1, reader.line_num, 1)
            if not any(cell.strip() for cell in row):
                continue
            if not header:
                header = [cell.strip() for cell in row]
                if header[0] != "id":
                    message = "the first line does not begin with `id`"
                    found.append(Diagnostic("missing-key", message, at, help="begin with `id,rate,wcet`, for instance"))
                    return
                continue
            cells = [(key, cell, at, at) for key, cell in zip(header[1:], row[1:], strict=False) if cell.strip()]
            if len(row) > len(header):
                found.append(_wrong(f"this line has {len(row)} cells, the first one {len(header)}", at))
            yield Observation(row[0].strip(), dict(_figures(cells, found)), at)
    except csv.Error as error:
        found.append(Diagnostic("syntax-error", f"this is no CSV: {error}", Span.of_file(file)))


def _figures(
    cells: Sequence[tuple[str, str | None, Span, Span]], found: list[Diagnostic]
) -> Iterator[tuple[str, Quantity]]:
    for key, text, key_at, at in cells:
        if key not in KEYS:
            help_line = did_you_mean(key, KEYS) or f"it takes {', '.join(KEYS)}"
            found.append(Diagnostic("unknown-key", f"`{key}` cannot be measured", key_at, help=help_line))
            continue
        quantity = parse(text.strip(), KEYS[key]) if text is not None else None
        # A measured duration may be zero, below the clock's resolution; a rate or a period cannot.
        if quantity is None or (key in {"rate", "period"} and not quantity.value):
            example = "29.7 Hz" if key == "rate" else "41 ms"
            found.append(_wrong(f"`{key}` takes a {KEYS[key]} with its unit, such as {example}", at))
        else:
            yield key, quantity


def _wrong(message: str, at: Span) -> Diagnostic:
    return Diagnostic("wrong-value", message, at)
