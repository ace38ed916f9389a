"""What may be pending on several cores when one of them was idle just before, and the bounds that follow."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.load import idle_backlogs
from archgen.timing.load.busy_windows import GroupBudgets, SearchBudget
from archgen.timing.load.core_paths import CorePaths, build_thread_work, build_way_works
from archgen.timing.load.event_propagation import propagate_events
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.idle_backlogs import IdleBacklog, PendingShare, choose_largest_lanes, find_idle_backlog
from archgen.timing.load.inner_triggers import find_inner_triggers
from archgen.timing.load.level_cascades import CascadeDemand, EventOrigin
from archgen.timing.load.shared_cores import SharedCores, prepare_shared_cores
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.core_placement import find_resources
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.trigger_graph import find_triggers
from tests.timing.exceeded import exceeded
from tests.timing.printed import MS
from tests.timing.random_styles import random_style_text
from tests.timing.random_systems import architecture
from tests.timing.sketches import analyse_sketch, read_sketch, sketch

EVENT = "behaviour: event, trigger: any"


def prepare(nodes: dict[str, str], wires: str, rest: str) -> SharedCores:
    """Return the only shared cores of a sketch."""
    system, _ = build_system(read_sketch(nodes, wires, rest))
    (resource,) = find_resources(system)
    inner_triggers = find_inner_triggers(system, find_triggers(system), resource)
    assert inner_triggers is not None
    return prepare_shared_cores(system, resource, inner_triggers)


def find_backlog(cores: SharedCores, budget: SearchBudget | None = None) -> IdleBacklog | None:
    """Return what may be pending, each timer without jitter."""

    def find_model(origin: EventOrigin) -> tuple[EventStream, ...]:
        return (EventStream(cores.system.activities[str(origin.key)].period or 1),)

    demand = CascadeDemand(cores.cascades, find_model)
    return find_idle_backlog(cores, CorePaths(cores).way_works, demand, budget or SearchBudget())


def in_ms(cores: SharedCores, ticks: int) -> Fraction:
    """Return ticks in ms."""
    return ticks * cores.system.tick / MS


def test_one_of_three_timers_may_be_pending_on_two_cores() -> None:
    """10 ms every 100 ms each: at most 10 / 2 + 30 / 2 = 20 ms old, one thread's; and 10 / 2 + (30 + 10) / 2 = 25 in all."""
    cores = prepare({f"n{at} @pc": "period: 100 ms, wcet: 10 ms" for at in range(3)}, "", "hosts: {pc: {cores: 2}}")
    backlog = find_backlog(cores)
    assert backlog is not None
    assert [(in_ms(cores, share.age), share.events) for share in backlog.pending_shares] == [(20, 1)]
    assert in_ms(cores, backlog.pending_work) == 10
    assert {in_ms(cores, delay) for delay in backlog.delays.values()} == {25}
    assert in_ms(cores, backlog.find_busy_window(build_thread_work(cores, "n0"))) == 25


def test_what_comes_behind_the_last_step_does_not_hold_it_up() -> None:
    """A row of s (10 ms) and a (30 ms), and t (20 ms), every 200 ms, on 2 cores.

    K is 40, all of s and a. s: 10 / 2 + (40 + 20 + 40 - 30) / 2 = 40; a: 40 / 2 + (60 + 40) / 2 = 70.
    """
    nodes = {
        "s @pc": "period: 200 ms, wcet: 10 ms",
        "a @pc": f"{EVENT}, wcet: 30 ms",
        "t @pc": "period: 200 ms, wcet: 20 ms",
    }
    cores = prepare(nodes, "s>a", "hosts: {pc: {cores: 2}}")
    backlog = find_backlog(cores)
    assert backlog is not None
    assert {name: in_ms(cores, delay) for (name, _), delay in backlog.delays.items()} == {"s": 40, "a": 70, "t": 60}


def test_what_takes_no_time_leaves_nothing_pending() -> None:
    """On 3 cores two threads count: that of `a`, and that of what it fires."""
    cores = prepare(
        {"a @pc": "period: 100 ms, wcet: 10 ms", "b @pc": f"{EVENT}, wcet: 0 ms"}, "a>b", "hosts: {pc: {cores: 3}}"
    )
    backlog = find_backlog(cores)
    assert backlog is not None
    shares = [(share.name, in_ms(cores, share.rest), in_ms(cores, share.work)) for share in backlog.pending_shares]
    assert shares == [("a", 10, 10), ("b", 0, 0)]


def test_a_row_of_steps_that_lasts_longer_than_its_period_is_bounded() -> None:
    """Six steps of 30 ms every 100 ms on 4 cores: up to six events are under way at once, each in another step."""
    nodes = {"n0 @pc": "period: 100 ms, wcet: 30 ms"} | {f"n{at} @pc": f"{EVENT}, wcet: 30 ms" for at in range(1, 6)}
    rest = "hosts: {pc: {cores: 4}}\nchains: {c: {through: [g.n0, g.n5]}}"
    wires = " ".join(f"n{at}>n{at + 1}" for at in range(5))
    responses = analyse_sketch(nodes, wires, rest).responses
    assert all(response.worst.value for response in responses.values())
    wrong, held = exceeded(sketch(nodes, wires, rest))
    assert (wrong, held > 6) == ([], True)


def test_a_thread_that_is_too_full_leaves_no_bound_of_this_kind() -> None:
    """0.9 / 2 + 1.2 / 2 is above 1, though both cores could do the work."""
    nodes = {
        "a @pc": "period: 10 ms, wcet: 9 ms",
        "b @pc": "period: 10 ms, wcet: 2 ms",
        "c @pc": "period: 10 ms, wcet: 1 ms",
    }
    assert find_backlog(prepare(nodes, "", "hosts: {pc: {cores: 2}}")) is None


def test_a_search_without_a_budget_finds_nothing() -> None:
    cores = prepare({f"n{at} @pc": "period: 100 ms, wcet: 10 ms" for at in range(3)}, "", "hosts: {pc: {cores: 2}}")
    assert find_backlog(cores, SearchBudget(0)) is None


def test_delays_in_shared_threads_that_do_not_settle_are_no_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """One round is not enough: what is in the box with b comes later by what the round before said."""
    nodes = {
        "s @pc": "period: 100 ms, wcet: 10 ms",
        "b +box": f"{EVENT}, wcet: 10 ms",
        "t +box": "period: 50 ms, wcet: 5 ms",
        "u @pc": "period: 50 ms, wcet: 5 ms",
    }
    cores = prepare(nodes, "s>b", "hosts: {pc: {cores: 2}}\ncontainers: {box: {threads: 1, host: pc}}")
    assert find_backlog(cores) is not None
    monkeypatch.setattr(idle_backlogs, "_MAX_ROUNDS", 1)
    assert find_backlog(cores) is None


def test_a_caller_may_still_work_while_what_it_called_waits() -> None:
    """Of the 5 ms of a caller nothing is sure to be done when its server is activated; of a publisher all is."""
    nodes = {
        "a @pc": "period: 100 ms, wcet: 5 ms",
        "b @pc": f"{EVENT}, wcet: 7 ms",
        "t @pc": "period: 100 ms, wcet: 1 ms",
    }
    cores = prepare(nodes, "a>b", "hosts: {pc: {cores: 2}}")
    way_work = build_way_works(cores)["b", 0]
    assert (in_ms(cores, way_work.left), in_ms(cores, way_work.cost)) == (7, 12)
    assert in_ms(cores, build_way_works(cores)["a", 0].behind) == 7


@pytest.mark.parametrize(
    ("lanes", "number", "works"),
    [
        # Of x there are 50 in all, in whatever threads.
        ([("x", 40), ("x", 30), ("y", 20)], 2, [40, 20]),
        ([("x", 40), ("x", 30), ("y", 5)], 2, [40, 10]),
        ([("x", 40), ("y", 20)], 1, [40]),
    ],
)
def test_the_fullest_threads_count_and_no_origin_more_than_there_is(
    lanes: list[tuple[str, int]], number: int, works: list[int]
) -> None:
    shares = [[PendingShare(name, EventOrigin("activity", name), 1, 1, work, work)] for name, work in lanes]
    most = {EventOrigin("activity", "x"): 50, EventOrigin("activity", "y"): 20}
    assert [share.work for share in choose_largest_lanes(shares, most, number)] == works


def test_threads_of_several_origins_count_as_a_whole() -> None:
    x, y = EventOrigin("activity", "x"), EventOrigin("activity", "y")
    both = [PendingShare("a", x, 1, 1, 4, 4), PendingShare("a", y, 1, 1, 3, 3)]
    alone = [PendingShare("b", x, 1, 1, 6, 6)]
    assert [share.work for share in choose_largest_lanes([alone, both], {x: 6, y: 3}, 1)] == [4, 3]


def test_no_more_is_pending_than_pending_events_lead_to() -> None:
    """The two fullest of four threads could have 30 + 20 ms, but one event of each row is all there is: 30 + 1 + 1 ms."""
    nodes = {
        "a @pc": "period: 1 s, wcet: 10 ms",
        "b @pc": f"{EVENT}, wcet: 10 ms",
        "c @pc": f"{EVENT}, wcet: 10 ms",
        "t +box": "period: 1 s, wcet: 1 ms",
        "u +box": "period: 1 s, wcet: 1 ms",
    }
    cores = prepare(nodes, "a>b b>c", "hosts: {pc: {cores: 3}}\ncontainers: {box: {threads: 1, host: pc}}")
    backlog = find_backlog(cores)
    assert backlog is not None
    assert in_ms(cores, backlog.pending_work) == 32


def test_delays_that_come_back_as_jitter_have_an_end_with_priorities_too() -> None:
    """Here each turn of the analysis ends by itself, with more jitter than the one before: the backlog ends all of them."""
    responses = analyse_architecture(architecture(random_style_text(17))).responses
    assert all(response.worst.value is not None for response in responses.values())


def test_twice_as_many_hosts_take_twice_as_long() -> None:
    """Hosts of 30 in rows of ten on 4 cores, at a load of 60 %: each is looked at by itself, and has bounds."""

    def count_terms(host_count: int) -> int:
        nodes, wires = {}, []
        for host in range(host_count):
            for at in range(30):
                timing = EVENT if at % 10 else "period: 50 ms"
                nodes[f"h{host}n{at} @h{host}"] = f"{timing}, wcet: 4 ms"
                wires += [f"h{host}n{at - 1}>h{host}n{at}"] if at % 10 else []
        hosts = ", ".join(f"h{host}: {{cores: 4}}" for host in range(host_count))
        system, _ = build_system(read_sketch(nodes, " ".join(wires), f"hosts: {{{hosts}}}"))
        budgets = GroupBudgets()
        state = propagate_events(system, find_triggers(system), budgets)
        assert all(response.value for response in state.responses.values())
        return budgets.spent_terms

    one, two = count_terms(1), count_terms(2)
    assert one < 100_000
    assert two == 2 * one
