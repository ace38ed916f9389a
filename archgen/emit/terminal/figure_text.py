"""A figure of the timing analysis in a column of the terminal, or why there is none."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue


def format_missing(value: TimingValue) -> str:
    """Return which elements' figures a value lacks."""
    return f"unknown: {figure_wording.join_first_names(value.missing)}" if value.missing and not value.complete else ""


def format_figure(value: TimingValue | None, write: Callable[[Fraction], str] = figure_wording.format_duration) -> str:
    """Format a value: `202 ms`, `>= 468 ms`, `unknown`, `unbounded (overload)`."""
    if value is None:
        return ""
    if value.value is None:
        reason = figure_wording.name_unknown_reason(value)
        return f"unbounded ({reason})" if reason == "overload" else reason
    sign = "" if value.complete else {"at least": ">= ", "at most": "<= "}.get(value.side, ">= ")
    return sign + write(value.value)
