"""Figures as people write them: durations, rates, shares, sizes; rounded only here, and told apart from exact ones."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

from archgen.timing.value import Value

_DURATIONS = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))
_LARGEST_MS = 10**4
_DIGITS, _MOST_DIGITS = 3, 12


@lru_cache(4096)
def duration(ns: Fraction) -> str:
    """Write a duration: milliseconds from 1 ms to 10 s, then seconds; smaller ones in their unit."""
    for factor, unit in _DURATIONS:
        if abs(ns) >= (_LARGEST_MS * 10**6 if unit == "s" else factor):
            return f"{number(ns / factor)} {unit}"
    return f"{number(ns)} ns" if ns else "0 ms"


def rate(hertz: Fraction) -> str:
    """Write a rate in Hz."""
    return f"{number(hertz)} Hz"


def share(part: Fraction) -> str:
    """Write a share in per cent."""
    tenths = round(1000 * part)
    return f"{number(Fraction(tenths, 10)) if tenths else number(100 * part)} %"


def size(count: Fraction) -> str:
    """Write a number of bytes."""
    for factor, unit in ((10**9, "GB"), (10**6, "MB"), (10**3, "kB")):
        if count >= factor:
            return f"{number(count / factor)} {unit}"
    return f"{number(count)} B"


@lru_cache(4096)
def number(value: Fraction) -> str:
    """Write a number with three digits behind the point at most, more where it is small; `~` says that it was rounded."""
    digits = _DIGITS
    while digits < _MOST_DIGITS and value and abs(value) * 10**digits < 100:  # noqa: PLR2004 - three digits that count
        digits += 1
    scaled = round(value * 10**digits)
    if scaled == 0 and value:
        return f"~{float(value):.2g}"
    whole, rest = divmod(abs(scaled), 10**digits)
    after = f"{rest:0{digits}}".rstrip("0")
    about = "" if scaled == value * 10**digits else "~"
    return about + ("-" if scaled < 0 else "") + f"{whole}" + (f".{after}" if after else "")


def listed(names: tuple[str, ...], most: int = 6) -> str:
    """Write a list of names, the rest of a long one counted."""
    shown = ", ".join(names[:most])
    return shown + (f" and {len(names) - most} more" if len(names) > most else "")


def reason(value: Value) -> str:
    """Say in a word why a figure is not known; empty where it is."""
    for word in ("overload", "unbounded", "diverged"):
        if value.value is None and any(text.split(":")[0].strip() == word for text in value.assumptions):
            return word
    return "" if value.value is not None else "unknown"


def told(value: Value, unit: str) -> str:
    """Give a figure in words: with its side where it is a bound, or why there is none."""
    if value.value is None:
        return next(iter(value.assumptions), "unknown") if value.complete else "unknown"
    text = rate(value.value) if unit == "Hz" else duration(value.value)
    return text if value.side == "exact" else f"{value.side} {text}"
