"""The way from the farthest sensor: the longest of the shortest, whatever is written first, and past its reader."""

from __future__ import annotations

from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.sensing_ways import SensingWay, SensingWays
from archgen.timing.figures.timing_values import is_known_bound
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show_ms
from tests.timing.sketches import read_sketch

HOSTS = "hosts: {h: {cores: 1, scheduling: fixed_priority}, k: {cores: 1, scheduling: fixed_priority}}\n"
LINKS = "links: {lan: {connects: [h, k], latency: {best: 1 ms, worst: 3 ms}}}\n"


def _find_way(nodes: dict[str, str], wires: str, source: str, reader: str) -> SensingWay:
    model = read_sketch(nodes, wires, HOSTS + LINKS)
    return SensingWays(CostNetwork.of_analysis(analyse_architecture(model)), model).find_way(source, reader)


def test_of_ways_of_as_many_elements_the_longest_counts_in_whatever_order_they_are_written() -> None:
    nodes = {
        "camera @h": "period: 30 ms, wcet: 2 ms",
        "quick @h": "behaviour: event, trigger: [camera], wcet: 1 ms",
        "slow @k": "behaviour: event, trigger: [camera], wcet: 20 ms",
        "plan @h": "period: 100 ms, wcet: 4 ms",
        "drive @k": "period: 500 ms, wcet: 1 ms",
    }
    for first, second in (("quick", "slow"), ("slow", "quick")):
        wires = f"light>camera camera>{first} camera>{second} {first}>plan {second}>plan plan>drive"
        way = _find_way(nodes, wires, "plan", "drive")
        assert way.activities == ("camera", "slow", "plan"), first
        assert show_ms(way.age) == "144", first


def test_what_has_no_bound_is_the_farthest() -> None:
    nodes = {
        "camera @h": "period: 30 ms, wcet: 2 ms",
        "unknown @k": "period: 10 ms",
        "merge @h": "period: 100 ms, wcet: 1 ms",
    }
    way = _find_way(nodes, "light>camera road>unknown camera>merge unknown>merge", "merge", "")
    assert way.activities == ("unknown", "merge")
    assert not is_known_bound(way.age)


def test_a_way_that_goes_round_a_loop_does_not_pass_its_reader() -> None:
    nodes = {
        "wheel @h": "period: 10 ms, wcet: 1 ms",
        "filter @h": "period: 20 ms, wcet: 1 ms",
        "guess @h": "period: 20 ms, wcet: 1 ms",
        "map @h": "period: 100 ms, wcet: 1 ms",
        "show @h": "period: 100 ms, wcet: 1 ms",
    }
    wires = "road>wheel wheel>filter filter>guess guess>filter sky>map map>guess guess>show"
    # To the filter the guess brings nothing of the wheel that the filter did not have.
    assert _find_way(nodes, wires, "guess", "filter").activities == ("map", "guess")
    assert _find_way(nodes, wires, "guess", "show").activities == ("wheel", "filter", "guess")
