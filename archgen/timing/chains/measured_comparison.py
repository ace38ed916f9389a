"""Designed against measured: figures observed on the running robot, beside what follows from the design."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Literal

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggestions import did_you_mean
from archgen.frozen import dataclass
from archgen.model.quantity import Quantity
from archgen.timing.analysis import Analysis, EventPace
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.figures.value_arithmetic import is_known_bound

MEASURED_KEYS = {
    "rate": "frequency",
    "period": "duration",
    "min_period": "duration",
    "max_period": "duration",
    "bcet": "duration",
    "wcet": "duration",
    "response": "duration",
}
"""What can be observed, and its dimension. Periods are gaps between two events: mean, smallest, largest."""
RATE_TOLERANCE = Fraction(1, 10)
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
class MeasuredComparison:
    """One figure, designed and measured. `verdict` says whether the design holds, `why` what it means if not."""

    id: str
    key: str
    designed: TimingValue
    measured: Fraction
    verdict: Literal["as designed", "outlier", "not designed"]
    why: str = ""

    @property
    def ratio(self) -> Fraction | None:
        """Return measured by designed, None where nothing (or zero) is designed."""
        return self.measured / self.designed.value if self.designed.value else None


def compare_measured(
    analysis: Analysis, observations: tuple[Observation, ...]
) -> tuple[tuple[MeasuredComparison, ...], tuple[Diagnostic, ...]]:
    """Compare observations with the design; ids that the design does not have are findings."""
    comparisons: list[MeasuredComparison] = []
    findings: list[Diagnostic] = []
    # Of several publishers of a topic the last one counts; an observation of a topic does not say which one it saw.
    topics = {arc.topic: (arc.source, arc.output) for arc in analysis.system.arcs}
    for observation in observations:
        is_topic = observation.id in topics
        if not is_topic and observation.id not in analysis.system.activities:
            findings.append(_report_unknown(observation, [*analysis.system.activities, *topics]))
            continue
        pace = analysis.outputs.get(topics[observation.id]) if is_topic else analysis.paces.get(observation.id)
        for key, quantity in observation.figures.items():
            comparisons.append(_compare_figure(analysis, observation.id, key, quantity.value, pace))
    return tuple(comparisons), tuple(findings)


def _compare_figure(
    analysis: Analysis, name: str, key: str, measured: Fraction, pace: EventPace | None
) -> MeasuredComparison:
    """Compare one figure with what the design has for it."""
    if key in {"rate", "period"}:
        return _compare_rate(name, key, measured, pace)
    activity, response = analysis.system.activities.get(name), analysis.responses.get(name)
    if key == "max_period":
        designed = pace.gap if pace else UNKNOWN_VALUE
    elif key == "min_period":
        designed = pace.distance if pace else UNKNOWN_VALUE
    elif key == "response":
        designed = response.worst if response else UNKNOWN_VALUE
    else:
        ticks = (activity.wcet if key == "wcet" else activity.bcet) if activity else None
        designed = TimingValue(ticks * analysis.system.tick) if ticks is not None else UNKNOWN_VALUE
    return _compare_bound(name, key, designed, measured)


def _compare_rate(name: str, key: str, measured: Fraction, pace: EventPace | None) -> MeasuredComparison:
    """Compare a mean rate or period: outlier if it is off by more than the tolerance."""
    rate = designed = pace.rate if pace else UNKNOWN_VALUE
    if key == "period":
        designed = TimingValue(10**9 / rate.value, rate.complete) if rate.value else UNKNOWN_VALUE
    if designed.value is None:
        return MeasuredComparison(name, key, designed, measured, "not designed")
    is_off = abs(measured - designed.value) > RATE_TOLERANCE * designed.value
    is_slower = (measured < designed.value) is (key == "rate")
    why = (
        f"{'slower' if is_slower else 'faster'} than designed by more than {int(100 * RATE_TOLERANCE)} %"
        if is_off
        else ""
    )
    return MeasuredComparison(name, key, designed, measured, "outlier" if is_off else "as designed", why)


def _compare_bound(name: str, key: str, designed: TimingValue, measured: Fraction) -> MeasuredComparison:
    """Compare an extreme: outlier only if it breaks the bound. A measurement never proves one."""
    is_upper_bound = key in _BROKEN_ABOVE
    if designed.value is None or not is_known_bound(designed, "at most" if is_upper_bound else "at least"):
        return MeasuredComparison(name, key, designed, measured, "not designed")
    is_broken = measured > designed.value if is_upper_bound else measured < designed.value
    why = {**_BROKEN_ABOVE, **_BROKEN_BELOW}[key] if is_broken else ""
    return MeasuredComparison(name, key, designed, measured, "outlier" if is_broken else "as designed", why)


def _report_unknown(observation: Observation, known_ids: list[str]) -> Diagnostic:
    """Report an id that the design does not have."""
    message = f"no node, activity or topic is called `{observation.id}`"
    return Diagnostic("unknown-reference", message, observation.at, help=did_you_mean(observation.id, known_ids))
