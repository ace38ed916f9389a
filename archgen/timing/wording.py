"""Figures as people write them: durations, rates, shares, sizes. Only this module rounds; `~` marks rounding."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

from archgen.timing.value import Value

_DURATIONS = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))
_LARGEST_MS = 10**4
"""Durations below this many ms are written in ms, above in s."""
_DIGITS, _MOST_DIGITS = 3, 12


@lru_cache(4096)
def duration(ns: Fraction) -> str:
    """Write a duration (ns): in ms from 1 ms to 10 s, then in s; smaller ones in us or ns."""
    for factor, unit in _DURATIONS:
        if abs(ns) >= (_LARGEST_MS * 10**6 if unit == "s" else factor):
            return f"{number(ns / factor)} {unit}"
    return f"{number(ns)} ns" if ns else "0 ms"


def rate(hertz: Fraction) -> str:
    """Write a rate in Hz."""
    return f"{number(hertz)} Hz"


def share(part: Fraction) -> str:
    """Write a fraction in per cent."""
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
    """Write a number with at most three decimals, more where it is small; `~` says that it was rounded."""
    # Small numbers get decimals until three significant digits are shown, so that 0.00042 does not become 0.
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
    """Write the first names separated by commas, and count the others."""
    shown = ", ".join(names[:most])
    return shown + (f" and {len(names) - most} more" if len(names) > most else "")


def reason(value: Value) -> str:
    """Return why a figure is unknown: `overload`, `unbounded`, `diverged` or `unknown`; empty if it is known."""
    for word in ("overload", "unbounded", "diverged"):
        if value.value is None and any(text.split(":")[0].strip() == word for text in value.assumptions):
            return word
    return "" if value.value is not None else "unknown"


def told(value: Value, unit: str) -> str:
    """Write a figure with its side where it is a bound, or why there is none. The unit is "Hz" or "ns"."""
    if value.value is None:
        return next(iter(value.assumptions), "unknown") if value.complete else "unknown"
    text = rate(value.value) if unit == "Hz" else duration(value.value)
    return text if value.side == "exact" else f"{value.side} {text}"
