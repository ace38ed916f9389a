"""No simulation exceeds a bound: random systems with resources, matched inputs, and dropped messages that are forgotten."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, cast

import pytest

from archgen.model.architecture import Architecture, Chain, Waypoint
from archgen.simulation import SimulationResult, simulate_system
from archgen.simulation.chain_witnesses import find_publish_pauses
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_bounds import bound_chain, find_data_age
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_system
from archgen.timing.system.timing_system import Activity, Executor, ResourceUse, SharedResource
from tests.property_sizes import try_some
from tests.simulation.systems import arc, event, system, timed
from tests.timing.exceeded import bounded
from tests.timing.random_uses import random_use_system, random_walks

Held = tuple[str, Fraction | None, TimingValue]


@pytest.mark.parametrize("first", try_some(range(0, 300, 15), 1, 10))
def test_no_simulation_exceeds_a_bound(first: int) -> None:
    held_count = 0
    for seed in range(first, first + 15):
        pairs = [
            (what, seen, bound)
            for what, seen, value in _list_pairs(seed)
            if seen is not None and (bound := bounded(value)) is not None
        ]
        assert [pair for pair in pairs if pair[1] > pair[2]] == [], seed
        held_count += len(pairs)
    assert held_count > 100


def test_several_threads_of_a_container_that_waits_keep_several_cores_busy() -> None:
    values: dict[str, Any] = {"period": 100, "host": "pc"}
    members = {"a": 20, "b": 20, "c": 1}
    activities = [
        Activity(
            name,
            name,
            None,
            "periodic",
            wcet=wcet,
            bcet=wcet,
            callback_group=name,
            container="box",
            executor="box",
            uses={"gpu": ResourceUse(1, 1)} if name == "c" else {},
            **values,
        )
        for name, wcet in members.items()
    ]
    alone = Activity("x", "x", None, "periodic", wcet=1, bcet=1, callback_group="x", executor="x", **values)
    of = system(
        [*activities, alone],
        [],
        {"pc": 2},
        resources={"gpu": SharedResource("gpu", "pc", None)},
        executors={"box": Executor("box", 2, "pc"), "x": Executor("x", 1, "pc")},
        bandwidths={},
    )
    bound = analyse_system(of).responses["x"].worst.value
    assert simulate_system(of, 1, 20).activities["x"].worst_response == 21_000_000
    assert bound is not None
    assert 21_000_000 <= bound <= 22_000_000


@pytest.mark.parametrize("seed", [667, 681, 1191])
def test_no_simulation_exceeds_a_bound_where_a_newer_message_is_overtaken(seed: int) -> None:
    """A reentrant source with a jitter of its period fires twice at once; its reader polls, or waits for others."""
    pairs = [(what, seen, bounded(value)) for what, seen, value in _list_pairs(seed) if seen is not None]
    assert [(what, seen, bound) for what, seen, bound in pairs if bound is not None and seen > bound] == []
    assert len(pairs) >= 8


def test_gaps_count_once_all_that_fires_an_element_has_sent() -> None:
    """A slow source fires first, while the first message of the fast one is on its way; behind it, all is as late."""
    late = arc("fast", "reader", best=60, worst=60)
    of = system(
        [
            timed("fast", 10, 1, outputs=("out",)),
            timed("slow", 40, 1, outputs=("out",)),
            event("reader", 1, "fast", "slow", outputs=("out",)),
            event("behind", 1, "reader"),
        ],
        [late, arc("slow", "reader"), arc("reader", "behind")],
    )
    analysis, seen = analyse_system(of), simulate_system(of, 1, 40)
    assert analysis.paces["reader"].gap.value == seen.activities["reader"].activation_gap == 10_000_000
    assert (behind_gap := seen.activities["behind"].activation_gap) is not None
    assert 10_000_000 <= behind_gap <= (analysis.paces["behind"].gap.value or 0) == 11_000_000


def _list_pairs(seed: int) -> Iterator[Held]:
    of = random_use_system(seed)
    analysis, walks = analyse_system(of), random_walks(of, seed)
    seen = simulate_system(of, 1, 8, walks, find_publish_pauses(analysis))
    yield from _activity_pairs(analysis, seen)
    network = CostNetwork.of_analysis(analysis)
    for name, way in walks.items():
        yield from _chain_pairs(network, seen, name, way)


def _activity_pairs(analysis: Analysis, seen: SimulationResult) -> Iterator[Held]:
    for name, one in seen.activities.items():
        response = analysis.responses[name].worst
        yield f"response of {name}", one.worst_response, response
        yield f"gap of {name}", one.activation_gap, analysis.paces[name].gap
        figures = analysis.matches.get(name)
        activity = analysis.system.activities[name]
        ages = [bounded(age) for age in figures.ages.values()] if figures else [None]
        oldest = None if None in ages else max(age for age in ages if age is not None)
        if oldest is not None and bounded(response) is not None and not activity.jitter:
            yield f"age of what {name} fuses", one.fused_age, TimingValue(oldest + (response.value or 0))
        if activity.within is not None:
            yield f"apart at {name}", one.fused_spread, TimingValue(activity.within * analysis.system.tick)


def _chain_pairs(network: CostNetwork, seen: SimulationResult, name: str, way: tuple[str, ...]) -> Iterator[Held]:
    chain = Chain(name, name, tuple(Waypoint("node", step) for step in way))
    no_elements = cast("Architecture", SimpleNamespace(nodes={}, outputs={}))
    found: ChainResult = bound_chain(network.steps.analysis, no_elements, chain, network)
    one = seen.chains[name].bounded_figures
    title = " > ".join(way)
    yield f"reaction of {title}", one.reaction.largest if one.reaction else None, found.bound
    yield f"age of {title}", one.age.largest if one.age else None, find_data_age(network, found)
    yield f"reduced reaction of {title}", one.reduced_reaction, found.reduced_reaction
    yield f"reduced age of {title}", one.reduced_age, found.reduced_age
    # What is sent cannot be older than it becomes until the next output replaces it.
    yield f"reduced age in {title}", found.reduced_age.value, find_data_age(network, found)
