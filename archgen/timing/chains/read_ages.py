"""How old what is read at an input may be, against the freshness that its reader needs."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction

from archgen.frozen import dataclass, replace
from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_verdicts import LimitState, judge_upper_limit
from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.figures.value_arithmetic import sum_bounds
from archgen.timing.system.timing_system import Arc, best_response


@dataclass(frozen=True, slots=True)
class ReadAge:
    """How old (ns) what is read over an arc may be, from when its source sends it until the last job that reads it begins."""

    arc: Arc
    age: TimingValue
    limit: Fraction

    @property
    def state(self) -> LimitState:
        """Whether nothing older than the limit is read."""
        return judge_upper_limit(self.age, self.limit)


def find_read_ages(analysis: Analysis, limits: Mapping[str, Fraction] | None = None) -> Iterator[ReadAge]:
    """Yield the ages of what is read at all inputs that have a freshness, in the order of the elements.

    `limits` (ns), by input, are others than those that are written.
    """
    steps = StepDelays.of_analysis(analysis)
    tick = analysis.system.tick
    for activity in analysis.system.activities.values():
        own_limits = (
            {port: Fraction(limit * tick) for port, limit in activity.freshness.items()}
            if limits is None
            else {port: limits[port] for port in activity.inputs if port in limits}
        )
        for arc in analysis.system.arcs_into.get(activity.id, ()) if own_limits else ():
            if arc.input in own_limits and arc.role == "data":
                yield ReadAge(arc, _find_age(analysis, steps, arc), own_limits[arc.input])


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
