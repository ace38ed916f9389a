"""Read what was observed on the robot, to be compared with the design (docs/timing.md).

A file is YAML (`measured: {ID: {rate: 29.7 Hz, wcet: 41 ms}}`) or CSV with a header (`id,rate,wcet`). Ids are those of
activities or topics; every figure is a quantity with its unit.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Sequence

from archgen.diagnostics import Diagnostic, Span, did_you_mean
from archgen.model.quantity import Quantity, parse_quantity
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import MappingNode, ScalarNode
from archgen.timing.chains.measured_comparison import MEASURED_KEYS, Observation


def read_observations(file: str, text: str) -> tuple[tuple[Observation, ...], tuple[Diagnostic, ...]]:
    """Read observations from a file's text: CSV if its name ends in `.csv`, else YAML."""
    diagnostics: list[Diagnostic] = []
    rows = _read_csv(file, text, diagnostics) if file.lower().endswith(".csv") else _read_yaml(file, text, diagnostics)
    return tuple(rows), tuple(diagnostics)


def _read_yaml(file: str, text: str, diagnostics: list[Diagnostic]) -> Iterator[Observation]:
    document, yaml_diagnostics = yaml_parser.parse_yaml(file, text)
    diagnostics += yaml_diagnostics
    if document is None:
        return
    body = document.root.get("measured")
    if not isinstance(body, MappingNode):
        message = "`measured`, the mapping of what was observed, is missing"
        help_line = "write `measured: {ID: {rate: 10 Hz}}`"
        diagnostics.append(Diagnostic("missing-key", message, document.root.span, help=help_line))
        return
    for entry in body:
        if not isinstance(entry.value, MappingNode):
            diagnostics.append(_diagnose_wrong_value(f"`{entry.key}` takes a mapping of figures", entry.key_span))
            continue
        cells = [
            (e.key, e.value.text if isinstance(e.value, ScalarNode) else None, e.key_span, e.value.span)
            for e in entry.value
        ]
        yield Observation(entry.key, dict(_read_figures(cells, diagnostics)), entry.key_span)


def _read_csv(file: str, text: str, diagnostics: list[Diagnostic]) -> Iterator[Observation]:
    reader = csv.reader(io.StringIO(text), skipinitialspace=True)
    header: list[str] = []
    try:
        for row in reader:
            # The csv module tells lines but no columns, and of a row with line breaks in quotes only the last line.
            span = Span(file, reader.line_num, 1, reader.line_num, 1)
            if not any(cell.strip() for cell in row):
                continue
            if not header:
                header = [cell.strip() for cell in row]
                if header[0] != "id":
                    message = "the first line does not begin with `id`"
                    diagnostics.append(
                        Diagnostic("missing-key", message, span, help="begin with `id,rate,wcet`, for instance")
                    )
                    return
                continue
            cells = [(key, cell, span, span) for key, cell in zip(header[1:], row[1:], strict=False) if cell.strip()]
            if len(row) > len(header):
                diagnostics.append(
                    _diagnose_wrong_value(f"this line has {len(row)} cells, the first one {len(header)}", span)
                )
            yield Observation(row[0].strip(), dict(_read_figures(cells, diagnostics)), span)
    except csv.Error as error:
        diagnostics.append(Diagnostic("syntax-error", f"this is no CSV: {error}", Span.of_file(file)))


def _read_figures(
    cells: Sequence[tuple[str, str | None, Span, Span]], diagnostics: list[Diagnostic]
) -> Iterator[tuple[str, Quantity]]:
    for key, text, key_span, span in cells:
        if key not in MEASURED_KEYS:
            help_line = did_you_mean(key, MEASURED_KEYS) or f"it takes {', '.join(MEASURED_KEYS)}"
            diagnostics.append(Diagnostic("unknown-key", f"`{key}` cannot be measured", key_span, help=help_line))
            continue
        quantity = parse_quantity(text.strip(), MEASURED_KEYS[key]) if text is not None else None
        # A measured duration may be zero, below the clock's resolution; a rate or a period cannot.
        if quantity is None or (key in {"rate", "period"} and not quantity.value):
            example = "29.7 Hz" if key == "rate" else "41 ms"
            diagnostics.append(
                _diagnose_wrong_value(f"`{key}` takes a {MEASURED_KEYS[key]} with its unit, such as {example}", span)
            )
        else:
            yield key, quantity


def _diagnose_wrong_value(message: str, span: Span) -> Diagnostic:
    return Diagnostic("wrong-value", message, span)
