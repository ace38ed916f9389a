"""What fires what: the order, rings that never rest, rings that never start, and what waits for ever."""

from __future__ import annotations

import pytest

from archgen.timing.system.system_builder import build_system
from archgen.timing.system.trigger_graph import TriggerGraph, find_triggers
from tests.timing.sketches import read_sketch


def _graph(nodes: dict[str, str], wires: str) -> TriggerGraph:
    return find_triggers(build_system(read_sketch(nodes, wires))[0])


PERIODIC, ANY, EVENT = "period: 10 ms", "", "behaviour: event"


@pytest.mark.parametrize(
    ("nodes", "wires", "endless", "deadlocked", "unknown", "never", "open_inputs"),
    [
        # A ring that something starts runs for ever; one that nothing starts is taken to run as well.
        ({"s": PERIODIC, "a": ANY, "b": ANY}, "s>a b>a a>b", "a b", "", "a b", "", ""),
        ({"a": ANY, "b": ANY, "c": ANY}, "a>b b>a b>c", "a b", "", "a b", "a b c", ""),
        ({"s": PERIODIC, "a": ANY}, "s>a a>a", "a", "", "a", "", ""),
        # What thins the events lets them die out.
        ({"s": PERIODIC, "a": "every: 2", "b": ANY}, "s>a b>a a>b", "", "", "a b", "", ""),
        ({"s": PERIODIC, "a": "outputs: {out: {conditional: true}}", "b": ANY}, "s>a b>a a>b", "", "", "a b", "", ""),
        # A stated period, a clock or a sampled input open the ring.
        ({"s": PERIODIC, "a": "behaviour: event, period: 5 ms", "b": ANY}, "s>a b>a a>b", "", "", "", "", ""),
        ({"s": PERIODIC, "a": "trigger: [s]", "b": ANY}, "s>a b>a a>b", "", "", "", "", ""),
        # All-of: gated by an input from outside of the ring, unless that is sent only once.
        ({"s": PERIODIC, "a": "trigger: {all: [s, b]}", "b": ANY}, "s>a b>a a>b", "", "a b", "", "a b", "a:b"),
        (
            {"s": PERIODIC, "t": PERIODIC, "a": "trigger: {all: [s, b]}", "b": ANY},
            "s>a b>a a>b t>b",
            "",
            "",
            "",
            "",
            "a:b",
        ),
        (
            {"s": "behaviour: once", "t": PERIODIC, "a": "trigger: {all: [s, b]}", "b": ANY},
            "s>a b>a a>b t>b",
            "a b",
            "",
            "a b",
            "",
            "",
        ),
        ({"a": "trigger: {all: [b]}", "b": "trigger: {all: [a]}"}, "b>a a>b", "", "a b", "a b", "a b", ""),
        ({"a": "trigger: {all: [a]}"}, "a>a", "", "a", "a", "a", ""),
        # What waits for a ring that never starts is no part of it, even where it is in a ring with what does fire.
        (
            {"t": PERIODIC, "a": "trigger: {all: [b, d]}", "b": ANY, "d": "trigger: {all: [d]}"},
            "t>b a>b b>a d>a d>d",
            "",
            "d",
            "d",
            "a d",
            "a:b",
        ),
        # An input that nothing feeds: all-of waits for ever, unless the input is optional or fed from outside.
        ({"s": PERIODIC, "a": "trigger: {all: [s, x]}", "b": ANY}, "s>a x>a a>b", "", "", "", "", ""),
        ({"s": PERIODIC, "a": EVENT}, "s>a", "", "", "", "", ""),
        ({"a": EVENT, "b": ANY}, "a>b", "", "", "", "", ""),
        # Calls fire servers; a caller that calls less than once lets the ring die out.
        ({"s": PERIODIC, "a": ANY, "v": EVENT, "b": ANY}, "s>a v>b b>a a?v", "a v b", "", "a b v", "", ""),
        ({"s": PERIODIC, "a": "calls: {v: 0.5}", "v": EVENT, "b": ANY}, "s>a v>b b>a a?v", "", "", "a b v", "", ""),
        ({"s": PERIODIC, "a": "calls: {v: 2}", "v": EVENT, "b": ANY}, "s>a v>b b>a a?v", "a v b", "", "a b v", "", ""),
        ({"s": PERIODIC, "v": "period: 9 ms"}, "s?v", "", "", "", "", ""),
        ({"a": ANY, "b": ANY, "v": ANY}, "a>b b>a a?v", "a b", "", "a b", "a b v", ""),
        ({"v": "behaviour: on_demand"}, "", "", "", "", "", ""),
    ],
)
def test_rings_and_what_never_fires(  # noqa: PLR0913, PLR0917 - a row of a table
    nodes: dict[str, str], wires: str, endless: str, deadlocked: str, unknown: str, never: str, open_inputs: str
) -> None:
    graph = _graph(nodes, wires)
    assert [" ".join(ring) for ring in graph.endless_rings] == ([endless] if endless else [])
    assert [" ".join(ring) for ring in graph.deadlocked_rings] == ([deadlocked] if deadlocked else [])
    assert " ".join(sorted(graph.unknown_rates)) == unknown
    assert " ".join(sorted(graph.never_firing)) == never
    assert " ".join(f"{name}:{key.rpartition('.')[2]}" for name, key in sorted(graph.open_inputs)) == open_inputs


def test_each_activity_is_behind_those_that_fire_it() -> None:
    graph = _graph({"d": ANY, "c": ANY, "b": ANY, "a": PERIODIC}, "a>b b>c c>d a>d")
    assert graph.order == ("a", "b", "c", "d")
    gated = _graph({"b": ANY, "a": "trigger: {all: [s, b]}", "t": PERIODIC, "s": PERIODIC}, "s>a b>a a>b t>b")
    assert gated.order.index("a") < gated.order.index("b")


def test_inputs_and_requests_hold_the_arcs_that_fire() -> None:
    graph = _graph({"s": PERIODIC, "a": "trigger: [s]", "b": "period: 5 ms", "v": ANY}, "s>a b>a s>b a?v b?v s?b")
    assert {name: {key: len(arcs) for key, arcs in inputs.items()} for name, inputs in graph.inputs.items()} == {
        "s": {},
        "a": {"g.a.s": 1},
        "b": {},
        "v": {},
    }
    assert {name: [arc.source for arc in arcs] for name, arcs in graph.requests.items()} == {
        "s": [],
        "a": [],
        "b": [],
        "v": ["a", "b"],
    }
