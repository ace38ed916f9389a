"""What fires what inside a core; the cascades of what enters it, their work in a window, and the ways through them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.inner_core import InnerCore, prepare_inner_core, rank_threads, urgency_of
from archgen.timing.load.inner_triggers import find_inner_triggers
from archgen.timing.load.level_cascades import CascadeDemand, EventOrigin, GateRule, find_run_arcs
from archgen.timing.system.core_placement import find_resources
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.trigger_graph import find_triggers
from tests.timing.sketches import read_sketch


def prepare(nodes: dict[str, str], wires: str, rest: str = "hosts: {pc: {cores: 1}}") -> InnerCore:
    """Return the first core of a sketch."""
    system, _ = build_system(read_sketch(nodes, wires, rest))
    resource = find_resources(system)[0]
    inner_triggers = find_inner_triggers(system, find_triggers(system), resource)
    assert inner_triggers is not None
    return prepare_inner_core(system, resource, inner_triggers)


TIMER, EVENT = "period: 100 ms, wcet: 1 ms", "behaviour: event, trigger: any, wcet: 1 ms"


@pytest.mark.parametrize("rest", [{"joined": True}, {"missing": ("cores",)}, {"waits": True}])
def test_each_activity_is_looked_at_by_itself_where_cores_are_joined_or_not_known_or_threads_wait(
    rest: dict[str, object],
) -> None:
    system, _ = build_system(read_sketch({"s @pc": TIMER, "a @pc": EVENT}, "s>a", "hosts: {pc: {cores: 1}}"))
    (resource,) = find_resources(system)
    assert find_inner_triggers(system, find_triggers(system), resource) is not None
    assert find_inner_triggers(system, find_triggers(system), replace(resource, **rest)) is None  # type: ignore[arg-type]


def list_ways(core: InnerCore) -> list[str]:
    """Return the ways to each activity: `origin: steps (how often)`."""
    return [
        f"{way.entry.kind} {way.entry.key}: {' '.join(way.steps)} x{way.multiplicity}"
        for ways in core.ways_to.values()
        for way in ways
    ]


def test_an_event_leads_to_all_that_is_fired_without_taking_time() -> None:
    core = prepare({"s @pc": TIMER, "a @pc": EVENT, "b @pc": EVENT}, "s>a a>b s>b")
    assert list_ways(core) == ["activity s: s x1", "activity s: s a x1", "activity s: s a b x1", "activity s: s b x1"]
    # s, a, and b twice.
    assert core.levels[None].volumes == {EventOrigin("activity", "s"): 4 * (core.system.activities["s"].wcet or 0)}


@pytest.mark.parametrize(
    ("timing", "rule"),
    [
        ("every: 3", GateRule(({EventOrigin("activity", "s"): 1},), every=3)),
        ("throttle: 30 ms", GateRule(({EventOrigin("activity", "s"): 1},), throttle=30)),
    ],
)
def test_a_gate_begins_a_way_of_its_own(timing: str, rule: GateRule) -> None:
    core = prepare({"s @pc": TIMER, "a @pc": f"{EVENT}, {timing}"}, "s>a")
    assert list_ways(core) == ["activity s: s x1", "activity a: a x1"]
    assert [found._replace(throttle=min(found.throttle, 30)) for found in core.levels[None].gate_rules] == [rule]
    assert find_run_arcs(core.inner_triggers, core.ways_to) == {}


def test_an_activity_to_which_too_many_ways_lead_ends_all_runs() -> None:
    """Nine ways to b: it begins one of its own, and no run continues to it."""
    nodes = {f"s{at} @pc": TIMER for at in range(9)} | {"b @pc": EVENT}
    core = prepare(nodes, " ".join(f"s{at}>b" for at in range(9)))
    assert list_ways(core)[-1] == "activity b: b x1"
    assert find_run_arcs(core.inner_triggers, core.ways_to) == {}


def test_calls_come_as_often_as_they_are_made() -> None:
    core = prepare({"s @pc": f"{TIMER}, calls: {{v: 2}}", "v @pc": "wcet: 1 ms"}, "s?v")
    assert list_ways(core) == ["activity s: s x1", "activity s: s v x2"]


@pytest.mark.parametrize(
    ("nodes", "wires", "rest"),
    [
        ({"s @pc": TIMER, "a @pc": TIMER}, "s>a", "hosts: {pc: {cores: 1}}"),
        ({"s @pc": f"{TIMER}, response: 9 ms", "a @pc": EVENT}, "s>a", "hosts: {pc: {cores: 1}}"),
        ({"s @pc": TIMER, "a @pc": f"{EVENT}, jitter: 1 ms"}, "s>a", "hosts: {pc: {cores: 1}}"),
    ],
    ids=["timers", "a declared response may leave the core", "jitter"],
)
def test_nothing_is_fired_inside(nodes: dict[str, str], wires: str, rest: str) -> None:
    system, _ = build_system(read_sketch(nodes, wires, rest))
    assert find_inner_triggers(system, find_triggers(system), find_resources(system)[0]) is None


def test_ranked_cores_on_which_others_may_run_are_looked_at_activity_by_activity() -> None:
    """While `f` keeps another core busy, `low` may end here and fire `high` again and again."""
    nodes = {
        "s @pc": f"{TIMER}, core: 0, priority: 9",
        "low @pc": f"{EVENT}, core: 0, priority: 1",
        "high @pc": f"{EVENT}, core: 0, priority: 8",
        "other @pc": f"{TIMER}, core: 1, priority: 5",
        "f @pc": f"{TIMER}, priority: 5",
    }
    system, _ = build_system(read_sketch(nodes, "s>low low>high", "hosts: {pc: {cores: 2}}"))
    assert find_inner_triggers(system, find_triggers(system), find_resources(system)[0]) is None


def test_what_is_less_urgent_counts_once() -> None:
    core = prepare(
        {"s @pc": f"{TIMER}, priority: 5", "low @pc": f"{EVENT}, priority: 1", "high @pc": f"{EVENT}, priority: 5"},
        "s>low low>high",
    )
    assert list(core.levels) == [5, 1]
    cost = core.system.activities["s"].wcet
    assert core.levels[5].volumes == {EventOrigin("activity", "s"): cost, EventOrigin("once", 0): cost}
    assert core.levels[1].volumes == {EventOrigin("activity", "s"): 3 * (cost or 0)}


@pytest.mark.parametrize(
    ("rule", "counts", "window", "leaving"),
    [
        (GateRule(({}, {})), [4, 7], 10, 5),  # one may have come before, of the input that comes less often
        (GateRule(({}, {})), [0, 0], 10, 0),
        (GateRule(({},), every=3), [7], 10, 3),
        (GateRule(({},), throttle=4), [7], 9, 3),
        (GateRule(({},), every=2, throttle=4), [5], 9, 3),
        (GateRule(({},), is_complete=False), [7], 10, 8),
    ],
)
def test_a_gate_lets_through_no_more_than_its_inputs_allow(
    rule: GateRule, counts: list[int], window: int, leaving: int
) -> None:
    assert rule.count_leaving(counts, window) == leaving


def test_the_demand_of_cascades_is_counted_over_the_window() -> None:
    """S comes every 10: s and a each time, b each third time, whatever the phase."""
    core = prepare({"s @pc": TIMER, "a @pc": EVENT, "b @pc": f"{EVENT}, every: 3"}, "s>a a>b")
    cost = core.system.activities["s"].wcet or 0
    demand = CascadeDemand(core.levels[None], lambda _: (EventStream(10),))
    within = demand.demand_function().within
    assert [within(window) // cost for window in (1, 10, 11, 30, 31, 61)] == [3, 3, 5, 7, 10, 17]
    # Two each 10, and a third each 30.
    assert demand.share() == Fraction(2, 10) * cost + Fraction(1, 30) * cost
    assert demand.has_gates


def test_threads_are_ranked_by_what_is_written() -> None:
    system, _ = build_system(
        read_sketch(
            {"a +box": "priority: 9, wcet: 1 ms", "b +box": "priority: 2, wcet: 1 ms"},
            "",
            "containers: {box: {threads: 1}}",
        )
    )
    (thread,) = rank_threads(system, [("a", "b")], ())
    assert (thread.lowest_priority, thread.highest_priority, urgency_of(None), urgency_of(3)) == (2, 9, -1, 3)
