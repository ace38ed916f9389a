"""Figures as short texts, so that a test can hold all of one beside what is expected."""

from __future__ import annotations

from archgen.timing.figures.timing_values import TimingValue

MS = 10**6
_SIDES = {"exact": "", "at least": ">= ", "at most": "<= "}


def show(value: TimingValue, unit: int = 1) -> str:
    """Return a figure in a unit, with its side, what is missing of it, and what it assumes: `>= 3 ?a [assumed]`."""
    figure = "none" if value.value is None else str(value.value / unit)
    missing = f" ?{','.join(value.missing)}" if value.missing or not value.complete else ""
    assumptions = f" [{'; '.join(value.assumptions)}]" if value.assumptions else ""
    return f"{_SIDES[value.side]}{figure}{missing}{assumptions}"


def show_ms(value: TimingValue) -> str:
    """Return a duration in ms."""
    return show(value, MS)
