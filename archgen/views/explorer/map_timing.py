"""Make the tables of how long the steps of a way take: what works on the map's elements, and what one hands to the next."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.model.architecture import Architecture
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system.timing_system import Activity
from archgen.views.explorer.map_flows import Numbers
from archgen.views.explorer.map_shapes import Row
from archgen.views.lookup import Lookup


def make_timing_tables(lookup: Lookup, components: Numbers, nodes: Numbers) -> dict[str, tuple[Row, ...]]:
    """Make the tables of activities and of the steps between them; both are empty where nothing was analysed."""
    if lookup.timing is None:
        return {"activities": (), "steps": ()}
    network = CostNetwork.of_analysis(lookup.timing.analysis)
    activities = [each for each in lookup.timing.analysis.system.activities.values() if each.node in nodes]
    numbers = {activity.id: number for number, activity in enumerate(activities)}
    return {
        "activities": tuple(
            _make_activity_row(lookup.architecture, network, each, components, nodes) for each in activities
        ),
        "steps": tuple(_list_step_rows(network, numbers)),
    }


def _make_activity_row(
    architecture: Architecture, network: CostNetwork, activity: Activity, components: Numbers, nodes: Numbers
) -> Row:
    start = network.steps.start_delay(activity.id)
    return (
        activity.id,
        nodes[activity.node],
        tuple(components[name] for name in _list_components(architecture, activity) if name in components),
        _write_time(start.value),
        _write_time(network.start_response(activity.id)),
        start.why,
    )


def _list_components(architecture: Architecture, activity: Activity) -> Iterator[str]:
    """Yield the components that an activity works for: where it names none, all that its node implements."""
    for name in architecture.nodes[activity.node].implements:
        if activity.component in {None, name, name.rpartition(".")[2]}:
            yield from architecture.leaves_of(name)


def _list_step_rows(network: CostNetwork, numbers: Numbers) -> Iterator[Row]:
    """Yield the steps as a chain's page has them: over the link, waiting, at work. Answers fire nobody."""
    for arc in network.arcs:
        if arc.role != "answer" and arc.source in numbers and arc.target in numbers:
            delay = network.steps.sampling_delay(arc)
            times = (network.steps.link_latency(arc), delay.value, network.step_response(arc))
            ends = (numbers[arc.source], numbers[arc.target])
            yield (*ends, int(arc.role == "request"), *map(_write_time, times), delay.why)


def _write_time(value: TimingValue) -> object:
    """Return an upper bound in ns: None for what nobody knows, in brackets what is only a part of it."""
    if value.value is None:
        return None
    time = value.value.numerator if value.value.denominator == 1 else float(value.value)
    return time if value.complete or value.side == "at most" else (time,)
