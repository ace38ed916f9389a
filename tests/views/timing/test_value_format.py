"""Exact figures in words: rounded only here, with a sign only where it says something."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.analysis import EventPace
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.views.timing import timing_tables, value_format
from archgen.views.timing.timing_lookup import make_timing_lookup as with_origins
from tests.timings import MS, analysis_of, exact


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Fraction(0), "0"),
        (Fraction(202), "202"),
        (Fraction(200, 3), "66.667"),
        (Fraction(1, 3), "0.333"),
        (Fraction(1, 30), "0.0333"),
        (Fraction(3, 10000), "0.0003"),
        (Fraction(99999, 100000), "1"),
        (Fraction(1, 2) + 1000, "1000.5"),
        (Fraction(10) ** 20, "1" + "0" * 20),
        (Fraction(-5, 2), "-2.5"),
    ],
)
def test_numbers(value: Fraction, text: str) -> None:
    assert value_format.display_number(value) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (exact(468 * MS), "468 ms"),
        (exact(50_000), "0.05 ms"),
        (exact(15_000 * MS), "15 s"),
        (TimingValue(Fraction(468 * MS), complete=False, missing=("x",)), ">= 468 ms"),
        (TimingValue(Fraction(468 * MS), complete=False, missing=("x",), side="at least"), ">= 468 ms"),
        (TimingValue(Fraction(468 * MS), side="at most"), "468 ms"),
        (TimingValue(Fraction(0), complete=False, missing=("x",)), "unknown"),
        (exact(0), "0 ms"),
        (UNKNOWN_VALUE, "unknown"),
        (TimingValue(None, assumptions=("overload",)), "no bound: the host is overloaded"),
        (TimingValue(None, assumptions=("unbounded: a is conditional",)), "unbounded"),
        (TimingValue(None, assumptions=("diverged",)), "no bound found"),
    ],
)
def test_durations(value: TimingValue, text: str) -> None:
    assert value_format.display_duration(value) == text


def test_missing_figures_are_named_with_what_is_missing() -> None:
    analysis = analysis_of({"x": (None, None), "y": (None, None), "z": (None, 5 * MS)})
    value = TimingValue(Fraction(468 * MS), complete=False, missing=("x", "y"))
    assert value_format.display_bound(value, analysis) == ">= 468 ms; no bound: execution time of x, y unknown"
    more = TimingValue(None, complete=False, missing=("x", "z"))
    assert value_format.display_bound(more, analysis) == "no bound: execution time of x and rate of z unknown"
    assert (
        value_format.describe_missing(TimingValue(None, missing=("x", "y")), analysis, 1)
        == "execution time of x and 1 more unknown"
    )


@pytest.mark.parametrize(
    ("pace", "lines", "step"),
    [
        (EventPace("periodic", exact(10), exact(100 * MS)), ("10 Hz · 100 ms",), "to_100_ms"),
        (EventPace("periodic", exact(Fraction(999, 100)), exact(101 * MS)), ("9.99 Hz · 100 ms",), "to_300_ms"),
        (EventPace("periodic", exact(100), exact(10 * MS)), ("100 Hz · 10 ms",), "to_10_ms"),
        (EventPace("periodic", exact(Fraction(1, 30)), exact(30_000 * MS)), ("0.0333 Hz · 30 s",), "slower"),
        (
            EventPace("event", TimingValue(Fraction(10), side="at most"), UNKNOWN_VALUE),
            ("<= 10 Hz", "event"),
            "to_100_ms",
        ),
        (
            EventPace("event", TimingValue(Fraction(10), complete=False), UNKNOWN_VALUE),
            (">= 10 Hz", "event"),
            "to_100_ms",
        ),
        (
            EventPace("event", TimingValue(Fraction(10004, 1000), side="at most")),
            ("<= 10.1 Hz", "event"),
            "to_100_ms",
        ),
        (EventPace("event"), ("event",), "event"),
        (EventPace("on_demand", exact(2), UNKNOWN_VALUE), ("2 Hz · 500 ms", "on demand"), "on_demand"),
        (EventPace("once", exact(0), UNKNOWN_VALUE), ("once",), "once"),
        (EventPace(None), ("?",), "unknown"),
        (None, ("?",), "unknown"),
    ],
)
def test_paces(pace: EventPace | None, lines: tuple[str, ...], step: str) -> None:
    assert value_format.format_box_lines(pace) == lines
    assert value_format.find_period_step(pace) == step


def test_an_inferred_pace_names_where_it_comes_from() -> None:
    analysis = analysis_of(
        {"lidar": (100 * MS, 1), "map": (None, 1), "plan": (None, 1), "loop": (None, 1)},
        [("lidar", "map"), ("map", "plan"), ("plan", "loop"), ("loop", "plan")],
    )
    timing_lookup = with_origins(analysis)
    assert timing_lookup.rate_origins == {"map": ("lidar",), "plan": ("lidar",), "loop": ("lidar",)}
    assert value_format.format_rate_words(analysis.paces["map"]) == "10 Hz · 100 ms, event"
    origin_runs = timing_tables.link_origins(timing_lookup, timing_lookup.rate_origins["map"])
    assert [(run.text, run.ref) for run in origin_runs] == [("lidar", "node:lidar")]
