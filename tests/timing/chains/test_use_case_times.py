"""How long steps of use cases take: the terms of chains, step by step; the whole is the bound of the chain along them."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.use_case_times import UseCaseTimes, bound_use_cases
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.sketches import read_sketch

NODES = {
    "eye @pc": "rate: 10 Hz, wcet: 5 ms",
    "mind @pc": "behaviour: event, trigger: [eye], wcet: 20 ms",
    "hand @arm": "rate: 100 Hz, wcet: 1 ms",
}
WIRES = "light>eye eye>mind mind>hand"
REST = """
hosts: {pc: {cores: 1}, arm: {cores: 1}}
links: {lan: {connects: [pc, arm], latency: 2 ms}}
chains: {c: {through: [eye, mind, hand]}}
use_cases:
  UC-1: {actors: {sun: The sun}, steps: [%s]}
"""


def _times(steps: str, nodes: dict[str, str] | None = None, wires: str = WIRES) -> tuple[Architecture, UseCaseTimes]:
    architecture = read_sketch(nodes or NODES, wires, REST % steps)
    return architecture, bound_use_cases(analyse_architecture(architecture), architecture)["UC-1"]


def _ms(value: TimingValue | None) -> float | str | None:
    if value is None:
        return None
    figure = "?" if value.value is None else float(value.value / 10**6)
    return figure if value.complete else f">= {figure}"


ALONG = "{from: sun, to: eye}, {from: eye, to: mind}, {from: mind, to: mind}, {from: mind, to: hand}"


def test_the_steps_along_a_chain_take_as_long_as_the_chain() -> None:
    architecture, times = _times(ALONG)
    # 100 ms until the eye looks, 25 ms for it (20 ms of the mind before it); 25 ms for the mind (5 ms of the eye before it),
    # which are the same 25 ms where both run once; 2 ms on the link, 10 ms until the hand looks, 1 ms for it.
    assert [_ms(value) for value in times.steps] == [125, 25, None, 13]
    chain = bound_all_chains(analyse_architecture(architecture), architecture)["c"]
    assert times.total.value == chain.bound.value
    assert _ms(times.total) == 138


def test_the_whole_may_be_less_than_the_sum_of_its_steps() -> None:
    _, times = _times(ALONG)
    assert sum(value.value or Fraction(0) for value in times.steps if value) > (times.total.value or 0)


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        # Who begins by itself adds what the first element of a chain adds.
        ("{from: eye, to: mind}", [150]),
        # Whoever was reached once has reacted: a second message of its work costs its own way only.
        ("{from: sun, to: eye}, {from: eye, to: mind}, {from: eye, to: mind}", [125, 25, 25]),
        ("{from: mind, to: eye}", [None]),
        ("{from: sun, to: hand}", [None]),
    ],
)
def test_single_steps(steps: str, expected: list[float | None]) -> None:
    _, times = _times(steps)
    assert [_ms(value) for value in times.steps] == expected


def test_what_is_not_written_is_named() -> None:
    _, times = _times(ALONG, {**NODES, "mind @pc": "behaviour: event, trigger: [eye]"})
    assert [_ms(value) for value in times.steps][1:] == [">= ?", None, 13]
    assert "mind" in times.total.missing


def test_requests_and_answers_of_a_service() -> None:
    nodes = {"ask @pc": "rate: 10 Hz, wcet: 1 ms", "tell @pc": "wcet: 4 ms"}
    rest = "hosts: {pc: {cores: 1}}\nuse_cases: {UC-1: {steps: [{from: ask, to: tell}, {from: tell, to: ask}]}}"
    architecture = read_sketch(nodes, "ask?tell", rest)
    times = bound_use_cases(analyse_architecture(architecture), architecture)["UC-1"]
    # The request begins with the client's own gap and response; its next activation takes the answer.
    assert [_ms(value) for value in times.steps] == [110, 105]


TWO_NODES = """
groups:
  g:
    components:
      eye: {outputs: {o: T}}
      brain: {inputs: {i: eye.o}, outputs: {o: T}}
      hand: {inputs: {i: brain.o}, outputs: {m: {type: M, medium: physical, external: it moves}}}
nodes:
  eye: {implements: eye, host: pc, timing: {rate: 10 Hz, wcet: 1 ms}}
  early: {implements: brain, host: pc, subscribes: {i: {}}, internal: {publishes: {mid: {topic: mid, message: std_msgs/msg/Empty}}}, timing: {behaviour: event, trigger: [i], wcet: 2 ms}}
  late: {implements: brain, host: pc, publishes: {o: {}}, internal: {subscribes: {mid: {topic: mid, message: std_msgs/msg/Empty}}}, timing: {rate: 50 Hz, wcet: 3 ms}}
  hand: {implements: hand, host: pc, timing: {rate: 50 Hz, wcet: 4 ms}}
hosts: {pc: {cores: 4}}
types: {T: std_msgs/msg/String}
chains: {c: {through: [eye, early, late, hand]}}
use_cases: {UC-1: {actors: {w: W}, steps: [{from: eye, to: brain}, {from: brain, to: hand}, {from: hand, to: w}]}}
"""


def test_the_way_inside_of_a_component_of_two_nodes_counts(derived: Callable[[str], Architecture]) -> None:
    architecture = derived(TWO_NODES)
    analysis = analyse_architecture(architecture)
    times = bound_use_cases(analysis, architecture)["UC-1"]
    assert times.total == bound_all_chains(analysis, architecture)["c"].bound
    assert times.steps[2] is None


def test_without_a_way_inside_nothing_is_promised(derived: Callable[[str], Architecture]) -> None:
    cut = TWO_NODES.replace("internal: {subscribes: {mid: {topic: mid, message: std_msgs/msg/Empty}}}, ", "")
    architecture = derived(cut)
    times = bound_use_cases(analyse_architecture(architecture), architecture)["UC-1"]
    assert times.steps[1] is not None
    assert (times.steps[1].complete, times.steps[1].missing) == (False, ("late",))


def test_a_project_without_steps_costs_nothing() -> None:
    architecture = read_sketch(NODES, WIRES, "hosts: {pc: {cores: 1}, arm: {cores: 1}}\nuse_cases: {UC-1: Plain}")
    assert bound_use_cases(analyse_architecture(architecture), architecture) == {}
