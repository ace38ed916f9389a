"""Figures as people write them: durations, rates, shares, sizes; rounded only here, and told apart from exact ones."""

from __future__ import annotations

from fractions import Fraction

from archgen.timing.value import Value

_DURATIONS = ((3600 * 10**9, "h"), (60 * 10**9, "min"), (10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))
_LARGEST_MS = 10**4
_DIGITS = 3


def duration(ns: Fraction) -> str:
    """Write a duration: milliseconds from 1 ms to 10 s, then seconds; smaller ones in their unit."""
    for factor, unit in _DURATIONS[2:]:
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


def number(value: Fraction) -> str:
    """Write a number with three digits behind the point at most, none that is not needed; `~` where it was rounded."""
    scaled = round(value * 10**_DIGITS)
    if scaled == 0 and value:
        return f"~{float(value):.2g}"
    whole, rest = divmod(abs(scaled), 10**_DIGITS)
    digits = f"{rest:0{_DIGITS}}".rstrip("0")
    about = "" if scaled == value * 10**_DIGITS else "~"
    return about + ("-" if scaled < 0 else "") + f"{whole}" + (f".{digits}" if digits else "")


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
