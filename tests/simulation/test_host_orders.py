"""Orders of hosts and cores, sets of cores and resources: schedules worked out by hand."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.simulation import simulate_system
from archgen.simulation.event_loop import process_events
from archgen.simulation.plan_builder import build_plan
from archgen.simulation.simulation_run import SimulationRun
from archgen.timing.system.timing_system import Activity, ResourceUse, SharedResource, TimingSystem
from tests.simulation.systems import MS, arc, event, jobs, process, system, timed, within


def run(of: TimingSystem, until: int, *, slice_time: int = 0, **phases: int) -> dict[str, list[tuple[float, float]]]:
    """Run a system with phases in ms; give (started, ended) in ms."""
    plan = build_plan(of)
    one = SimulationRun(plan, 0, range(len(plan.activities)))
    one.activities.phase = [phases.get(planned.id, 0) * MS for planned in plan.activities]
    if slice_time:
        one.processors.slice_time = [slice_time * MS for _ in plan.processors]
    process_events(one, until * MS)
    return {
        planned.id: [
            (start / MS, end / MS)
            for start, end in zip(one.activities.job_starts[at], one.activities.job_ends[at], strict=False)
        ]
        for at, planned in enumerate(plan.activities)
    }


def on(host: str, *activities: Activity) -> list[Activity]:
    return [replace(one, host=host) for one in activities]


THREE = on("h", timed("low", 100, 5, priority=1), timed("mid", 100, 2, priority=5), timed("high", 100, 3, priority=9))


@pytest.mark.parametrize(
    ("order", "expected"),
    [
        # low begins at 0, high comes at 1 and mid at 2
        ("fixed_priority", {"low": (0, 10), "high": (1, 4), "mid": (4, 6)}),
        ("non_preemptive", {"low": (0, 5), "high": (5, 8), "mid": (8, 10)}),
        ("fifo", {"low": (0, 5), "high": (5, 8), "mid": (8, 10)}),
    ],
)
def test_orders_of_a_host(order: str, expected: dict[str, tuple[int, int]]) -> None:
    of = system(THREE, cores={"h": 1}, host_orders={"h": order})
    assert {name: one[0] for name, one in run(of, 50, high=1, mid=2).items()} == expected


def test_first_come_is_first_served_whatever_the_priority() -> None:
    of = system(THREE, cores={"h": 1}, host_orders={"h": "fifo"})
    assert run(of, 50, low=0, mid=1, high=2) == {"low": [(0, 5)], "mid": [(5, 7)], "high": [(7, 10)]}


def test_the_earliest_deadline_preempts_and_who_has_none_comes_last() -> None:
    # At 0: long until 30 and `plain` without any. At 2: short until 12. long 0-2 and 5-9, plain 9-10.
    of = system(
        on(
            "h",
            timed("long", 100, 6, deadline=30),
            timed("short", 100, 3, deadline=10),
            timed("clock", 100, 0, priority=1),
            event("plain", 1, "clock"),
        ),
        [arc("clock", "plain")],
        {"h": 1},
        host_orders={"h": "edf"},
    )
    found = run(of, 50, short=2)
    assert (found["long"], found["short"], found["plain"]) == ([(0, 9)], [(2, 5)], [(9, 10)])


def test_the_period_is_the_deadline_where_none_is_written() -> None:
    of = system(on("h", timed("slow", 20, 4), timed("quick", 10, 4)), cores={"h": 1}, host_orders={"h": "edf"})
    assert run(of, 9) == {"slow": [(4, 8)], "quick": [(0, 4)]}


def test_turns_of_two_milliseconds() -> None:
    # a 0-2, b 2-4, a 4-6, b 6-7 (3 in all), a 7-8 (5 in all)
    of = system(on("h", timed("a", 100, 5), timed("b", 100, 3)), cores={"h": 1}, host_orders={"h": "round_robin"})
    found = run(of, 50, slice_time=2, b=1)
    assert found == {"a": [(0, 8)], "b": [(2, 7)]}


def test_alone_a_slice_goes_on() -> None:
    of = system(on("h", timed("a", 100, 5)), cores={"h": 1}, host_orders={"h": "round_robin"})
    assert run(of, 50, slice_time=2) == {"a": [(0, 5)]}


def test_a_core_may_have_another_order_than_its_host() -> None:
    low, high = timed("low", 100, 5, priority=1, cores=(1,)), timed("high", 100, 3, priority=9, cores=(1,))
    of = system(on("h", low, high), cores={"h": 2}, host_orders={"h": "fixed_priority"})
    assert run(of, 50, high=1)["high"] == [(1, 4)]
    of = replace(of, core_orders={("h", 1): "non_preemptive"})
    assert run(of, 50, high=1)["high"] == [(5, 8)]


def test_a_set_of_cores_is_all_that_a_thread_uses() -> None:
    # Three of 4 ms on the cores 2 and 3 of four: the least urgent waits, though two cores are idle.
    set_of_two = [timed(name, 100, 4, priority=p, cores=(2, 3)) for p, name in enumerate("abc")]
    found = run(system(on("h", *set_of_two), cores={"h": 4}), 50)
    assert found == {"c": [(0, 4)], "b": [(0, 4)], "a": [(4, 8)]}


def test_no_core_of_a_set_idles_while_a_thread_waits_that_may_use_it() -> None:
    # `one` may run on core 0 alone, `two` on both. Nobody moves what runs to make room for a thread that may not go elsewhere.
    threads = on(
        "h",
        timed("two", 100, 6, priority=9, cores=(0, 1)),
        timed("one", 100, 3, priority=5, cores=(0,)),
        timed("other", 100, 2, priority=7, cores=(1,)),
    )
    assert run(system(threads, cores={"h": 2}), 50) == {"two": [(0, 6)], "one": [(6, 9)], "other": [(0, 2)]}
    assert run(system(threads, cores={"h": 2}), 50, two=1)["one"] == [(0, 9)]


def test_a_core_outside_of_its_host_is_no_pin() -> None:
    pinned = timed("pinned", 100, 4, cores=(1, 7), priority=2)
    found = run(system(on("h", pinned, timed("x", 100, 4, priority=1)), cores={"h": 2}), 50)
    assert found == {"pinned": [(0, 4)], "x": [(0, 4)]}


GPU = {"gpu": SharedResource("gpu", "h", "fifo")}


def test_who_waits_for_a_resource_leaves_its_core() -> None:
    # Two activities alternate: 4 of processor time with 10 of GPU somewhere within, on one core.
    user = timed("user", 100, 4, priority=9, uses={"gpu": ResourceUse(10, 10)})
    of = system(on("h", user, timed("rest", 100, 10, priority=1)), cores={"h": 1}, resources=GPU)
    found = run(of, 50)
    assert found["user"] == [(0, 14)]
    # `rest` works while the GPU does: 10 of its own, and what the user works before that is done, of its 4.
    assert 10 <= found["rest"][0][1] <= 14


def test_a_resource_serves_one_at_a_time_and_its_user_keeps_its_thread() -> None:
    users = [
        timed(name, 100, 0, priority=p, uses={"gpu": ResourceUse(10, 10)}) for p, name in enumerate(("low", "high"))
    ]
    of = system(users, resources={"gpu": SharedResource("gpu", None, "fixed_priority")})
    assert run(of, 50) == {"high": [(0, 10)], "low": [(0, 20)]}
    # On one thread the second job begins only when the first has had its use.
    one_thread = system(within("node", *users), executors=process("node", 1, "non_preemptive"), resources=of.resources)
    assert run(one_thread, 50) == {"high": [(0, 10)], "low": [(10, 20)]}


def test_uses_come_one_after_the_other() -> None:
    user = timed("user", 100, 4, uses={"gpu": ResourceUse(10, 10), "dsp": ResourceUse(5, 5)})
    other = timed("other", 100, 0, uses={"dsp": ResourceUse(30, 30)})
    of = system([user, other], resources=GPU | {"dsp": SharedResource("dsp", None)})
    found = run(of, 80)
    assert found["other"] == [(0, 30)]
    #  at most 4 of work and 10 of GPU before the wait for the other, 5 of its own and the rest of the work after it
    assert 35 <= found["user"][0][1] <= 39


def test_every_draw_of_a_use_is_between_its_best_and_its_worst() -> None:
    user = timed("user", 100, 4, uses={"gpu": ResourceUse(10, 3)})
    seen = simulate_system(system([user], resources=GPU), 5, 8).activities["user"]
    assert (seen.best_response, seen.worst_response) == (7 * 10**6, 14 * 10**6)


def test_a_turn_around_of_processor_and_gpu() -> None:
    # 5 of work and 12 of one GPU each, both released at zero: the later one has waited for the GPU at least 7.
    users = [timed(name, 100, 5, uses={"gpu": ResourceUse(12, 12)}, host="h") for name in "ab"]
    found = run(system(users, cores={"h": 2}, resources=GPU), 80)
    ends = sorted(one[0][1] for one in found.values())
    assert ends[0] == 17
    assert 24 <= ends[1] <= 34


def test_a_node_pinned_to_a_set_and_one_without_a_pin_share_its_cores() -> None:
    threads = [timed("pinned", 100, 4, priority=2, cores=(0, 1)), timed("free", 100, 4, priority=1)]
    assert jobs(system(on("h", *threads), cores={"h": 2}), 50)["free"] == [(0, 0, 4)]
    three = [*threads, timed("more", 100, 4, priority=9)]
    assert jobs(system(on("h", *three), cores={"h": 2}), 50)["free"] == [(0, 4, 8)]
