"""Figures as text: exact where a few digits say all, else marked as rounded."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

from archgen.timing.value import Value

_UNITS = ((3600 * 10**9, "h"), (10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))


@lru_cache(4096)
def duration(value: Fraction | int) -> str:
    """Give a duration in ns, in the largest unit below it."""
    if not value:
        return "0 ms"
    size, unit = next((one for one in _UNITS[1:] if value >= one[0]), _UNITS[-1])
    return f"{number(Fraction(value) / size)} {unit}"


@lru_cache(4096)
def rate(value: Fraction) -> str:
    """Give a rate."""
    return f"{number(value)} Hz"


def number(value: Fraction) -> str:
    """Give up to three decimals, or more where the figure is small; `~` says that it was rounded."""
    digits = 3
    while digits < 12 and value and abs(value) * 10**digits < 100:  # noqa: PLR2004
        digits += 1
    scaled = round(value * 10**digits)
    text = f"{scaled // 10**digits}.{scaled % 10**digits:0{digits}d}".rstrip("0").rstrip(".")
    return text if Fraction(scaled, 10**digits) == value else f"~{text}"


def told(value: Value, unit: str) -> str:
    """Give a figure in words: with its side where it is a bound, or why there is none."""
    if value.value is None:
        return next(iter(value.assumptions), "unknown") if value.complete else "unknown"
    text = rate(value.value) if unit == "Hz" else duration(value.value)
    return text if value.side == "exact" else f"{value.side} {text}"
