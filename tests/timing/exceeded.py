"""What a simulation saw beyond a bound of the analysis: nothing, if both are right."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction

from archgen.model.architecture import Architecture
from archgen.simulation import SimulationResult, simulate_system
from archgen.simulation.chain_witnesses import bound_data_ages, find_publish_pauses
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.random_systems import architecture


def exceeded(text: str, seconds: int = 2, seeds: int = 6) -> tuple[list[str], int]:
    """Simulate a project; say what exceeded its bound, and how many bounds were held against what was seen."""
    return exceeded_by(architecture(text), seconds, seeds)


def exceeded_by(model: Architecture, seconds: int = 2, seeds: int = 6) -> tuple[list[str], int]:
    """Say the same of an architecture."""
    analysis = analyse_architecture(model)
    if not _kept(analysis):
        return [], 0
    found = bound_all_chains(analysis, model)
    # Bounds hold for any order where none is written, not only for that of ROS 2.
    processes = {key: replace(process, usual_order=None) for key, process in analysis.system.executors.items()}
    any_order = replace(analysis.system, executors=processes)
    seen = simulate_system(
        any_order, seconds, seeds, {key: c.through for key, c in found.items()}, find_publish_pauses(analysis)
    )
    pairs = [
        *_activities(seen, analysis),
        *_chains(seen, found, bound_data_ages(analysis, found)),
        *_rest(seen, analysis),
    ]
    held = [(what, seen, bound) for what, seen, value in pairs if (bound := bounded(value)) is not None]
    wrong = [
        f"{what}: {float(seen) / 1e6} seen, bound {float(bound) / 1e6}" for what, seen, bound in held if seen > bound
    ]
    return wrong, len(held)


def _kept(analysis: Analysis) -> bool:
    """Tell whether every promised largest gap can be kept: whether there is a chance to publish often enough."""
    chances = find_publish_pauses(analysis)
    return all(
        key in a.conditional and (a.id, key) in chances and chances[a.id, key] <= gap * analysis.system.tick
        for a in analysis.system.activities.values()
        for key, gap in a.max_gaps.items()
    )


def bounded(value: TimingValue) -> Fraction | None:
    """Give what a figure bounds from above; None where it rests on what is not known."""
    return None if value.side == "at least" or not value.complete else value.value


def _activities(seen: SimulationResult, analysis: Analysis) -> Iterator[tuple[str, Fraction, TimingValue]]:
    for name, one in seen.activities.items():
        pace, response = analysis.paces[name], analysis.responses[name]
        if one.worst_response is not None:
            yield f"response of {name} ({response.tier})", one.worst_response, response.worst
        if one.best_response is not None and response.best.value is not None:
            yield (
                f"best response of {name}, negative",
                -one.best_response,
                TimingValue(-response.best.value, response.best.complete),
            )
        if one.activation_gap is not None:
            yield f"gap of {name}", one.activation_gap, pace.gap
        for key, silence in one.output_silences.items():
            if key in analysis.system.activities[name].max_gaps and (name, key) in analysis.outputs:
                yield f"silence of {key}", silence, analysis.outputs[name, key].gap


def _chains(
    seen: SimulationResult, found: dict[str, ChainResult], oldest: dict[str, TimingValue]
) -> Iterator[tuple[str, Fraction, TimingValue]]:
    for key, chain in seen.chains.items():
        way, one = " > ".join(chain.through), chain.bounded_figures
        if one.reaction is not None:
            yield f"reaction of {way}", one.reaction.largest, found[key].bound
            best = found[key].best
            if best.value is not None:
                yield f"best case of {way}, negative", -one.reaction.least, TimingValue(-best.value, best.complete)
        if one.age is not None:
            yield f"age of {way}", one.age.largest, oldest[key]
        if one.reduced_reaction is not None:
            yield f"reduced reaction of {way}", one.reduced_reaction, found[key].reduced_reaction
        if one.reduced_age is not None:
            yield f"reduced age of {way}", one.reduced_age, found[key].reduced_age


def _rest(seen: SimulationResult, analysis: Analysis) -> Iterator[tuple[str, Fraction, TimingValue]]:
    for link, one in seen.links.items():
        if link in analysis.links:
            yield f"queueing on {link}", one.wait, analysis.links[link].queueing
    for name, activity in seen.activities.items():
        pace = analysis.paces[name]
        if pace.rate.value is not None and pace.jitter.value is not None:
            # A rate bounds the long run only: what jitter holds back comes on top, and one job at either end.
            more = Fraction(seen.seeds) * (pace.rate.value * pace.jitter.value / 10**9 + 2)
            bound = TimingValue(
                pace.rate.value * seen.seconds * seen.seeds + more, pace.rate.complete, side=pace.rate.side
            )
            yield f"jobs of {name}", Fraction(activity.jobs), bound
