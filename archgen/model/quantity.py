"""Quantities: text with a unit, read exactly."""

from __future__ import annotations

import re
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache

from archgen.frozen import dataclass, field

MAX_DIGITS = 18
"""The maximal number of digits before the decimal point, and behind it."""
_QUANTITY_PATTERN = re.compile(rf"([0-9]{{1,{MAX_DIGITS}}}(?:\.[0-9]{{1,{MAX_DIGITS}}})?) ?([A-Za-z/]+)\Z", re.ASCII)
_BYTE_UNITS = {"B": 1, "kB": 10**3, "MB": 10**6, "GB": 10**9, "KiB": 2**10, "MiB": 2**20, "GiB": 2**30}
UNIT_FACTORS: dict[str, dict[str, int]] = {
    "duration": {
        "ns": 1,
        "us": 10**3,
        "ms": 10**6,
        "s": 10**9,
        "min": 60 * 10**9,
        "h": 3600 * 10**9,
    },
    "frequency": {"Hz": 1, "kHz": 1000},
    "size": _BYTE_UNITS,
    "bandwidth": {
        **{f"{prefix}bit/s": factor for prefix, factor in (("", 1), ("k", 10**3), ("M", 10**6), ("G", 10**9))},
        **{f"{unit}/s": 8 * factor for unit, factor in _BYTE_UNITS.items()},
    },
}
"""The units of each dimension as multiples of its base unit: ns, Hz, B, bit/s. Case-sensitive."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """An exact value in its dimension's base unit (ns, Hz, B or bit/s), and the text as written (`200 ms`).

    Quantities are compared by value only: `1 s` equals `1000 ms`.
    """

    value: Fraction
    text: str = field(compare=False)

    def __str__(self) -> str:
        return self.text


# The same quantities come up again and again, and in each version of a project that is compared.
@lru_cache(4096)
def parse_quantity(text: str, dimension: str) -> Quantity | None:
    """Parse `200 ms`, `0.5 kHz`, `12 kB`, `1 Gbit/s`; return None if it is not a quantity of this dimension."""
    match = _QUANTITY_PATTERN.match(text)
    if match is None:
        return None
    number, unit = match.groups()
    factor = UNIT_FACTORS[dimension].get(unit)
    return None if factor is None else Quantity(Fraction(number) * factor, f"{number} {unit}")


_SHARE_PATTERN = re.compile(r"([0-9]{1,2}(?:\.[0-9]{1,9})?) ?%\Z", re.ASCII)


def parse_share(text: str) -> Fraction | None:
    """Return a percentage below 100 %, such as `95 %`, as a fraction of 1; None for any other text."""
    matched = _SHARE_PATTERN.match(text)
    return Fraction(matched[1]) / 100 if matched else None


def write_share(share: Fraction) -> str:
    """Write a share as a percentage, always alike: `95 %`, `99.9 %`."""
    return f"{Decimal(100 * share.numerator) / share.denominator:f} %"
