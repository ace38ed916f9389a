"""Schedules worked out by hand: seed 0 releases everything at zero and takes the longest execution times."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from archgen.simulation import simulate_system
from archgen.timing.run_analysis import analyse_system
from archgen.timing.system.timing_system import ResourceUse, SharedResource
from tests.simulation.systems import arc, call, event, jobs, system, timed


def test_fixed_priorities_preempt() -> None:
    #  fast 0-1     4-5     8-9
    #  slow    1-4     5-7          six of work, begun at 1, ended at 7
    found = jobs(system([timed("slow", 20, 5, host="h", priority=1), timed("fast", 4, 1, host="h", priority=9)]), 10)
    assert found["fast"] == [(0, 0, 1), (4, 4, 5), (8, 8, 9)]
    assert found["slow"] == [(0, 1, 7)]


def test_who_has_no_priority_comes_after_all_that_have() -> None:
    found = jobs(system([timed("plain", 20, 3, host="h"), timed("ranked", 4, 2, host="h", priority=1)]), 10)
    assert found["plain"] == [(0, 2, 7)]


def test_two_cores_serve_the_two_most_urgent() -> None:
    activities = [timed(name, 20, 4, host="h", priority=p) for p, name in enumerate(("c", "b", "a"))]
    found = jobs(system(activities, cores={"h": 2}), 10)
    assert found == {"a": [(0, 0, 4)], "b": [(0, 0, 4)], "c": [(0, 4, 8)]}


def test_a_pinned_core_is_kept() -> None:
    activities = [
        timed("pinned", 20, 4, host="h", cores=(0,)),
        timed("x", 20, 3, host="h"),
        timed("y", 20, 3, host="h"),
    ]
    found = jobs(system(activities, cores={"h": 2}), 19)
    assert found["pinned"] == [(0, 0, 4)]
    assert sorted(found["x"] + found["y"]) == [(0, 0, 3), (0, 3, 6)]


def test_where_no_core_is_left_the_rest_runs_between_what_is_pinned() -> None:
    activities = [
        timed("p0", 20, 4, host="h", cores=(0,)),
        timed("p1", 20, 2, host="h", cores=(1,)),
        timed("x", 20, 3, host="h"),
    ]
    found = jobs(system([*activities[:2], timed("x", 20, 3, host="h")], cores={"h": 2}), 19)
    together = {name: one[0][1:] for name, one in found.items()}
    assert together in (
        {"p0": (0, 4), "p1": (0, 2), "x": (2, 5)},
        {"p0": (3, 7), "p1": (0, 2), "x": (0, 3)},
        {"p0": (0, 4), "p1": (3, 5), "x": (0, 3)},
    )


def test_an_executor_serves_those_that_it_saw_before_it_looks_again() -> None:
    # At 0 both clocks are ready. `a` ends at 3 and fires `e`; the clock `b` was seen before it, and comes first.
    activities = [
        timed("a", 20, 3, host="h", container="box"),
        timed("b", 20, 2, host="h", container="box"),
        event("e", 1, "a", host="h", container="box"),
    ]
    found = jobs(system(activities, [arc("a", "e")], threads={"box": 1}), 19)
    first, second = sorted(found["a"] + found["b"], key=lambda job: job[1])
    assert (first[1], second[2]) == (0, 5)
    assert found["e"][0][1] == 5


def test_an_executor_does_not_preempt_itself() -> None:
    activities = [
        timed("long", 40, 10, host="h", container="box", priority=1),
        timed("short", 4, 1, host="h", container="box", priority=9),
    ]
    found = jobs(system(activities, threads={"box": 1}), 39)
    start, end = found["long"][0][1:]
    assert end - start == 10


def test_a_container_of_two_threads_runs_two_at_once() -> None:
    activities = [timed(name, 40, 4, host="h", container="box") for name in "abc"]
    found = jobs(system(activities, cores={"h": 4}, threads={"box": 2}), 39)
    assert sorted(job for one in found.values() for job in one) == [(0, 0, 4), (0, 0, 4), (0, 4, 8)]


def test_all_of_waits_for_the_last_and_clears() -> None:
    found = jobs(
        system(
            [timed("fast", 4, 0), timed("slow", 10, 0), event("both", 1, "fast", "slow", mode="all")],
            [arc("fast", "both"), arc("slow", "both")],
        ),
        25,
    )
    assert [job[0] for job in found["both"]] == [0, 10, 20]


def test_any_of_fires_for_each() -> None:
    found = jobs(
        system(
            [timed("fast", 4, 0), timed("slow", 10, 0), event("any", 1, "fast", "slow")],
            [arc("fast", "any", depth=5), arc("slow", "any", depth=5)],
        ),
        11,
    )
    assert found["any"] == [(0, 0, 1), (0, 1, 2), (4, 4, 5), (8, 8, 9), (10, 10, 11)]


def test_every_third_and_throttle() -> None:
    arcs = [arc("clock", "third"), arc("clock", "slowed")]
    activities = [timed("clock", 4, 0), event("third", 1, "clock", every=3), event("slowed", 1, "clock", throttle=10)]
    found = jobs(system(activities, arcs), 40)
    assert {b - a for (a, _, _), (b, _, _) in zip(found["third"], found["third"][1:], strict=False)} == {12}
    assert [job[0] for job in found["slowed"]] == [0, 12, 24, 36]


def test_a_full_queue_drops_the_oldest() -> None:
    # The reader takes 10 for each of what comes every 4; it keeps two.
    from archgen.simulation import simulate_system

    one = system([timed("clock", 4, 0), event("reader", 10, "clock")], [arc("clock", "reader", depth=2)])
    seen = simulate_system(one, 1, 1)
    assert seen.drops == {("reader", "clock", "/clock"): 251 - 101 - 2}


def test_a_caller_calls_at_its_end_and_does_not_wait() -> None:
    #  client 0-2, server 2-5
    found = jobs(
        system([timed("client", 20, 2), event("server", 3, behaviour="on_demand")], call("client", "server")), 19
    )
    assert found == {"client": [(0, 0, 2)], "server": [(2, 2, 5)]}


def test_fractions_of_calls_are_spread_evenly() -> None:
    activities = [timed("client", 20, 2, calls={"ask": Fraction(5, 2)}), event("server", 1, behaviour="on_demand")]
    fired = [job[0] for job in jobs(system(activities, call("client", "server")), 79)["server"]]
    assert sorted(fired.count(at) for at in (2, 22)) == [2, 3]
    assert len(fired) == 10


def test_a_link_takes_its_latency() -> None:
    found = jobs(system([timed("a", 20, 1), event("b", 1, "a")], [arc("a", "b", link="lan", best=3, worst=3)]), 19)
    assert found["b"] == [(4, 4, 5)]


def test_messages_queue_for_the_bandwidth() -> None:
    # 1000 B at 500 kB/s take 2 ms each; three are sent at once.
    activities = [timed(name, 20, 0) for name in "abc"] + [event("r", 0, "a", "b", "c")]
    arcs = [arc(name, "r", link="lan", best=None, worst=None, size=1000, depth=5) for name in "abc"]
    found = jobs(system(activities, arcs, bandwidths={"lan": Fraction(500_000)}), 19)
    assert [job[0] for job in found["r"]] == [2, 4, 6]


def test_a_latency_of_which_only_the_best_is_known_is_never_shorter() -> None:
    found = jobs(system([timed("a", 20, 1), event("b", 1, "a")], [arc("a", "b", link="lan", best=3, worst=None)]), 19)
    assert found["b"] == [(4, 4, 5)]


def test_a_computed_latency_is_tried_out_and_not_taken() -> None:
    # 1000 B at 500 kB/s take 2 ms, and all takes 3 besides; that the analysis allows for 33 slows nothing down.
    activities = [timed(name, 20, 0) for name in "ab"] + [event("r", 0, "a", "b")]
    arcs = [arc(name, "r", link="lan", best=3, worst=33, size=1000, depth=5) for name in "ab"]
    found = jobs(system(activities, arcs, bandwidths={"lan": Fraction(500_000)}, queued_links=frozenset({"lan"})), 19)
    assert [job[0] for job in found["r"]] == [5, 7]


def test_calls_and_answers_queue_for_the_bandwidth_as_well() -> None:
    #  link: a's 0-2, the call (of 1) 2-4, the answer (of 5) 5-7, b's (of 6) 7-9
    activities = [timed("a", 20, 0), timed("b", 20, 6), timed("client", 20, 1), event("r", 0, "a", "b")]
    way = {"link": "lan", "best": None, "worst": None, "size": 1000}
    arcs = [*(arc(name, "r", **way) for name in "ab"), *(replace(one, **way) for one in call("client", "server"))]  # type: ignore[arg-type]
    of = system([*activities, event("server", 1, behaviour="on_demand")], arcs, bandwidths={"lan": Fraction(500_000)})
    found = jobs(of, 19)
    assert found["server"] == [(4, 4, 5)]
    assert [job[0] for job in found["r"]] == [2, 9]


def test_a_declared_response_is_kept_whatever_the_load() -> None:
    activities = [timed("busy", 10, 8, host="h"), timed("declared", 10, 1, host="h", response=5)]
    found = jobs(system(activities), 29)
    assert [end - fired for fired, _, end in found["declared"]] == [5, 5, 5]


def test_a_declared_response_is_no_shorter_than_the_execution_and_the_uses_in_it() -> None:
    """2 ms and a use of 4 ms; of a response below that nothing but itself is left."""
    gpu = {"gpu": SharedResource("gpu", "h", None)}
    for response, shortest in ((9, 6), (5, 5)):
        one = timed("declared", 10, 2, host="h", response=response, uses={"gpu": ResourceUse(4, 4)})
        of = system([replace(one, bcet=2)], resources=gpu)
        assert simulate_system(of, 1, 8).activities["declared"].best_response == shortest * 10**6
        assert analyse_system(of).responses["declared"].best.value == shortest * 10**6


def test_what_is_published_once_is_always_there() -> None:
    once = event("map", 5, behaviour="once")
    activities = [once, timed("clock", 10, 0), event("both", 1, "map", "clock", mode="all")]
    found = jobs(system(activities, [arc("map", "both"), arc("clock", "both")]), 25)
    assert [job[0] for job in found["both"]] == [0, 10, 20]


def test_a_throttle_counts_from_what_it_let_through_not_from_when_jitter_let_it_go() -> None:
    # Every tick of 10 is held back by up to 12; of each three one gets through.
    activities = [timed("clock", 10, 0), event("slowed", 1, "clock", throttle=30, jitter=12)]
    found = jobs(system(activities, [arc("clock", "slowed")]), 299)["slowed"]
    assert [fired for fired, _, _ in found] == [12 + 30 * at for at in range(10)]


def test_what_jitter_holds_back_enters_the_queue_when_it_is_let_go() -> None:
    activities = [timed("clock", 4, 0), event("late", 1, "clock", jitter=10)]
    found = jobs(system(activities, [arc("clock", "late", depth=1)]), 23)["late"]
    assert [fired for fired, _, _ in found] == [10, 14, 18, 22]


def test_events_from_outside_come_at_the_period_that_is_stated() -> None:
    found = jobs(system([event("bumper", 1, "world", period=8)], external_inputs={"bumper": ("world",)}), 20)
    assert found["bumper"] == [(0, 0, 1), (8, 8, 9), (16, 16, 17)]


def test_a_container_without_a_host_has_a_core_of_its_own_for_each_thread() -> None:
    activities = [timed(name, 40, 4, container="box") for name in "abc"]
    one, two = (jobs(system(activities, threads={"box": threads}), 39) for threads in (1, 2))
    assert sorted(job for each in one.values() for job in each) == [(0, 0, 4), (0, 4, 8), (0, 8, 12)]
    assert sorted(job for each in two.values() for job in each) == [(0, 0, 4), (0, 0, 4), (0, 4, 8)]
