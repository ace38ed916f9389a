"""Runs on several cores that share their work: the time of the run's threads, and of all cores together."""

from __future__ import annotations

import pytest

from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.load import busy_windows
from archgen.timing.load.core_paths import CorePaths
from archgen.timing.load.event_propagation import propagate_events
from archgen.timing.load.event_streams import EventStream
from archgen.timing.load.inner_triggers import find_inner_triggers
from archgen.timing.load.level_cascades import CascadeDemand
from archgen.timing.load.path_work import PathWork
from archgen.timing.load.shared_core_limits import CoreShares
from archgen.timing.load.shared_core_responses import open_shared_solver
from archgen.timing.load.shared_cores import SharedCores, prepare_shared_cores
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.core_placement import find_resources
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.trigger_graph import find_triggers
from tests.timing.exceeded import exceeded
from tests.timing.printed import MS, show_ms
from tests.timing.sketches import analyse_sketch, read_sketch, sketch

EVENT = "behaviour: event, trigger: any"


def equal(cost: str) -> str:
    """Return execution times that are always the same."""
    return f"wcet: {cost} ms, bcet: {cost} ms"


def show_responses(analysis: Analysis) -> dict[str, str]:
    """Return all responses in ms."""
    return {name: show_ms(time.worst) for name, time in analysis.responses.items()}


def reduced_reaction(nodes: dict[str, str], wires: str, rest: str) -> str:
    """Return the reduced reaction of the chain `c`."""
    model = read_sketch(nodes, wires, rest)
    return show_ms(bound_all_chains(analyse_architecture(model), model)["c"].reduced_reaction)


@pytest.mark.parametrize("count", [24, 28, 32])
def test_many_small_timers_are_bounded(count: int) -> None:
    """10 ms every 100 ms each, on 4 cores: loads of 2.4, 2.8 and 3.2."""
    analysis = analyse_sketch(
        {f"n{at} @pc": f"period: 100 ms, {equal('10')}" for at in range(count)}, "", "hosts: {pc: {cores: 4}}"
    )
    # 10 + 10 (n - 1 + 3) / 4: three more may have been pending, which came within a response before.
    values = set(show_responses(analysis).values())
    assert len(values) == 1
    assert all(time.worst.value is not None for time in analysis.responses.values())


@pytest.mark.parametrize(("steps", "cost", "cores"), [(10, 10, 4), (5, 20, 4), (5, 8, 2), (20, 5, 4)])
def test_a_row_of_steps_on_several_cores_takes_its_own_time(steps: int, cost: int, cores: int) -> None:
    """A timer of 100 ms and what it fires in a row: no two ever work at once. A + B: the steps' threads, and nobody else."""
    nodes = {f"n{at} @pc": f"{'period: 100 ms' if at == 0 else EVENT}, {equal(str(cost))}" for at in range(steps)}
    through = ", ".join(f"g.n{at}" for at in range(steps))
    found = reduced_reaction(
        nodes,
        " ".join(f"n{at}>n{at + 1}" for at in range(steps - 1)),
        f"hosts: {{pc: {{cores: {cores}}}}}\nchains: {{c: {{through: [{through}]}}}}",
    )
    assert found == str(steps * cost)


def test_a_join_waits_for_the_longest_path() -> None:
    """S 1 fires a 1 and b 50; c 1 waits for both: 52 at least from s on."""
    nodes = {
        "s @pc": f"period: 100 ms, {equal('1')}",
        "a @pc": f"{EVENT}, {equal('1')}",
        "b @pc": f"{EVENT}, {equal('50')}",
        "c @pc": f"behaviour: event, trigger: all, {equal('1')}",
    }
    model = read_sketch(nodes, "s>a s>b a>c b>c", "hosts: {pc: {cores: 4}}\nchains: {c: {through: [g.s, g.a, g.c]}}")
    bound = bound_all_chains(analyse_architecture(model), model)["c"].reduced_reaction.value
    assert bound is not None
    assert bound >= 52 * MS


def test_a_thread_works_in_order_of_arrival() -> None:
    """C 8, T 10, jitter 8, alone on 4 cores: the second comes 2 ms after the first, and ends at 16."""
    analysis = analyse_sketch({"a @pc": f"period: 10 ms, jitter: 8 ms, {equal('8')}"}, "", "hosts: {pc: {cores: 4}}")
    assert show_responses(analysis) == {"a": "14"}


def test_what_computes_nothing_beside_one_that_has_a_core_of_its_own_takes_no_time() -> None:
    """Windows are 1 ns long at least: that is not told as a response."""
    nodes = {
        "a @pc": f"period: 10 ms, {equal('0')}",
        "b @pc": f"{EVENT}, {equal('0')}",
        "c @pc": f"period: 10 ms, {equal('1')}",
    }
    analysis = analyse_sketch(nodes, "a>b", "hosts: {pc: {cores: 2}}")
    assert [analysis.responses[name].worst.value for name in "ab"] == [0, 0]


def test_callbacks_of_one_thread_wait_for_each_other() -> None:
    """Fast 2 and slow 60 in one executor, both fired by s 1, on 4 cores: 1 + 60 + 2."""
    nodes = {
        "s @pc": f"period: 100 ms, {equal('1')}",
        "fast +box": f"{EVENT}, {equal('2')}",
        "slow +box": f"{EVENT}, {equal('60')}",
    }
    rest = "hosts: {pc: {cores: 4}}\ncontainers: {box: {threads: 1, host: pc}}\nchains: {c: {through: [g.s, g.fast]}}"
    assert reduced_reaction(nodes, "s>fast s>slow", rest) == "63"


CROWD = {f"l{at} @pc": f"period: 1000 ms, {equal('100')}" for at in range(3)} | {
    f"{name} +box": f"period: 1000 ms, {equal(cost)}" for name, cost in (("y0", "10"), ("y1", "10"), ("p", "1"))
}


def test_threads_of_a_container_may_all_share_the_only_core_that_is_left() -> None:
    """Three long ones hold three of four cores; two members of a container with two threads work on the fourth in turn.

    `p` waits for both: 21 ms at least. 1 + 20 / 2 + 3 x 100 / 4 is the bound: none of the long ones may be cut to what the
    others leave.
    """
    analysis = analyse_sketch(CROWD, "", "hosts: {pc: {cores: 4}}\ncontainers: {box: {threads: 2, host: pc}}")
    assert show_responses(analysis)["p"] == "86"


def test_what_takes_no_time_still_holds_back_what_comes_after_it() -> None:
    """Z takes no time, but waits behind x (50) in its thread; y comes after it. Both may be pending when p comes."""
    nodes = {
        "s @pc": f"period: 200 ms, jitter: 150 ms, {equal('1')}",
        "x +box": f"period: 200 ms, jitter: 150 ms, {equal('50')}",
        "z +box": f"{EVENT}, {equal('0')}",
        "y @pc": f"{EVENT}, {equal('10')}",
        "p @pc": f"period: 200 ms, {equal('20')}",
    }
    text = sketch(nodes, "s>z z>y", "hosts: {pc: {cores: 2}}\ncontainers: {box: {threads: 1, host: pc}}")
    assert exceeded(text)[0] == []
    cores = prepare(nodes, "s>z z>y", "hosts: {pc: {cores: 2}}\ncontainers: {box: {threads: 1, host: pc}}")
    origins = cores.origins_of_unit["x", "z"]
    assert {str(origin.key) for origin in origins} == {"x", "s"}


def test_only_what_is_as_urgent_interferes() -> None:
    """Three that are more urgent and one that is less, on two cores: the least urgent waits for all."""
    nodes = {f"n{at} @pc": f"period: 100 ms, priority: {9 - at}, {equal('10')}" for at in range(4)}
    analysis = analyse_sketch(nodes, "", "hosts: {pc: {cores: 2}}")
    # The first two each have a core; the third 10 + (10 + 10) / 2, the last 10 + 30 / 2.
    assert show_responses(analysis) == {"n0": "10", "n1": "10", "n2": "20", "n3": "25"}


def prepare(nodes: dict[str, str], wires: str, rest: str) -> SharedCores:
    """Return the cores of a sketch that are shared."""
    system, _ = build_system(read_sketch(nodes, wires, rest))
    (resource,) = find_resources(system)
    inner_triggers = find_inner_triggers(system, find_triggers(system), resource)
    assert inner_triggers is not None
    return prepare_shared_cores(system, resource, inner_triggers)


def test_what_too_many_ways_lead_to_has_events_of_its_own() -> None:
    """Ten timers fire b on two cores: its work is not forgotten."""
    nodes = {f"s{at} @pc": f"period: 100 ms, {equal('1')}" for at in range(10)} | {"b @pc": f"{EVENT}, {equal('2')}"}
    cores = prepare(nodes, " ".join(f"s{at}>b" for at in range(10)), "hosts: {pc: {cores: 2}}")
    assert [(job.key, job.origin.key) for job in cores.jobs][-1] == (("b", 0), "b")
    assert "b" in cores.inner_triggers.entry_ids


def test_a_search_that_does_not_end_leaves_no_response(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing may be looked at: no figure is taken for found."""
    monkeypatch.setattr(busy_windows, "_TERMS_PER_GROUP", 0)
    monkeypatch.setattr(busy_windows, "_TERMS_PER_MEMBER", 0)
    nodes = {f"n{at} @pc": f"period: 100 ms, {equal('10')}" for at in range(4)}
    system, _ = build_system(read_sketch(nodes, "", "hosts: {pc: {cores: 2}}"))
    found = propagate_events(system, find_triggers(system)).responses
    assert {response.value for response in found.values()} == {None}
    assert {response.cause.notes for response in found.values()} == {("diverged",)}


def test_work_beside_a_path_is_what_comes_and_what_was_pending() -> None:
    """Two cores: a 4, b 6, c 3, each every 10. For a: b and c; with responses of 9, one thread's next job was pending."""
    nodes = {f"{name} @pc": f"period: 100 ms, {equal(cost)}" for name, cost in (("a", "4"), ("b", "6"), ("c", "3"))}
    cores = prepare(nodes, "", "hosts: {pc: {cores: 2}}")
    tick = (cores.system.activities["a"].wcet or 0) // 4
    streams = (EventStream(10 * tick),)
    demand = CascadeDemand(cores.cascades, lambda _: streams)
    paths, work = CorePaths(cores), PathWork(cores, demand)
    path = paths.look_up(("a",))
    assert path is paths.look_up(("a",))
    assert path.last_step is not None
    # 2 B = min(6, B) + 3
    assert work.find_time_beside(path, 4 * tick, lambda _: None) == 3 * tick
    assert work.note_delay(("b", 0), 9 * tick)
    assert not work.note_delay(("b", 0), 8 * tick)
    work.note_delay(("c", 0), 9 * tick)
    # (6 + 3 + 6) / 2 = 7.5; 2 B = min(12, B) + min(6, B), so 6.
    assert work.find_time_beside(path, 4 * tick, lambda _: None) == 6 * tick
    shares = CoreShares(cores, demand)
    assert not shares.fills_thread(("a",))
    # 0.6 + 0.3, as the core beside it has only 0.4 and 0.3, of which a is the larger: 2 B = B + 0.3.
    assert not shares.fills_core(("b",), paths.look_up(("b",)))
    # Every 100: 4 + 3; 6 + B, where 2 B = min(4, B) + 3; 3 + B, where 2 B = min(6, B) + 4.
    rare_streams = (EventStream(100 * tick),)
    solver = open_shared_solver(paths, lambda _, __: rare_streams, ({}, {}), busy_windows.SearchBudget())
    assert {
        name: response.value and response.value // tick for name, response in solver.solve().response_of.items()
    } == {
        "a": 7,
        "b": 9,
        "c": 7,
    }
