"""Designed against measured: figures observed on the running robot, beside what follows from the design.

A file is YAML (`measured: {ID: {rate: 29.7 Hz, wcet: 41 ms}}`) or CSV with a header (`id,rate,wcet`). Ids are activities
or topics; every figure is a quantity with its unit. docs/timing.md tells it to users.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from archgen.diagnostic import Diagnostic
from archgen.model.quantity import Quantity, parse
from archgen.source import Span
from archgen.suggest import did_you_mean
from archgen.syntax import yaml
from archgen.syntax.tree import Scalar, Table
from archgen.timing.analysis import Analysis, Pace
from archgen.timing.sums import known
from archgen.timing.value import UNKNOWN, Value

KEYS = {
    "rate": "frequency",
    "period": "duration",
    "min_period": "duration",
    "max_period": "duration",
    "bcet": "duration",
    "wcet": "duration",
    "response": "duration",
}
"""What can be observed, and its dimension. Periods are gaps between two messages or activations: mean, least, largest."""
TOLERANCE = Fraction(1, 10)
"""A measured mean rate may differ by this share before it is an outlier."""

_BROKEN_ABOVE = {
    "max_period": "gaps are larger than the bounds rest on",
    "wcet": "takes longer than the design says",
    "response": "the bound on the response time does not hold",
}
_BROKEN_BELOW = {
    "min_period": "they come closer than the bounds rest on",
    "bcet": "is quicker than the design says: jitter grows",
}


@dataclass(frozen=True, slots=True)
class Observation:
    """What was observed of one activity or topic."""

    id: str
    figures: Mapping[str, Quantity]
    at: Span


@dataclass(frozen=True, slots=True)
class Comparison:
    """One figure, designed and measured. `verdict` says whether the design holds; `why` what it means where not."""

    id: str
    key: str
    designed: Value
    measured: Fraction
    verdict: Literal["as designed", "outlier", "not designed"]
    why: str = ""

    @property
    def ratio(self) -> Fraction | None:
        """Give measured by designed."""
        return self.measured / self.designed.value if self.designed.value else None


def read(file: str, text: str) -> tuple[tuple[Observation, ...], tuple[Diagnostic, ...]]:
    """Read observations, YAML or, where the file is called `.csv`, CSV."""
    found: list[Diagnostic] = []
    rows = _csv(file, text, found) if file.lower().endswith(".csv") else _yaml(file, text, found)
    return tuple(rows), tuple(found)


def compare(
    analysis: Analysis, observed: tuple[Observation, ...]
) -> tuple[tuple[Comparison, ...], tuple[Diagnostic, ...]]:
    """Hold observations against the design; ids that the design does not have are findings."""
    made: list[Comparison] = []
    found: list[Diagnostic] = []
    topics = {arc.topic: (arc.source, arc.output) for arc in analysis.system.arcs}
    for each in observed:
        topic = each.id in topics
        if not topic and each.id not in analysis.system.activities:
            found.append(_unknown(each, [*analysis.system.activities, *topics]))
            continue
        pace = analysis.outputs.get(topics[each.id]) if topic else analysis.paces.get(each.id)
        for key, quantity in each.figures.items():
            made.append(_compared(analysis, each.id, key, quantity.value, pace))
    return tuple(made), tuple(found)


def _compared(analysis: Analysis, name: str, key: str, measured: Fraction, pace: Pace | None) -> Comparison:
    if key in {"rate", "period"}:
        return _paced(name, key, measured, pace)
    activity, response = analysis.system.activities.get(name), analysis.responses.get(name)
    if key == "max_period":
        designed = pace.gap if pace else UNKNOWN
    elif key == "min_period":
        designed = pace.distance if pace else UNKNOWN
    elif key == "response":
        designed = response.worst if response else UNKNOWN
    else:
        ticks = (activity.wcet if key == "wcet" else activity.bcet) if activity else None
        designed = Value(ticks * analysis.system.tick) if ticks is not None else UNKNOWN
    return _bounded(name, key, designed, measured)


def _paced(name: str, key: str, measured: Fraction, pace: Pace | None) -> Comparison:
    rate = designed = pace.rate if pace else UNKNOWN
    if key == "period":
        designed = Value(10**9 / rate.value, rate.complete) if rate.value else UNKNOWN
    if designed.value is None:
        return Comparison(name, key, designed, measured, "not designed")
    off = abs(measured - designed.value) > TOLERANCE * designed.value
    slower = (measured < designed.value) is (key == "rate")
    why = f"{'slower' if slower else 'faster'} than designed by more than {int(100 * TOLERANCE)} %" if off else ""
    return Comparison(name, key, designed, measured, "outlier" if off else "as designed", why)


def _bounded(name: str, key: str, designed: Value, measured: Fraction) -> Comparison:
    above = key in _BROKEN_ABOVE
    if designed.value is None or not known(designed, "at most" if above else "at least"):
        return Comparison(name, key, designed, measured, "not designed")
    broken = measured > designed.value if above else measured < designed.value
    why = {**_BROKEN_ABOVE, **_BROKEN_BELOW}[key] if broken else ""
    return Comparison(name, key, designed, measured, "outlier" if broken else "as designed", why)


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
        if quantity is None or (key in {"rate", "period"} and not quantity.value):
            example = "29.7 Hz" if key == "rate" else "41 ms"
            found.append(_wrong(f"`{key}` takes a {KEYS[key]} with its unit, such as {example}", at))
        else:
            yield key, quantity


def _wrong(message: str, at: Span) -> Diagnostic:
    return Diagnostic("wrong-value", message, at)


def _unknown(each: Observation, known_ids: list[str]) -> Diagnostic:
    message = f"no node, activity or topic is called `{each.id}`"
    return Diagnostic("unknown-reference", message, each.at, help=did_you_mean(each.id, known_ids))
