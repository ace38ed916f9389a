"""Where the search found no bound: hosts with their load, and those only where that begins."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.missing_figures import (
    describe_gaps,
    describe_overload,
    describe_unfound_places,
    find_overloaded_elements,
    find_overloaded_places,
    find_saturated_links,
    find_unfound_places,
    group_by_host,
)
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.sketches import analyse_sketch, read_sketch

# Each of the three fires the next on one core, and may start a little late: so none is part of a run, and the jitter of
# one makes the next one wait without end. What reads on another host has no bound either.
_NODES = {
    "a @pc": "period: 100 ms, wcet: {} ms, bcet: {} ms",
    "b @pc": "jitter: 1 us, wcet: {} ms, bcet: {} ms",
    "c @pc": "jitter: 1 us, wcet: {} ms, bcet: {} ms",
    "far @arm": "wcet: 1 ms, bcet: 1 ms",
    "poll @arm": "period: 50 ms, wcet: 1 ms, bcet: 1 ms",
}
_REST = (
    "hosts: {pc: {cores: CORES}, arm: {cores: 1}}\nlinks: {lan: {connects: [pc, arm], latency: 1 ms}}\n"
    "chains: {c: {through: [STEPS]}}"
)


@pytest.mark.parametrize(
    ("cost", "cores", "steps", "places", "overloaded"),
    [
        (1, 1, "a, b, c", "", ()),
        (20, 1, "a, b, c", "on pc at a load of 60 % (in any order)", ()),
        (40, 2, "a, b, c, far", "on pc at a load of 60 % (several cores in any order)", ()),
        (20, 1, "c, far", "on pc at a load of 60 % (in any order)", ()),
        (20, 1, "far, poll", "on pc at a load of 60 % (in any order)", ()),
        (40, 1, "a, b, c", "", ("pc",)),
    ],
)
def test_the_host_where_it_begins_is_named(
    cost: int, cores: int, steps: str, places: str, overloaded: tuple[str, ...]
) -> None:
    nodes = {head: figures.format(cost, cost) for head, figures in _NODES.items()}
    sketch = nodes, "a>b b>c c>far far>poll", _REST.replace("CORES", str(cores)).replace("STEPS", steps)
    analysis = analyse_sketch(*sketch)
    terms = bound_all_chains(analysis, read_sketch(*sketch))["c"].terms
    assert describe_unfound_places(find_unfound_places(analysis, terms)) == places
    assert tuple(find_overloaded_places(analysis, terms)) == overloaded


def test_without_a_host_the_elements_are_named() -> None:
    analysis = analyse_sketch({"a": "period: 10 ms, wcet: 1 ms", "b": "wcet: 1 ms"}, "a>b")
    (place,) = group_by_host(analysis, ("a", "b"))
    assert describe_unfound_places((place,)) == "for a, b (each on a core of its own)"


@pytest.mark.parametrize("latency", ["", ", latency: 2 ms"])
def test_a_link_that_carries_less_than_is_sent_keeps_no_latency(latency: str) -> None:
    nodes = {"a @p": "period: 10 ms, wcet: 1 ms", "b @q": "response: 2 ms"}
    rest = (
        "hosts: {p: {cores: 1}, q: {cores: 1}}\n"
        f"links: {{lan: {{connects: [p, q], bandwidth: 800 kbit/s{latency}}}}}\n"
        "chains: {way: {through: [a, b], deadline: 1 s}}"
    )
    model = read_sketch(nodes, "a>b", rest)
    analysis = analyse_architecture(model)
    (chain,) = bound_all_chains(analysis, model).values()
    assert (chain.bound.value, chain.verdict) == (None, "missed")
    assert find_saturated_links(chain.terms) == ("lan",)
    assert describe_gaps(chain, analysis) == "lan is overloaded"
    assert describe_overload(analysis, chain.terms) == "more is to be sent over lan than can be"


def test_an_overloaded_resource_is_named() -> None:
    nodes = {"a @pc": "period: 30 ms, wcet: 1 ms, uses: {gpu: 20 ms}", "b @pc": "period: 30 ms, uses: {gpu: 11 ms}"}
    rest = "hosts: {pc: {cores: 2}}\nresources: {gpu: {host: pc, scheduling: fifo}}\nchains: {way: {through: [a], deadline: 1 s}}"
    model = read_sketch(nodes, "", rest)
    analysis = analyse_architecture(model)
    (chain,) = bound_all_chains(analysis, model).values()
    assert [name for name, _ in find_overloaded_places(analysis, chain.terms)["gpu"]] == ["a", "b"]
    assert describe_overload(analysis, chain.terms, "`") == "more is to be done on `gpu` than can be"


def test_an_element_that_is_fired_before_it_is_done_is_named() -> None:
    nodes = {"a @pc": "period: 10 ms, wcet: 1 ms", "b @pc": "wcet: 12 ms"}
    model = read_sketch(nodes, "a>b", "hosts: {pc: {cores: 4}}\nchains: {way: {through: [a, b], deadline: 1 s}}")
    analysis = analyse_architecture(model)
    (chain,) = bound_all_chains(analysis, model).values()
    assert find_overloaded_elements(analysis, chain.terms) == {"b": Fraction(6, 5)}
    assert describe_gaps(chain, analysis) == "b is overloaded"
