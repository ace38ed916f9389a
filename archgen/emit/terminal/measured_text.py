"""Designed against measured, for the terminal and as JSON: each figure beside the design, and the percentiles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any

from archgen.diagnostics import make_visible
from archgen.diagnostics.text_columns import TextRow, align_rows, format_section
from archgen.emit.data import timing_json
from archgen.emit.terminal.timing_text import format_figure
from archgen.timing.chains.measured_comparison import MeasuredComparison, Observation
from archgen.timing.chains.sample_statistics import PERCENTILES, SampleStatistics, UnmappedSamples
from archgen.timing.figures import figure_wording

_SHOWN_UNMAPPED = 20


def format_measured(
    comparisons: Iterable[MeasuredComparison],
    observations: Iterable[Observation] = (),
    unmapped: Sequence[UnmappedSamples] = (),
    width: int | None = None,
) -> Iterator[str]:
    """Yield designed beside measured figures, percentiles, what has no place in the design, and the outliers by name."""
    rows = list(comparisons)
    statistics = [(o.id, kind, samples) for o in observations for kind, samples in o.samples.items()]
    sampled_ids = {element for element, _, _ in statistics}
    # What has no counterpart in the design stands in the second table, if samples of it were recorded.
    shown_rows = [row for row in rows if row.verdict != "not designed" or row.why or row.id not in sampled_ids]
    if shown_rows:
        yield from align_rows([("id", "figure", "designed", "measured", ""), *map(_measured_row, shown_rows)], width)
        yield ""
    if statistics:
        heading = ("id", "of", "count", "least", *PERCENTILES, "largest")
        rows_seen = [heading, *(_statistics_row(*entry) for entry in statistics)]
        yield from format_section("What was seen of each", rows_seen, width)
    if unmapped:
        yield from _unmapped_lines(unmapped, width)
        yield ""
    yield from _outlier_lines(rows)


def _outlier_lines(rows: Sequence[MeasuredComparison]) -> Iterator[str]:
    outliers = [row for row in rows if row.verdict == "outlier"]
    figures = f"{len(rows)} figure{'s' if len(rows) != 1 else ''} measured"
    if not outliers:
        yield f"{figures}, no outliers" if rows else "nothing was measured that could be compared"
    else:
        yield f"{figures}, {len(outliers)} outlier{'s' if len(outliers) != 1 else ''}:"
        yield from (make_visible(f"  {row.id}: {row.key} {row.why}") for row in outliers)


def _measured_row(row: MeasuredComparison) -> TextRow:
    write = figure_wording.format_rate if row.key == "rate" else figure_wording.format_duration
    ratio = f" ({figure_wording.format_number(100 * row.ratio)} %)" if row.ratio is not None else ""
    mark = "OUTLIER" if row.verdict == "outlier" else row.why or row.verdict
    return row.id, row.key, format_figure(row.designed, write), write(row.measured) + ratio, mark


def _statistics_row(element: str, kind: str, samples: SampleStatistics) -> TextRow:
    # Everything in this table is rounded alike; `~` is left for percentiles that are not exact.
    about = "~" if samples.is_stepped else ""
    percentiles = (f"{about}{_round_duration(value)}" for value in samples.percentiles.values())
    ends = (_round_duration(samples.least), _round_duration(samples.largest))
    return element, kind, f"{samples.count:,}", ends[0], *percentiles, ends[1]


def _round_duration(ns: int) -> str:
    return figure_wording.format_duration(Fraction(ns)).lstrip("~")


def _unmapped_lines(unmapped: Sequence[UnmappedSamples], width: int | None) -> Iterator[str]:
    yield f"Recorded, but not counted for anything in the design: {len(unmapped)}"
    yield from align_rows([(entry.name, f"{entry.count:,}", entry.why) for entry in unmapped[:_SHOWN_UNMAPPED]], width)
    if len(unmapped) > _SHOWN_UNMAPPED:
        yield f"  and {len(unmapped) - _SHOWN_UNMAPPED} more, all of them with `--format json`"


def measured_to_json(
    comparisons: Iterable[MeasuredComparison],
    observations: Iterable[Observation] = (),
    unmapped: Iterable[UnmappedSamples] = (),
) -> dict[str, Any]:
    """Return the comparison as plain data: rates in Hz, durations in ms."""
    return {
        "version": timing_json.VERSION,
        "measured": [
            {
                "id": row.id,
                "figure": row.key,
                "designed": (timing_json.quantity_to_json if row.key == "rate" else timing_json.duration_to_json)(
                    row.designed
                ),
                "measured": float(row.measured if row.key == "rate" else row.measured / 10**6),
                "verdict": row.verdict,
                "why": row.why or None,
            }
            for row in comparisons
        ],
        "samples": [
            _statistics_to_json(observation, kind, samples)
            for observation in observations
            for kind, samples in observation.samples.items()
        ],
        "unmapped": [
            {"name": entry.name, "count": entry.count, "why": entry.why, "at": str(entry.at)} for entry in unmapped
        ],
    }


def _statistics_to_json(observation: Observation, kind: str, samples: SampleStatistics) -> dict[str, Any]:
    percentiles = {name: value / 10**6 for name, value in samples.percentiles.items()}
    return {
        "id": observation.id,
        "of": kind,
        "count": samples.count,
        "least": samples.least / 10**6,
        **percentiles,
        "largest": samples.largest / 10**6,
        "exact": not samples.is_stepped,
        "at": str(observation.at),
    }
