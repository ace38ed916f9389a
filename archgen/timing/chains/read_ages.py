"""How old what is read at an input may be, against the freshness that its reader needs."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis
from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.figures.value_arithmetic import is_boundless, is_known_bound, is_unfound, sum_bounds
from archgen.timing.system.timing_system import Arc, best_response


@dataclass(frozen=True, slots=True)
class ReadAge:
    """How old (ns) what is read over an arc may be, from when its source sends it until the last job that reads it begins."""

    arc: Arc
    age: TimingValue
    limit: Fraction

    @property
    def is_kept(self) -> bool | None:
        """Whether nothing older than the limit is read; None where figures are missing."""
        if self.age.value is not None and self.age.value > self.limit:
            return False
        if is_known_bound(self.age):
            return True
        return False if is_boundless(self.age) or (is_unfound(self.age) and not self.age.missing) else None


def find_read_ages(analysis: Analysis) -> Iterator[ReadAge]:
    """Yield the ages of what is read at all inputs that have a freshness, in the order of the elements."""
    steps = StepDelays.of_analysis(analysis)
    for activity in analysis.system.activities.values():
        for arc in analysis.system.arcs_into.get(activity.id, ()) if activity.freshness else ():
            limit = activity.freshness.get(arc.input)
            if limit is not None and arc.role == "data":
                yield ReadAge(arc, _find_age(analysis, steps, arc), Fraction(limit * analysis.system.tick))


def find_sent_ages(analysis: Analysis, outputs: Collection[str]) -> Iterator[tuple[Arc, TimingValue]]:
    """Yield how old (ns) what is sent at some outputs may be where it is read, by each way to a reader."""
    steps = StepDelays.of_analysis(analysis)
    for arcs in analysis.system.arcs_from.values():
        for arc in arcs:
            if arc.output in outputs and arc.role == "data":
                yield arc, _find_age(analysis, steps, arc)


def _find_age(analysis: Analysis, steps: StepDelays, arc: Arc) -> TimingValue:
    """Return the link's latency, the age at the activation that uses the message, and the time until that begins."""
    starting = ZERO_VALUE
    if steps.arrivals.fires_reader(arc):
        reader = analysis.system.activities[arc.target]
        response = steps.response_value(reader.id)
        starting = (
            response
            if response.value is None
            else replace(
                response, value=max(response.value - best_response(reader) * analysis.system.tick, Fraction(0))
            )
        )
    return sum_bounds((steps.link_latency(arc), steps.holding_age(arc), starting))
