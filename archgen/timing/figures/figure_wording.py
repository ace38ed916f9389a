"""Figures as people write them: durations, rates, shares, sizes. Only this module rounds; `~` marks rounding."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache
from math import ceil, floor

from archgen.timing.figures.timing_values import TimingValue

_DURATION_UNITS = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))
_MAX_SHOWN_MS = 10**4
"""Durations below this many ms are written in ms, above in s."""
_DECIMALS, _MAX_DECIMALS = 3, 12
_CARRIED_DIGITS = 3
"""The digits of a compared figure: what it follows from is rarely known better."""
_MAX_WRITTEN_DECIMALS = 18
"""The most decimals that are read again."""


@lru_cache(4096)
def format_duration(ns: Fraction) -> str:
    """Write a duration (ns): in ms from 1 ms to 10 s, then in s; smaller ones in us or ns."""
    for factor, unit in _DURATION_UNITS:
        if abs(ns) >= (_MAX_SHOWN_MS * 10**6 if unit == "s" else factor):
            return f"{format_number(ns / factor)} {unit}"
    return f"{format_number(ns)} ns" if ns else "0 ms"


def write_exact_duration(ns: Fraction) -> str:
    """Write a duration (ns) as files have it: exact where it is a decimal fraction."""
    factor, unit = next(((factor, unit) for factor, unit in _DURATION_UNITS[1:] if abs(ns) >= factor), (1, "ns"))
    scaled, decimals = ns / factor, 0
    while scaled.denominator != 1 and decimals < _MAX_WRITTEN_DECIMALS:
        scaled, decimals = scaled * 10, decimals + 1
    digits = f"{int(scaled):0{decimals + 1}}"
    return f"{digits[: len(digits) - decimals]}{'.' if decimals else ''}{digits[len(digits) - decimals :]} {unit}"


def format_rate(hertz: Fraction) -> str:
    """Write a rate in Hz."""
    return f"{format_number(hertz)} Hz"


def format_share(fraction: Fraction) -> str:
    """Write a fraction in per cent."""
    tenths = round(1000 * fraction)
    return f"{format_number(Fraction(tenths, 10)) if tenths else format_number(100 * fraction)} %"


def format_size(byte_count: Fraction) -> str:
    """Write a number of bytes."""
    for factor, unit in ((10**9, "GB"), (10**6, "MB"), (10**3, "kB")):
        if byte_count >= factor:
            return f"{format_number(byte_count / factor)} {unit}"
    return f"{format_number(byte_count)} B"


@lru_cache(4096)
def format_number(value: Fraction) -> str:
    """Write a number with at most three decimals, more where it is small; `~` says that it was rounded."""
    # Small numbers get decimals until three significant digits are shown, so that 0.00042 does not become 0.
    decimals = _DECIMALS
    while decimals < _MAX_DECIMALS and value and abs(value) * 10**decimals < 100:  # noqa: PLR2004 - three digits that count
        decimals += 1
    scaled = round(value * 10**decimals)
    if scaled == 0 and value:
        return f"~{float(value):.2g}"
    integer_part, remainder = divmod(abs(scaled), 10**decimals)
    decimal_text = f"{remainder:0{decimals}}".rstrip("0")
    rounding_mark = "" if scaled == value * 10**decimals else "~"
    return (
        rounding_mark + ("-" if scaled < 0 else "") + f"{integer_part}" + (f".{decimal_text}" if decimal_text else "")
    )


def format_compared(
    values: Sequence[Fraction], write: Callable[[Fraction], str], *, upwards: bool = True, limit: Fraction | None = None
) -> list[str]:
    """Write figures that are compared, rounded by `round_compared`; `~` marks rounding."""
    rounded = round_compared(values, upwards=upwards, limit=limit)
    marks = ("" if new == old else "~" for old, new in zip(values, rounded, strict=True))
    return [f"{mark}{write(value).removeprefix('~')}" for mark, value in zip(marks, rounded, strict=True)]


def format_compared_bounds(bounds: Sequence[TimingValue], limit: Fraction | None = None) -> list[str]:
    """Write bounds of durations (ns) that are compared, each rounded so that it stays true: `at least ~269 ms`, `~271 ms`;
    of those without a figure the reason.
    """
    texts = {}
    for is_complete in (True, False):
        values = [each.value for each in bounds if each.value is not None and each.complete is is_complete]
        texts[is_complete] = iter(format_compared(values, format_duration, upwards=is_complete, limit=limit))
    return [
        name_unknown_reason(each) or f"{'' if each.complete else 'at least '}{next(texts[each.complete])}"
        for each in bounds
    ]


def round_compared(
    values: Sequence[Fraction], *, upwards: bool = True, limit: Fraction | None = None
) -> list[Fraction]:
    """Round figures that are compared to the digits that inputs carry: three, or as many as tell them apart, and from a
    limit. Bounds are rounded to the safe side: durations up, rates down.
    """
    others = [] if limit is None else [limit]
    for digits in range(_CARRIED_DIGITS, _MAX_WRITTEN_DECIMALS):
        rounded = [_round_digits(value, digits, upwards=upwards) for value in values]
        pairs = list(zip([*values, *others], [*rounded, *others], strict=True))
        if all((a < b, a > b) == (c < d, c > d) for a, c in pairs for b, d in pairs):
            return rounded
    return list(values)


def _round_digits(value: Fraction, digits: int, *, upwards: bool) -> Fraction:
    """Round to so many digits that count, up or down."""
    step, size = Fraction(1), abs(value)
    while size >= step * 10**digits:
        step *= 10
    while size and size < step * 10 ** (digits - 1):
        step /= 10
    return step * (ceil if upwards else floor)(value / step)


_UNKNOWN_REASONS = {"overload": "overload", "unbounded": "unbounded", "diverged": "no bound found"}
"""Words for a figure that is unknown though all figures are there, by the assumption that explains it."""


def name_unknown_reason(value: TimingValue) -> str:
    """Return why a figure is unknown: `overload`, `unbounded`, `no bound found` or `unknown`; empty if it is known."""
    for word, reason in _UNKNOWN_REASONS.items():
        if value.value is None and any(assumption.split(":")[0].strip() == word for assumption in value.assumptions):
            return reason
    return "" if value.value is not None else "unknown"


def describe_timing_value(value: TimingValue, unit: str) -> str:
    """Write a figure with its side where it is a bound, or why there is none. The unit is "Hz" or "ns"."""
    if value.value is None:
        word = next(iter(value.assumptions), "unknown") if value.complete else "unknown"
        return _UNKNOWN_REASONS.get(word, word)
    text = format_rate(value.value) if unit == "Hz" else format_duration(value.value)
    return text if value.side == "exact" else f"{value.side} {text}"
