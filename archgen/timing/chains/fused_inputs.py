"""What an element fuses: how old the messages are that it uses together, and how far apart in time they may be."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.frozen import dataclass
from archgen.timing.analysis import Analysis
from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.figures.timing_values import TimingValue, is_known_bound, sum_bounds
from archgen.timing.system.timing_system import Arc, best_response


@dataclass(frozen=True, slots=True)
class FusedInputs:
    """An activity that uses messages of several inputs together, in ns.

    `within` is what is written where they are matched by time, None where it waits for all. `apart` is how far apart the
    times of the messages may be, `gap` the largest between two activations. `ages` are, by input, from a message's time
    (the activation of its source) until the activation that uses it.
    """

    activity: str
    within: Fraction | None
    apart: TimingValue
    gap: TimingValue
    ages: dict[str, TimingValue]


def find_fused_inputs(analysis: Analysis) -> tuple[FusedInputs, ...]:
    """Return what fuses several inputs: all that match them, and all that wait for more than one."""
    steps = StepDelays.of_analysis(analysis)
    return tuple(_list_fused(analysis, steps))


def _list_fused(analysis: Analysis, steps: StepDelays) -> Iterator[FusedInputs]:
    for activity in analysis.system.activities.values():
        gap = analysis.paces[activity.id].gap
        if activity.behaviour != "event":
            continue
        if activity.mode == "match":
            within = Fraction((activity.within or 0) * analysis.system.tick)
            figures = analysis.matches.get(activity.id)
            ages = dict(figures.ages) if figures else dict.fromkeys(activity.triggers, gap)
            yield FusedInputs(activity.id, within, TimingValue(within), gap, ages)
        elif steps.arrivals.waits_for_all(activity):
            arcs = [
                arc
                for arc in analysis.system.arcs_into.get(activity.id, ())
                if arc.role == "data"
                and arc.input in activity.triggers
                and analysis.system.activities[arc.source].behaviour != "once"
            ]
            ages = {
                arc.input: sum_bounds(
                    (analysis.responses[arc.source].worst, steps.link_latency(arc), steps.holding_age(arc))
                )
                for arc in arcs
            }
            yield FusedInputs(activity.id, None, _find_apart(analysis, arcs, ages), gap, ages)


def _find_apart(analysis: Analysis, arcs: list[Arc], ages: dict[str, TimingValue]) -> TimingValue:
    """Return how far apart the messages of an activity that waits for all may be: the oldest, and the newest of others."""
    total = sum_bounds(ages.values())
    if not is_known_bound(total) or len(ages) < len(arcs):
        # Several sources of one input: which of them was the last is not known here.
        return TimingValue(None, complete=False, missing=total.missing, assumptions=total.assumptions)
    tick = analysis.system.tick
    youngest = {
        arc.input: (best_response(analysis.system.activities[arc.source]) + (arc.best or 0)) * tick for arc in arcs
    }
    return TimingValue(
        max(
            (ages[key].value or Fraction(0)) - min(young for other_key, young in youngest.items() if other_key != key)
            for key in ages
        )
    )
