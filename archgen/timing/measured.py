"""Designed against measured: figures observed on the running robot, beside what follows from the design."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from archgen.diagnostic import Diagnostic
from archgen.frozen import dataclass
from archgen.model.quantity import Quantity
from archgen.source import Span
from archgen.suggest import did_you_mean
from archgen.timing.analysis import Analysis, Pace
from archgen.timing.sums import known
from archgen.timing.value import UNKNOWN, Value

KEYS = {
    "rate": "frequency",
    "period": "duration",
    "min_period": "duration",
    "max_period": "duration",
    "bcet": "duration",
    "wcet": "duration",
    "response": "duration",
}
"""What can be observed, and its dimension. Periods are gaps between two events: mean, smallest, largest."""
TOLERANCE = Fraction(1, 10)
"""A measured mean may differ by this share before it is an outlier."""

_BROKEN_ABOVE = {
    "max_period": "gaps are larger than the bounds rest on",
    "wcet": "takes longer than the design says",
    "response": "the bound on the response time does not hold",
}
_BROKEN_BELOW = {
    "min_period": "they come closer than the bounds rest on",
    "bcet": "is quicker than the design says: jitter grows",
}


@dataclass(frozen=True, slots=True)
class Observation:
    """What was observed of one activity or topic."""

    id: str
    figures: Mapping[str, Quantity]
    at: Span


@dataclass(frozen=True, slots=True)
class Comparison:
    """One figure, designed and measured. `verdict` says whether the design holds, `why` what it means if not."""

    id: str
    key: str
    designed: Value
    measured: Fraction
    verdict: Literal["as designed", "outlier", "not designed"]
    why: str = ""

    @property
    def ratio(self) -> Fraction | None:
        """Return measured by designed, None where nothing (or zero) is designed."""
        return self.measured / self.designed.value if self.designed.value else None


def compare(
    analysis: Analysis, observed: tuple[Observation, ...]
) -> tuple[tuple[Comparison, ...], tuple[Diagnostic, ...]]:
    """Compare observations with the design; ids that the design does not have are findings."""
    made: list[Comparison] = []
    found: list[Diagnostic] = []
    # Of several publishers of a topic the last one counts; an observation of a topic does not say which one it saw.
    topics = {arc.topic: (arc.source, arc.output) for arc in analysis.system.arcs}
    for each in observed:
        topic = each.id in topics
        if not topic and each.id not in analysis.system.activities:
            found.append(_unknown(each, [*analysis.system.activities, *topics]))
            continue
        pace = analysis.outputs.get(topics[each.id]) if topic else analysis.paces.get(each.id)
        for key, quantity in each.figures.items():
            made.append(_compared(analysis, each.id, key, quantity.value, pace))
    return tuple(made), tuple(found)


def _compared(analysis: Analysis, name: str, key: str, measured: Fraction, pace: Pace | None) -> Comparison:
    """Compare one figure with what the design has for it."""
    if key in {"rate", "period"}:
        return _paced(name, key, measured, pace)
    activity, response = analysis.system.activities.get(name), analysis.responses.get(name)
    if key == "max_period":
        designed = pace.gap if pace else UNKNOWN
    elif key == "min_period":
        designed = pace.distance if pace else UNKNOWN
    elif key == "response":
        designed = response.worst if response else UNKNOWN
    else:
        ticks = (activity.wcet if key == "wcet" else activity.bcet) if activity else None
        designed = Value(ticks * analysis.system.tick) if ticks is not None else UNKNOWN
    return _bounded(name, key, designed, measured)


def _paced(name: str, key: str, measured: Fraction, pace: Pace | None) -> Comparison:
    """Compare a mean rate or period: outlier if it is off by more than the tolerance."""
    rate = designed = pace.rate if pace else UNKNOWN
    if key == "period":
        designed = Value(10**9 / rate.value, rate.complete) if rate.value else UNKNOWN
    if designed.value is None:
        return Comparison(name, key, designed, measured, "not designed")
    off = abs(measured - designed.value) > TOLERANCE * designed.value
    slower = (measured < designed.value) is (key == "rate")
    why = f"{'slower' if slower else 'faster'} than designed by more than {int(100 * TOLERANCE)} %" if off else ""
    return Comparison(name, key, designed, measured, "outlier" if off else "as designed", why)


def _bounded(name: str, key: str, designed: Value, measured: Fraction) -> Comparison:
    """Compare an extreme: outlier only if it breaks the bound. A measurement never proves one."""
    above = key in _BROKEN_ABOVE
    if designed.value is None or not known(designed, "at most" if above else "at least"):
        return Comparison(name, key, designed, measured, "not designed")
    broken = measured > designed.value if above else measured < designed.value
    why = {**_BROKEN_ABOVE, **_BROKEN_BELOW}[key] if broken else ""
    return Comparison(name, key, designed, measured, "outlier" if broken else "as designed", why)


def _unknown(each: Observation, known_ids: list[str]) -> Diagnostic:
    """Report an id that the design does not have."""
    message = f"no node, activity or topic is called `{each.id}`"
    return Diagnostic("unknown-reference", message, each.at, help=did_you_mean(each.id, known_ids))
