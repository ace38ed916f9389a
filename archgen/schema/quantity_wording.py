"""Word what is wrong with a quantity: its number, its unit, or both."""

from __future__ import annotations

import re
from typing import Any

from archgen.diagnostics import find_closest
from archgen.model import quantity

# A sign, digits with a point or a comma, and whatever follows them as the unit.
_QUANTITY_PATTERN = re.compile(r"\s*+([-+]?)\s*+([0-9]++(?:[.,][0-9]++)?)\s*+(\S*+)\s*+\Z", re.ASCII)


_UNIT_SPELLINGS = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "msec": "ms", "msecs": "ms", "usec": "us", "µs": "us",
    "μs": "us", "nsec": "ns", "m": "min", "mins": "min", "minutes": "min", "hour": "h", "hours": "h", "fps": "Hz",
    "bps": "bit/s", "kbps": "kbit/s", "Mbps": "Mbit/s", "mbps": "Mbit/s", "Gbps": "Gbit/s", "gbps": "Gbit/s",
    "hertz": "Hz", "millisecond": "ms", "milliseconds": "ms", "microseconds": "us", "nanoseconds": "ns",
    "kilobytes": "kB", "megabytes": "MB", "gigabytes": "GB", "Mb/s": "Mbit/s", "Gb/s": "Gbit/s", "kb/s": "kbit/s", "b/s": "bit/s", "bytes": "B", "byte": "B",
}  # fmt: skip


_MIN_SPELLING = 4
"""The letters of a word from which on a slip in it may be guessed: of shorter ones each slip is another unit."""
_LIKELY_UNITS = {"duration": ("s", "ms"), "frequency": ("Hz",), "size": ("B", "kB"), "bandwidth": ("bit/s", "Mbit/s")}
"""What a number alone may be meant in. ROS writes durations in seconds, and most people theirs in milliseconds: only who
wrote the number knows, and a thousandth of a time is met by every deadline."""


def find_dimension(schema_part: dict[str, Any]) -> str | None:
    """Return the dimension of a quantity, or None for other values.

    The schema has no field for it: the second word of its `patternErrorMessage` ("a duration is ...") decides.
    """
    message_words = str(schema_part.get("patternErrorMessage", "")).split(" ")
    return _DIMENSION_WORDS.get(message_words[1]) if message_words[1:] else None


_DIMENSION_WORDS = {"duration": "duration", "rate": "frequency", "size": "size", "bandwidth": "bandwidth"}


def describe_wrong_quantity(name: str, text: str, dimension: str, schema_part: dict[str, Any]) -> tuple[str, str]:
    """Return what is wrong with a quantity, and what helps."""
    explanation = str(schema_part["patternErrorMessage"])
    match = _QUANTITY_PATTERN.match(text)
    if match is None:
        return f"{name} cannot be `{clip_text(text)}`", explanation
    sign, number, unit = match.groups()
    if sign == "-":
        return f"{name} cannot be negative", explanation
    number = number.replace(",", ".")
    if not unit:
        choices = " or ".join(f"`{number} {likely}`" for likely in _LIKELY_UNITS[dimension])
        likely_help = f"write {choices}, whichever is meant" if " or " in choices else f"write {choices}"
        return f"`{clip_text(text)}` has no unit", f"{likely_help}; {explanation}"
    if unit in quantity.UNIT_FACTORS[dimension]:
        if max(map(len, number.split("."))) > quantity.MAX_DIGITS:
            return f"{name} has too many digits", f"at most {quantity.MAX_DIGITS} are read before and after the point"
        return f"{name} cannot be `{clip_text(text)}`", f"write `{number} {unit}`"
    return _describe_wrong_unit(name, number, unit, dimension, explanation)


def _describe_wrong_unit(name: str, number: str, unit: str, dimension: str, explanation: str) -> tuple[str, str]:
    better_unit, message = _suggest_unit(unit, dimension), f"{name} has no unit `{clip_text(unit)}`"
    other_key = _OTHER_KEY.get((name.strip("`"), unit))
    if other_key:
        return message, f"write `{other_key}: {number} {unit}`"
    if dimension in {"size", "bandwidth"} and better_unit and unit.lower() == better_unit.lower():
        return message, f"write `{number} {better_unit}`; case counts: kB is 1000 bytes, KiB is 1024"
    return message, f"write `{number} {better_unit}`; case counts" if better_unit else explanation


_OTHER_KEY = {("rate", unit): "period" for unit in quantity.UNIT_FACTORS["duration"]} | {
    ("period", unit): "rate" for unit in quantity.UNIT_FACTORS["frequency"]
}
"""The key that was meant where somebody writes `rate: 20 ms` or `period: 50 Hz`, by key and unit."""


def _suggest_unit(unit: str, dimension: str) -> str | None:
    units = quantity.UNIT_FACTORS[dimension]
    # A known other spelling first, then the case: `MS` may be meant as ms, and `mbps` is nothing but a spelling.
    spelled_unit = _UNIT_SPELLINGS.get(unit) or _UNIT_SPELLINGS.get(unit.lower())
    if spelled_unit in units:
        return spelled_unit
    folded_units = [known_unit for known_unit in units if known_unit.lower() == unit.lower()]
    if folded_units or len(unit) < _MIN_SPELLING:
        return folded_units[0] if folded_units else None
    word = find_closest(
        unit,
        [word for word, known_unit in _UNIT_SPELLINGS.items() if known_unit in units and len(word) >= _MIN_SPELLING],
    )
    return _UNIT_SPELLINGS[word] if word else None


_MAX_QUOTED_LENGTH = 60


def clip_text(text: str) -> str:
    """Return a text on one line, clipped so that a message stays readable."""
    line = " ".join(text.split())
    return line if len(line) <= _MAX_QUOTED_LENGTH else f"{line[: _MAX_QUOTED_LENGTH - 3]}..."
