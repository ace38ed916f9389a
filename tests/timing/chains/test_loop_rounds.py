"""Loops of data flow: one round of each, and the age of data where an event is the stimulus."""

from __future__ import annotations

from dataclasses import replace

from archgen.timing.chains.chain_bounds import bound_all_chains, find_data_age
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.loop_rounds import find_loop_rounds
from tests.timing.made import analysis, arc, architecture, event, ms, periodic


def test_one_round_is_the_sum_over_its_edges() -> None:
    found = analysis(
        [periodic("ctrl", 10), event("motor", "motor.ctrl"), periodic("sense", 5), event("log", "log.sense")],
        [arc("ctrl", "motor"), arc("motor", "sense"), arc("sense", "ctrl"), arc("sense", "log")],
        {"ctrl": 1, "motor": 2, "sense": 3, "log": 1},
        {"ctrl": 10, "motor": 10, "sense": 5, "log": 5},
    )
    (only,) = find_loop_rounds(CostNetwork.of_analysis(found))
    assert only.through == ("ctrl", "motor", "sense", "ctrl")
    assert only.members == 3
    assert only.latency == ms(0 + 2 + 5 + 3 + 10 + 1)


def test_data_of_an_event_is_the_newest_until_the_next_event_comes() -> None:
    found = analysis(
        [periodic("cam", 100), event("det", "det.cam"), event("act", "act.det")],
        [arc("cam", "det"), arc("det", "act")],
        {"cam": 5, "det": 40, "act": 2},
        {"cam": 100, "det": 105, "act": 145},
    )
    network = CostNetwork.of_analysis(found)
    from_event = bound_all_chains(found, architecture(("cam", "det", "act"), "det", "act"))["c"]
    from_world = bound_all_chains(found, architecture(("cam", "det", "act"), "cam", "act"))["c"]
    age = find_data_age(network, from_event)
    assert (from_event.bound.value, age.value) == (ms(42).value, ms(42 + 105).value)
    assert find_data_age(network, from_world) == from_world.bound


def test_the_shortest_round_leads_neither_outside_nor_along_an_answer() -> None:
    """From `a` both `b` and `c` are one step away, so that `b > c` is no part of the shortest round; `d` is outside."""
    names = ("a", "b", "c", "d")
    links = [arc("a", "b"), arc("a", "d"), arc("a", "c"), arc("b", "c"), arc("c", "a")]
    for answered, rounds in (((), ("a", "c", "a")), (("a>c",), ("a", "b", "c", "a"))):
        arcs = [replace(one, role="answer") if f"{one.source}>{one.target}" in answered else one for one in links]
        found = analysis(
            [periodic(name, 10) for name in names], arcs, dict.fromkeys(names, 1), dict.fromkeys(names, 10)
        )
        (only,) = find_loop_rounds(CostNetwork.of_analysis(found))
        assert (only.through, only.members) == (rounds, 3)
