"""A reader with a pocket calculator: recomputes every equation that a text prints, and knows nothing else."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple

_UNITS = {
    "ns": Fraction(1), "us": Fraction(10**3), "ms": Fraction(10**6), "s": Fraction(10**9),
    "Hz": Fraction(1, 10**9), "%": Fraction(1, 100),
    "B": Fraction(1), "kB": Fraction(10**3), "MB": Fraction(10**6),
    "B/s": Fraction(1, 10**9), "kB/s": Fraction(1, 10**6), "MB/s": Fraction(1, 10**3),
}  # fmt: skip
"""In ns and bytes."""
_TOKEN = re.compile(
    r"(?P<figure>~?\d+(?:\.\d+)? (?:ns|us|ms|s|Hz|%|kB/s|MB/s|B/s|kB|MB|B)(?![\w/]))"
    r"|(?P<number>~?\d+(?:\.\d+)?(?![\w.]))|(?P<function>(?:ceil|floor|min|max)(?=\())|(?P<sign>[-+(),]|[/x](?= ))"
    r"|(?P<equals><?=)|(?P<word>\S+\[[^]]*\]|\S+ stores \S+?(?=[,:;)]?(?:\s|$))"
    r"|\S+?(?=[,:;)]*(?:\s|$)))|(?P<stop>[:;])"
)


class Equation(NamedTuple):
    """What stands left of an equals sign, computed, and what is printed right of it; in ns and bytes."""

    computed: Fraction
    printed: Fraction
    is_rounded: bool

    @property
    def holds(self) -> bool:
        """Whether both sides are equal, as exactly as they are written."""
        if not self.is_rounded:
            return self.computed == self.printed
        return abs(self.computed - self.printed) <= max(abs(self.printed) / 1000, Fraction(1, 2000))


def read_equations(text: str) -> Iterator[Equation]:
    """Yield the equations of a line."""
    tokens = [(str(token.lastgroup), token[0]) for token in _TOKEN.finditer(text)]
    for at, (kind, value) in enumerate(tokens):
        if kind != "equals" or value != "=":
            continue
        right = next((each for each in tokens[at + 1 : at + 3] if each[0] in {"figure", "number"}), None)
        left = _collect_left(tokens[:at])
        if right and left:
            terms = " ".join(_write_term(*each) for each in left)
            is_rounded = "~" in text or "%" in right[1]
            slack = Fraction(1, 10**6) if is_rounded else Fraction(0)
            names = {
                "F": Fraction,
                "min": min,
                "max": max,
                "ceil": lambda part, slack=slack: math.ceil(part - slack),
                "floor": lambda part, slack=slack: math.floor(part + slack),
            }
            computed = Fraction(eval(terms, {"__builtins__": {}}, names))  # noqa: S307 - digits, signs and four functions
            yield Equation(computed, Fraction(eval(_write_term(*right), {"__builtins__": {}}, names)), is_rounded)  # noqa: S307


def _collect_left(tokens: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the formula that ends with the last token; words after a figure only name it."""
    depth, left = 0, list[tuple[str, str]]()
    for at in range(len(tokens) - 1, -1, -1):
        kind, value = tokens[at]
        if kind == "word":
            if at and tokens[at - 1][0] in {"figure", "number"}:
                continue
            break
        if kind in {"equals", "stop"} or (value == "," and not depth):
            break
        depth += {")": 1, "(": -1}.get(value, 0)
        left.insert(0, (kind, value))
    return left


def _write_term(kind: str, value: str) -> str:
    if kind in {"figure", "number"}:
        number, _, unit = value.removeprefix("~").partition(" ")
        return f"F('{Fraction(number) * _UNITS.get(unit, Fraction(1))}')"
    return "*" if value == "x" else value
