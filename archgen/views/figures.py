"""Exact values of the timing analysis in human units, with their bounds and with what is missing."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

from archgen.timing.analysis import Analysis
from archgen.timing.value import Value

_SIDES = {"exact": "", "at least": ">= ", "at most": "<= "}
_SIZES = ((10**9, "GB"), (10**6, "MB"), (10**3, "kB"), (1, "B"))
"""Units of size, largest first: the first one that is not too large is used."""
_LONG = 10 * 10**9
"""Durations from ten seconds on are written in s instead of ms; in ns."""
_NAMED = 3
"""At most this many origins of a rate are named."""
_DIGITS = 3
UNKNOWN = "unknown"
"""What every formatter returns for an unknown value; callers compare with it to mute the cell."""
_ENDLESS = {
    "overload": "no bound: the host is overloaded",
    "unbounded": "no bound",
    "diverged": "no bound: the search for one did not end",
}
"""Words for a value that does not exist, by the first word of the assumption that explains it."""


def number(value: Fraction, decimals: int = _DIGITS) -> str:
    """Format a number with at most `decimals` decimals, rounded half up.

    Numbers below one get as many significant digits instead.
    """
    if not value:
        return "0"
    # Decimal, not float: otherwise "half up" would depend on how a half is represented in binary.
    exact = Decimal(value.numerator) / Decimal(value.denominator)
    places = decimals if abs(value) >= 1 else decimals - 1 - exact.adjusted()
    rounded = exact.quantize(Decimal(1).scaleb(-places), ROUND_HALF_UP)
    text = f"{rounded:f}"
    # Only behind a decimal point: the zeros of 100 are part of the number.
    return text.rstrip("0").rstrip(".") if "." in text else text


def duration(value: Value) -> str:
    """Format the upper bound of a duration (in ns) in ms, or in s from ten seconds on.

    "At most" goes without a sign because documents present these figures as bounds. A sum with gaps gets ">=", since it
    is no upper bound at all.
    """
    partial = not value.complete and value.side != "at most"
    return _written(replace(value, side="at least" if partial else "exact", complete=not partial), _time)


def least(value: Value) -> str:
    """Format the lower bound of a duration (in ns)."""
    # Without `complete` and `side`: a lower bound stays one, whatever was left out of it.
    return _written(Value(value.value, assumptions=value.assumptions), _time)


def _time(found: Fraction) -> str:
    """Format nanoseconds as ms or s."""
    return f"{number(found / 10**6)} ms" if found < _LONG else f"{number(found / 10**9)} s"


def rate(value: Value) -> str:
    """Format a rate in Hz."""
    return _written(value, lambda found: f"{number(found)} Hz")


def share(value: Value) -> str:
    """Format a share of a whole in percent."""
    return _written(value, lambda found: f"{number(found * 100, 1)} %")


def amount(value: Value) -> str:
    """Format a number of bytes in the largest unit that leaves at least one."""
    return _written(value, _size)


def traffic(value: Value) -> str:
    """Format bytes per second in the largest unit that leaves at least one."""
    return _written(value, lambda found: f"{_size(found)}/s")


def _size(found: Fraction) -> str:
    """Format a number of bytes."""
    factor, unit = next(((factor, unit) for factor, unit in _SIZES if found >= factor), (1, "B"))
    return f"{number(found / factor)} {unit}"


def side(value: Value) -> str:
    """Return the sign before a value that bounds from one side; a sum with gaps is at least what is known."""
    if value.side == "exact" and not value.complete:
        return ">= "
    return _SIDES[value.side]


def _written(value: Value, write: Callable[[Fraction], str]) -> str:
    """Format a value with its sign, or say why there is none."""
    if value.value is None:
        words = (text.partition(":")[0].strip() for text in value.assumptions)
        return next((_ENDLESS[word] for word in words if word in _ENDLESS), UNKNOWN)
    if not value.value and side(value) == ">= ":
        return UNKNOWN  # at least zero says nothing, and a zero would look as if somebody had written it
    return side(value) + write(value.value)


def period(value: Value) -> str:
    """Format the period in ms of a rate in Hz; a rate of at most r has a period of at least 1/r."""
    if not value.value:
        return ""
    turned = {"at least": "<= ", "at most": ">= "}.get(side(value) and _side(value), "")
    return turned + _time(10**9 / value.value)


def _side(value: Value) -> str:
    """Name the side of a value that has a sign."""
    return "at least" if side(value) == ">= " else "at most"


def whole(value: Value, analysis: Analysis) -> str:
    """Format a duration with what is missing for a bound: `>= 468 ms; no bound: execution time of x, y unknown`."""
    said = missing(value, analysis)
    text = duration(value)
    if not said:
        return text
    return f"no bound: {said}" if value.value is None else f"{text}; no bound: {said}"


def missing(value: Value, analysis: Analysis, most: int | None = None) -> str:
    """Describe which figures of which elements are missing: `execution time of x, y unknown`; empty for none.

    At most `limit` elements are named for each kind of figure, None for all.
    """
    if not value.missing:
        return ""
    lacks: dict[str, list[str]] = {}
    for name in dict.fromkeys(value.missing):
        lacks.setdefault(_lack(name, analysis), []).append(name)
    return " and ".join(f"{lack} {_listed(names, most)}" for lack, names in lacks.items()) + " unknown"


def _listed(names: list[str], most: int | None) -> str:
    """Join names with commas; beyond the limit only their number is given."""
    if most is None or len(names) <= most:
        return ", ".join(names)
    return f"{', '.join(names[:most])} and {len(names) - most} more"


def _lack(name: str, analysis: Analysis) -> str:
    """Describe what is missing of an element: a link's latency, an execution time, a rate, else "figures"."""
    activity = analysis.system.activities.get(name)
    if activity is None:
        return "latency of" if name in analysis.links else "figures of"
    # The most basic lack first: without an execution time there is no response, and without that no bound.
    if activity.wcet is None and activity.response is None:
        return "execution time of"
    pace = analysis.paces.get(name)
    return "rate of" if pace is None or pace.gap.value is None else "figures of"


def origins(analysis: Analysis) -> dict[str, tuple[str, ...]]:
    """Find for each activity with an inferred rate the activities that it is inferred from, at most four.

    Rates spread along triggers from the activities where they were written. Rings end: the sets only grow and are
    bounded. Returns ids in the order of the analysis.
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
            # A written rate is an origin of its own, so those before it do not count.
            if target is None or arc.role == "answer" or arc.target in written:
                continue
            # Data that is read but triggers nothing has no influence on the rate.
            if arc.role == "data" and arc.input not in target.triggers:
                continue
            # One more than is named, so that "and others" can be told from exactly three.
            grown = tuple(dict.fromkeys((*found.get(arc.target, ()), *found[name])))[: _NAMED + 1]
            if grown != found.get(arc.target):
                found[arc.target] = grown
                waiting.append(arc.target)
    order = {name: at for at, name in enumerate(analysis.paces)}
    return {name: tuple(sorted(roots, key=order.__getitem__)) for name, roots in found.items() if name not in written}


def from_words(names: Iterable[str]) -> str:
    """Describe origins: `from a, b and others`; empty for none."""
    listed = list(names)
    if not listed:
        return ""
    said = ", ".join(listed[:_NAMED])
    return f"from {said} and others" if len(listed) > _NAMED else f"from {said}"
