"""Exact figures in human units: what is known, from which side it bounds, and what stands in the way of more."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

from archgen.timing.analysis import Analysis
from archgen.timing.value import Value

_SIDES = {"exact": "", "at least": ">= ", "at most": "<= "}
_SIZES = ((10**9, "GB"), (10**6, "MB"), (10**3, "kB"), (1, "B"))
_LONG = 10 * 10**9
_NAMED = 3
_DIGITS = 3
UNKNOWN = "unknown"
_ENDLESS = {
    "overload": "no bound: the host is overloaded",
    "unbounded": "no bound",
    "diverged": "no bound: the search for one did not end",
}
"""What an assumption says of a figure that is not there."""


def number(value: Fraction, decimals: int = _DIGITS) -> str:
    """Write a number with at most so many decimals, below one with so many significant digits, rounded half up."""
    if not value:
        return "0"
    exact = Decimal(value.numerator) / Decimal(value.denominator)
    places = decimals if abs(value) >= 1 else decimals - 1 - exact.adjusted()
    rounded = exact.quantize(Decimal(1).scaleb(-places), ROUND_HALF_UP)
    text = f"{rounded:f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def duration(value: Value) -> str:
    """Write the upper bound of a duration (given in ns) in ms, from ten seconds on in s.

    A bound says itself that it holds from above; only a sum with gaps has a sign, since it is no bound at all.
    """
    partial = not value.complete and value.side != "at most"
    return _written(replace(value, side="at least" if partial else "exact", complete=not partial), _time)


def least(value: Value) -> str:
    """Write the lower bound of a duration."""
    return _written(Value(value.value, assumptions=value.assumptions), _time)


def _time(found: Fraction) -> str:
    return f"{number(found / 10**6)} ms" if found < _LONG else f"{number(found / 10**9)} s"


def rate(value: Value) -> str:
    """Write a rate in Hz."""
    return _written(value, lambda found: f"{number(found)} Hz")


def share(value: Value) -> str:
    """Write a share of a whole in percent."""
    return _written(value, lambda found: f"{number(found * 100, 1)} %")


def amount(value: Value) -> str:
    """Write a number of bytes in the largest unit that leaves at least one."""
    return _written(value, _size)


def traffic(value: Value) -> str:
    """Write bytes for each second in the largest unit that leaves at least one."""
    return _written(value, lambda found: f"{_size(found)}/s")


def _size(found: Fraction) -> str:
    factor, unit = next(((factor, unit) for factor, unit in _SIZES if found >= factor), (1, "B"))
    return f"{number(found / factor)} {unit}"


def side(value: Value) -> str:
    """Give the sign that stands before a figure that bounds from one side: a sum with gaps is at least what is known."""
    if value.side == "exact" and not value.complete:
        return ">= "
    return _SIDES[value.side]


def _written(value: Value, write: Callable[[Fraction], str]) -> str:
    if value.value is None:
        words = (text.partition(":")[0].strip() for text in value.assumptions)
        return next((_ENDLESS[word] for word in words if word in _ENDLESS), UNKNOWN)
    if not value.value and side(value) == ">= ":
        return UNKNOWN  # at least zero says nothing, and a zero would look as if somebody had written it
    return side(value) + write(value.value)


def period(value: Value) -> str:
    """Write the period of a rate (given in Hz) in ms; a rate that is at most so high has at least this period."""
    if not value.value:
        return ""
    turned = {"at least": "<= ", "at most": ">= "}.get(side(value) and _side(value), "")
    return turned + _time(10**9 / value.value)


def _side(value: Value) -> str:
    return "at least" if side(value) == ">= " else "at most"


def whole(value: Value, analysis: Analysis) -> str:
    """Write a duration with what is missing for a bound: `>= 468 ms; no bound: execution time of x, y unknown`."""
    said = missing(value, analysis)
    text = duration(value)
    if not said:
        return text
    return f"no bound: {said}" if value.value is None else f"{text}; no bound: {said}"


def missing(value: Value, analysis: Analysis, most: int | None = None) -> str:
    """Say whose figures are missing, and which: `execution time of x, y unknown`. Empty where nothing is."""
    if not value.missing:
        return ""
    lacks: dict[str, list[str]] = {}
    for name in dict.fromkeys(value.missing):
        lacks.setdefault(_lack(name, analysis), []).append(name)
    return " and ".join(f"{lack} {_listed(names, most)}" for lack, names in lacks.items()) + " unknown"


def _listed(names: list[str], most: int | None) -> str:
    if most is None or len(names) <= most:
        return ", ".join(names)
    return f"{', '.join(names[:most])} and {len(names) - most} more"


def _lack(name: str, analysis: Analysis) -> str:
    """Say what is not known of an element: a link's latency, an execution time, else how often it happens."""
    activity = analysis.system.activities.get(name)
    if activity is None:
        return "latency of" if name in analysis.links else "figures of"
    if activity.wcet is None and activity.response is None:
        return "execution time of"
    pace = analysis.paces.get(name)
    return "rate of" if pace is None or pace.gap.value is None else "figures of"


def origins(analysis: Analysis) -> dict[str, tuple[str, ...]]:
    """Give for each activity whose pace was inferred the activities that it comes from, at most four of them.

    Pace runs along triggers from where it was written; circles are no trouble, since the sets only grow.
    """
    found: dict[str, tuple[str, ...]] = {
        name: (name,) for name, pace in analysis.paces.items() if not pace.inferred and pace.rate.value is not None
    }
    written = set(found)
    waiting = list(found)
    while waiting:
        name = waiting.pop()
        for arc in analysis.system.out_of.get(name, ()):
            target = analysis.system.activities.get(arc.target)
            if target is None or arc.role == "answer" or arc.target in written:
                continue
            if arc.role == "data" and arc.input not in target.triggers:
                continue
            grown = tuple(dict.fromkeys((*found.get(arc.target, ()), *found[name])))[: _NAMED + 1]
            if grown != found.get(arc.target):
                found[arc.target] = grown
                waiting.append(arc.target)
    order = {name: at for at, name in enumerate(analysis.paces)}
    return {name: tuple(sorted(roots, key=order.__getitem__)) for name, roots in found.items() if name not in written}


def from_words(names: Iterable[str]) -> str:
    """Name origins: `from a, b and others`."""
    listed = list(names)
    if not listed:
        return ""
    said = ", ".join(listed[:_NAMED])
    return f"from {said} and others" if len(listed) > _NAMED else f"from {said}"
