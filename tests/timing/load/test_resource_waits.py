"""Waits for GPUs: bounds by hand, and held against simulations."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.model.declared_timing import SchedulingOrder
from archgen.simulation import simulate_system
from archgen.timing.load import joined_resources
from archgen.timing.run_analysis import analyse_system
from archgen.timing.system.timing_system import Activity, Arc, Executor, ResourceUse, SharedResource, TimingSystem
from tests.simulation.systems import arc, event, system, timed
from tests.timing.sketches import analyse_sketch


def test_two_threads_that_alternate_a_core_and_a_gpu() -> None:
    """5 ms of processor and 12 ms of one GPU each: all of it in a row is 34 ms."""
    of = _system(_user("a", 50, 5, 12), _user("b", 50, 5, 12))
    assert _responses(of) == {"a": 34, "b": 34}
    assert 29 < max(_seen(of).values()) <= 34


def test_who_does_not_use_the_gpu_has_the_core_meanwhile() -> None:
    """`c` is more urgent, and waits for nobody: the GPU is used beside it."""
    of = _system(_user("a", 100, 5, 50, priority=1), timed("c", 60, 10, host="pc", priority=2))
    assert _responses(of) == {"a": 75, "c": 10}  # 5 + 50 + 2 times 10


def test_in_the_order_of_arrival_each_other_thread_comes_once() -> None:
    """Four on cores of their own. `d` uses the GPU for 1 ms: 30 ms of others, and its own."""
    users = [*(_user(name, 100, 1, 10, host=None) for name in "abc"), _user("d", 10, 1, 1, host=None)]
    assert _waits(_system(*users, order="fifo"), "d") == 31


def test_members_of_one_thread_do_not_wait_for_one_another_at_the_gpu() -> None:
    users = [_user("a", 100, 1, 10, container="box"), _user("b", 100, 1, 20, container="box"), _user("c", 100, 1, 5)]
    of = _system(*users, order="fifo", threads={"box": 1})
    assert (_waits(of, "a"), _waits(of, "c")) == (15, 25)


def test_of_a_container_with_two_threads_the_two_longest_count() -> None:
    users = [_user(name, 1000, 1, use, container="box") for name, use in (("a", 10), ("b", 20), ("d", 30))]
    of = _system(*users, _user("c", 1000, 1, 5), order="fifo", threads={"box": 2})
    assert _waits(of, "c") == 55
    assert _waits(of, "a") == 45  # one other member at a time, and c


def test_by_priority_the_longest_less_urgent_use_blocks_once() -> None:
    users = [_user("a", 100, 1, 10, priority=3, host=None), _user("b", 100, 1, 20, priority=1, host=None)]
    of = _system(*users, _user("c", 100, 1, 30, priority=2, host=None), order="fixed_priority")
    assert _waits(of, "a") == 40


def test_a_reentrant_activity_may_ask_several_times_at_once() -> None:
    """Its executor has three threads: three uses of 10 ms may be before that of `b`, if so many come at once."""
    user = replace(_user("a", 100, 1, 10, host=None), executor="node a")
    other = replace(_user("b", 100, 1, 5, host=None), executor="node b", callback_group="b")
    executors = {"node a": Executor("node a", 3, None), "node b": Executor("node b", 1, None)}
    of = replace(_system(user, other, order="fifo"), executors=executors)
    assert _waits(of, "b") == 15  # what comes in 15 ms and up to its response before is one use
    busy = replace(of, activities={**of.activities, "a": replace(user, period=20, jitter=90)})
    assert _waits(busy, "b") == 35


@pytest.mark.parametrize(("uses", "verdict"), [((12, 9), "overload"), ((10, 10), "bearable")])
def test_load_of_a_gpu(uses: tuple[int, int], verdict: str) -> None:
    analysis = analyse_system(_system(*(_user(name, 20, 1, use) for name, use in zip("ab", uses, strict=True))))
    assert (analysis.resources["gpu"].utilisation.value, analysis.resources["gpu"].verdict) == (
        Fraction(sum(uses), 20),
        verdict,
    )
    assert ("overload" in analysis.responses["a"].worst.assumptions) == (verdict == "overload")


@pytest.mark.parametrize(("threads", "is_full"), [(1, True), (2, False)])
def test_a_thread_that_has_more_to_do_than_it_can_is_overloaded(threads: int, is_full: object) -> None:
    """Twice 5 + 6 ms each 20 ms: too much for one thread, though neither for the core nor for the GPU."""
    users = [_user(name, 20, 5, 6, container="box") for name in "ab"]
    worst = analyse_system(_system(*users, threads={"box": threads})).responses["a"].worst
    assert ("overload" in worst.assumptions) is is_full


def test_a_core_that_waits_and_work_fill_wholly_gives_no_bound_to_who_waits() -> None:
    """Half of 20 ms is that of `a` with its use of the GPU, the other half that of `b`."""
    of = _system(_user("a", 20, 5, 5, priority=1), timed("b", 20, 10, host="pc", priority=2))
    assert _responses(of) == {"a": None, "b": 10}


def test_what_a_waiting_thread_fires_is_bounded_too() -> None:
    """`b` is fired by the end of `a`, which may come R - B later than it might."""
    of = _system(_user("a", 100, 5, 20), event("b", 3, "a", host="pc"), arcs=[arc("a", "b")])
    assert _responses(of) == {"a": 28, "b": 8}
    assert _seen(of)["b"] <= 8


def test_the_bound_names_the_wait() -> None:
    analysis = analyse_system(_system(_user("a", 50, 5, 12), _user("b", 50, 5, 12), order="fifo"))
    assert [reason.text for reason in analysis.responses["a"].reasons][1:] == [
        "waits for gpu, which b uses too, and uses it for 12 ms: 24 ms at most"
    ]


def _user(name: str, period: int, wcet: int, use: int, **rest: object) -> Activity:
    values = {"host": "pc", "uses": {"gpu": ResourceUse(use, use)}, "outputs": ("out",), **rest}
    return timed(name, period, wcet, **values)


def _system(
    *activities: Activity, order: SchedulingOrder | None = None, arcs: list[Arc] | None = None, **rest: object
) -> TimingSystem:
    return system(activities, arcs or (), {"pc": 1}, resources={"gpu": SharedResource("gpu", "pc", order)}, **rest)


def _responses(of: TimingSystem) -> dict[str, Fraction | None]:
    found = analyse_system(of).responses
    return {name: None if one.worst.value is None else one.worst.value / 10**6 for name, one in found.items()}


def _waits(of: TimingSystem, name: str) -> Fraction | None:
    value = analyse_system(of).resources["gpu"].waits[name].value
    return None if value is None else value / 10**6


def _seen(of: TimingSystem) -> dict[str, float]:
    seen = simulate_system(of, 1, 8).activities
    return {name: float((one.worst_response or 0) / 10**6) for name, one in seen.items()}


def test_many_users_of_a_resource_are_joined_one_by_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each with each would be 40 x 40 x 40 times: a file of 100 kB would take half an hour."""
    link_counts: list[int] = []

    def count_links(neighbours: dict[str, list[str]], _: object) -> list[list[str]]:
        link_counts.append(sum(map(len, neighbours.values())))
        return []

    monkeypatch.setattr(joined_resources, "find_strong_components", count_links)
    nodes = {f"n{number} @pc": "period: 100 ms, wcet: 1 ms, uses: {gpu: 1 ms}" for number in range(40)}
    analyse_sketch(nodes, "", "hosts: {pc: {cores: 4}}\nresources: {gpu: {host: pc, scheduling: fifo}}")
    assert 0 < max(link_counts) < 10 * 40 * 40
