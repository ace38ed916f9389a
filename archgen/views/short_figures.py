"""Quantities in texts with three significant digits: 7.23 s for 7223.333 ms. What bounds from one side stays true.

The only place that decides how a shown figure is rounded: as its sign says; what was seen or is sure, down; another time without
a sign is one that nothing takes longer than, and is rounded up; all else, what `~` calls rounded, and a period behind its rate, to the nearest.
"""

from __future__ import annotations

import re
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_UP, Decimal

_UNITS = "ns|us|ms|s|Hz|kHz|MHz|B|kB|MB|GB|B/s|kB/s|MB/s|GB/s|%"
QUANTITY = re.compile(rf"(?<![\w.])([<>]= |~)?([0-9]+(?:\.[0-9]+)?) ({_UNITS})(?![\w/])")
"""A number and its unit, with the sign of a bound: the groups are sign, number and unit."""
_COMPARISON = re.compile(r"([<>])=[ \u00a0](?=[+-]?[0-9])")
_DIGITS = 3
_PERIOD_LEAD = " Hz · "
_LEAST_LEAD = re.compile(r"\b(?:took|at least) (?:~?[0-9.]+ \w+, )?$")
"""What stands before a time that was seen or is sure, and before by how much that is too long: `it took 132 ms, 72 ms longer`."""
_DURATION_UNITS = frozenset({"ns", "us", "ms", "s"})


def write_comparisons(text: str) -> str:
    """Write the signs before figures as people do: `<= 15 Hz` as `≤ 15 Hz`."""
    # Most texts have none: the pattern costs more than looking for one.
    return _COMPARISON.sub(lambda found: f"{'≤' if found[1] == '<' else '≥'} ", text) if "=" in text else text


def shorten_match(match: re.Match[str], *, is_lower: bool = False) -> tuple[str, str, str]:
    """Return sign, number and unit of a quantity with three significant digits; milliseconds from 1000 on become seconds.
    Without a sign it is at least so much where it `is_lower`, and the period of a rate that it stands behind is neither.
    """
    sign, unit, value = match[1] or "", match[3], Decimal(match[2])
    is_period = match.string.endswith(_PERIOD_LEAD, 0, match.start())
    is_least = is_lower or bool(_LEAST_LEAD.search(match.string, max(match.start() - 30, 0), match.start()))
    rounding_sign = ">" if is_least else sign or ("~" if is_period else "<" if unit in _DURATION_UNITS else "")
    if unit == "ms" and value >= 1000:  # noqa: PLR2004 - more digits than three are none that count
        value, unit = value / 1000, "s"
    return sign, round_number(value, rounding_sign), unit


def round_number(value: Decimal, sign: str = "") -> str:
    """Return a number with three significant digits, but all of those before the point.

    What is at least or at most so much (`sign`) stays true.
    """
    if not value:
        return "0"
    places = max(_DIGITS - 1 - value.adjusted(), 0)
    rounding = {">": ROUND_FLOOR, "<": ROUND_CEILING}.get(sign[:1], ROUND_HALF_UP)
    text = f"{value.quantize(Decimal(1).scaleb(-places), rounding):f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def shorten_text(text: str) -> str:
    """Return a text with its figures short, for where no other place has room for all digits: pictures and tips."""
    return "".join([short or part for part, short in split_figures(text)])


def split_figures(text: str, *, is_lower: bool = False) -> list[tuple[str, str]]:
    """Split a text into its parts, each with its shorter form: empty but for a quantity that has one. Where its figures
    are `is_lower`, those without a sign are at least so much.

    None has one where two quantities of the text would then read the same: their digits are what it is about.
    """
    quantities = [(match.span(), *_shorten(match, is_lower=is_lower)) for match in QUANTITY.finditer(text)]
    forms = {whole: short for _, whole, short in quantities}
    if len(set(forms.values())) < len(forms):
        return [(text, "")]
    parts, position = [], 0
    for (start, end), whole, short in quantities:
        if whole != short:
            parts += [(text[position:start], ""), (whole, short)]
            position = end
    return [*parts, (text[position:], "")]


def _shorten(match: re.Match[str], *, is_lower: bool) -> tuple[str, str]:
    sign, number, unit = shorten_match(match, is_lower=is_lower)
    return match[0], f"{sign}{number} {unit}"
