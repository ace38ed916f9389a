"""Processes, callback groups and callbacks that store: schedules worked out by hand, all released at zero."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

from archgen.simulation import simulate_system
from archgen.simulation.event_loop import process_events
from archgen.simulation.plan_builder import build_plan
from archgen.simulation.simulation_run import SimulationRun
from archgen.timing.system.timing_system import Activity, TimingSystem
from tests.simulation.systems import MS, arc, call, event, jobs, process, stores, system, timed, within

LIDAR = timed("scan", 100, 1)
FAST, SLOW = event("both.fast", 2, "scan", priority=50), event("both.slow", 60, "scan", priority=90)
TO_BOTH = [arc("scan", "both.fast"), arc("scan", "both.slow")]


def test_a_node_of_two_components_has_one_thread() -> None:
    #  scan 0-1; then slow 1-61 and only then fast 61-63, though there are four cores
    nodes = [LIDAR, *within("both", FAST, SLOW)]
    found = jobs(system(nodes, TO_BOTH, {"cpu": 4}, executors=process("both", 1, "non_preemptive")), 99)
    assert (found["both.slow"], found["both.fast"]) == ([(1, 1, 61)], [(1, 61, 63)])


def test_without_an_order_some_run_sees_the_other_component_first() -> None:
    nodes = [LIDAR, *within("both", FAST, SLOW)]
    seen = simulate_system(system(nodes, TO_BOTH, {"cpu": 4}, executors=process("both")), 1, 20)
    assert seen.activities["both.fast"].worst_response == 62 * 10**6
    assert seen.activities["both.fast"].best_response == 2 * 10**6
    assert seen.activities["both.slow"].worst_response == 62 * 10**6


def test_members_of_one_group_exclude_one_another_on_any_thread() -> None:
    nodes = [LIDAR, *within("both", FAST, SLOW)]
    found = jobs(system(nodes, TO_BOTH, executors=process("both", 2, "non_preemptive")), 99)
    assert (found["both.slow"], found["both.fast"]) == ([(1, 1, 61)], [(1, 61, 63)])


def test_members_of_two_groups_run_side_by_side_if_threads_are_free() -> None:
    nodes = [LIDAR, *within("both", FAST, group="fast"), *within("both", SLOW, group="slow")]
    assert jobs(system(nodes, TO_BOTH, executors=process("both", 2)), 99)["both.fast"] == [(1, 1, 3)]
    alone = jobs(system(nodes, TO_BOTH, executors=process("both", 1, "non_preemptive")), 99)
    assert alone["both.fast"] == [(1, 61, 63)]


def test_a_reentrant_callback_runs_beside_itself() -> None:
    #  10 of work each 4 ms: two threads run two jobs at once, three run three
    nodes = [timed("clock", 4, 0), *within("node", event("work", 10, "clock"), group=None)]
    for threads, starts in ((1, [0, 10, 20]), (2, [0, 4, 10, 14, 20]), (3, [0, 4, 8, 12, 16, 20])):
        of = system(nodes, [arc("clock", "work")], executors=process("node", threads, "fifo"))
        assert [start for _, start, _ in jobs(of, 40)["work"] if start < 21] == starts, threads


def test_what_a_reentrant_job_overtakes_ends_in_its_own_time() -> None:
    # The job of 4 is on its way when the one of 0 ends: both are recorded by their own numbers.
    nodes = [timed("clock", 4, 0), *within("node", event("work", 6, "clock"), group=None)]
    found = jobs(system(nodes, [arc("clock", "work")], executors=process("node", 2, "fifo")), 23)["work"]
    assert found[:3] == [(0, 0, 6), (4, 4, 10), (8, 8, 14)]


def _run(of: TimingSystem, until: int, **phases: int) -> SimulationRun:
    """Run a system with phases in us, recording all."""
    plan = build_plan(of)
    run = SimulationRun(plan, 0, range(len(plan.activities)), range(len(plan.wires)))
    run.activities.phase = [phases.get(planned.id, 0) for planned in plan.activities]
    process_events(run, until)
    return run


def _reads(of: TimingSystem, until: int, wire: int = 0, **phases: int) -> list[int]:
    """Return which job of a wire's source each job of its reader has read."""
    return _run(of, until * MS, **phases).wires.source_log[wire]


READER = replace(timed("reader", 10, 3), storing={"cam": stores()})


def test_a_message_is_read_only_after_the_callback_that_stores_it() -> None:
    # cam ends at 1, 11, 21. The reader works 0-3, and stores the image of 1 at 3: it reads it at 10.
    of = system([timed("cam", 10, 1), *within("node", READER)], [arc("cam", "reader")], executors=process("node"))
    assert _reads(of, 29) == [-1, 0, 1]


def test_storing_takes_its_time_on_the_thread() -> None:
    # The image of 1 is stored from 3 to 11: the second job begins at 11 and reads it.
    slow = replace(READER, storing={"cam": stores(8)})
    of = system([timed("cam", 20, 1), *within("node", slow)], [arc("cam", "reader")], executors=process("node"))
    assert _reads(of, 19) == [-1, 0]
    assert jobs(of, 19)["reader"] == [(0, 0, 3), (10, 11, 14)]


def test_in_the_wait_set_the_clock_comes_before_what_came_earlier() -> None:
    # `busy` works 0-12. The image of 1 and the tick of 10 wait: the tick is served first, and reads nothing.
    busy = timed("busy", 100, 12)
    reader = replace(READER, storing={"cam": stores()})
    nodes = [timed("cam", 100, 1), *within("node", busy, reader)]
    of = system(nodes, [arc("cam", "reader")], executors=process("node", 1, "ros2_executor"))
    assert _reads(of, 29, reader=10 * MS) == [-1, 0]
    # First come, first served: the image is stored before the tick.
    of = replace(of, executors=process("node", 1, "fifo"))
    assert _reads(of, 29, reader=10 * MS) == [0, 0]


def test_a_full_queue_keeps_the_last_messages() -> None:
    # While `busy` works for 9, images come at 2, 4, 6, 8; a depth of 2 keeps those of 6 and 8.
    nodes = [timed("cam", 2, 0), *within("node", timed("busy", 100, 9), replace(READER, period=100))]
    of = system(nodes, [arc("cam", "reader", depth=2)], executors=process("node", 1, "fifo"))
    run = _run(of, 10 * MS, cam=2 * MS, reader=9 * MS)
    assert run.wires.drop_count[0] == 2
    assert run.wires.source_log[0] == [3]


def test_an_answer_waits_for_its_turn_at_the_client() -> None:
    # The answer is there at 6; `busy` works from 5 to 12 on the client's thread, and the tick of 10 comes first: so does
    # the job of 12, and that of 20 has the answer to it.
    client, busy = timed("client", 10, 2), timed("busy", 100, 7)
    nodes = [*within("node", client, busy), event("server", 4, behaviour="on_demand")]
    of = system(nodes, call("client", "server"), executors=process("node", 1, "ros2_executor"))
    assert _reads(of, 29, wire=1, busy=5 * MS) == [-1, -1, 1]
    of = replace(of, executors=process("node", 1, "fifo"))
    assert _reads(of, 29, wire=1, busy=5 * MS) == [-1, 0, 1]


def test_what_throttle_drops_is_read_by_the_next_job_or_forgotten() -> None:
    # fast brings 0, 4, 8, ...: 0 and 24 pass, and at 11 slow fires. Until then 4 and 8 were dropped.
    nodes = [timed("fast", 4, 0), timed("slow", 100, 0), event("both", 1, "fast", "slow", throttle=10)]
    arcs = [arc("fast", "both"), arc("slow", "both")]
    assert _reads(system(nodes, arcs), 25, slow=11 * MS) == [0, 2, 6]
    nodes[2] = replace(nodes[2], keeps_dropped=False)
    assert _reads(system(nodes, arcs), 25, slow=11 * MS) == [0, 0, 6]


def test_what_was_dropped_is_not_overwritten_by_an_older_message_that_is_read_later() -> None:
    # The job for the message of 0 begins at 5, behind `busy`; that of 4 was dropped meanwhile. The call of 7 reads it.
    nodes = [
        timed("fast", 4, 0),
        timed("busy", 100, 5, host="h", priority=9),
        timed("client", 100, 0),
        event("reader", 1, "fast", throttle=10, host="h", priority=1),
    ]
    of = system(nodes, [arc("fast", "reader"), *call("client", "reader")], {"h": 1})
    assert _reads(of, 13, client=7 * MS) == [0, 1, 3]


def test_of_dropped_sets_the_newest_stays_or_none() -> None:
    # All of `fast` and `slow`, at most each 10: the set of 4 is dropped; a call at 6 reads it, or what was before it.
    both = event("both", 1, "fast", "slow", mode="all", throttle=10)
    nodes = [timed("fast", 4, 0), timed("slow", 4, 0), timed("client", 100, 0), both]
    arcs = [arc("fast", "both"), arc("slow", "both"), *call("client", "both")]
    assert _reads(system(nodes, arcs), 7, client=6 * MS) == [0, 1]
    nodes[3] = replace(both, keeps_dropped=False)
    assert _reads(system(nodes, arcs), 7, client=6 * MS) == [0, 0]


def test_how_old_what_is_read_may_be() -> None:
    # cam sends at 5, 45, ...; the reader looks at each 10, the last time at 40 or just before the next is there.
    nodes = [timed("cam", 40, 5), timed("reader", 10, 1)]
    seen = simulate_system(system(nodes, [arc("cam", "reader")]), 4, 1)
    assert seen.activities["reader"].read_ages == {"cam": 35 * 10**6}


def _steps(*places: Activity) -> list[Activity]:
    return [replace(one, host="h2") for one in within("box", *places)]


def test_a_stored_image_waits_for_two_rounds_of_an_executor() -> None:
    """The image comes just after the wait set was taken; the clock is served before it, and then waits for both long
    callbacks again: 100 until the sampling, 295 until the end.
    """
    reader = replace(timed("ctrl", 100_00, 20_00), storing={"cam": stores()})
    long = 45_01
    nodes = [
        timed("cam", 100_00, 5_00),
        timed("la", 190_00, 0),
        timed("lb", 190_00, 0),
        *_steps(reader, event("ha", long, "la"), event("hb", long, "lb")),
    ]
    arcs = [arc("cam", "ctrl"), arc("la", "ha"), arc("lb", "hb")]
    of = system(nodes, arcs, {"h2": 1}, executors=process("box", 1, "ros2_executor"))
    of = replace(of, tick=of.tick / 100)
    plan = build_plan(of)
    unit = round(1_000_000 / plan.unit)
    run = _run(of, 4000 * unit, ctrl=int(90.03 * unit), cam=int(5.1 * unit))
    read, ends = run.wires.source_log[0], run.activities.job_ends[3]
    sampled = run.activities.job_activations[0]
    reactions = [
        (end - sampled[old]) / unit for (old, new), end in zip(pairwise(read), ends[1:], strict=False) if new > old >= 0
    ]
    assert 394.9 <= max(reactions) < 395


def test_one_callback_group_spans_the_containers_threads() -> None:
    # Two nodes in a container of two threads: `a.x` and `a.y` exclude one another, `b` runs beside them.
    nodes = [
        *within("box", timed("a.x", 40, 4, priority=3), timed("a.y", 40, 4, priority=2), group="a"),
        *within("box", timed("b", 40, 4, priority=1), group="b"),
    ]
    found = jobs(system(nodes, executors=process("box", 2, "non_preemptive")), 39)
    assert found == {"a.x": [(0, 0, 4)], "a.y": [(0, 4, 8)], "b": [(0, 0, 4)]}


def test_a_container_of_unknown_threads_has_one_for_each_member() -> None:
    nodes = within("box", *(timed(name, 40, 4) for name in "abc"), group=None)
    of = system(nodes, executors={"box": replace(process("box")["box"], threads=None)})
    assert all(one == [(0, 0, 4)] for one in jobs(of, 39).values())


def test_orders_of_one_thread() -> None:
    # All wait behind `first`, which works 0-5; the others come at 1, 2 and 3 ms.
    deadlines = {"x": 90, "y": 50, "z": 70}
    others = [timed(name, 100, 2, priority=p, deadline=deadlines[name]) for p, name in enumerate("xyz")]
    nodes = within("node", timed("first", 100, 5), *others)
    for order, sequence in (("fifo", "xyz"), ("non_preemptive", "zyx"), ("edf", "yzx"), ("round_robin", "xyz")):
        run = _run(system(nodes, executors=process("node", 1, order)), 50 * MS, x=1 * MS, y=2 * MS, z=3 * MS)
        starts = {name: run.activities.job_starts[at + 1][0] // MS for at, name in enumerate("xyz")}
        assert "".join(sorted(starts, key=starts.__getitem__)) == sequence, order
        assert sorted(starts.values()) == [5, 7, 9]


def test_a_subscription_has_one_turn_in_each_wait_set() -> None:
    # While `busy` works 0-9, `a` brings two messages and `b` one: each subscription is served once, then `a` again.
    reader = event("reader", 1, "a", "b")
    nodes = [timed("a", 3, 0), timed("b", 100, 0), *within("node", timed("busy", 100, 9), reader)]
    of = system(nodes, [arc("a", "reader"), arc("b", "reader")], executors=process("node", 1, "ros2_executor"))
    run = _run(of, 13 * MS, a=4 * MS, b=8 * MS)
    # Messages of `a` come at 4, 7 and 10, that of `b` at 8: 9-10 and 10-11 are those of 4 and 8 in either order.
    assert sorted(run.activities.job_activations[3][:2]) == [4 * MS, 8 * MS]
    assert run.activities.job_activations[3][2] == 7 * MS
