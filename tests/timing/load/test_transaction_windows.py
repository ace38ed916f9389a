"""Windows over whole ways: the truth where nothing else runs, and the traps on the way to it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.load.response_terms import ResponseTerms
from archgen.timing.load.transaction_windows import ENDLESS, TransactionWindows
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.timing.random_systems import architecture
from tests.timing.random_transactions import ORDERS, Simulation, draw_system
from tests.timing.sketches import analyse_sketch, read_sketch

MS = 10**6


def draw_to_and_fro(steps: int, hosts: int, cores: int, cost: int) -> tuple[dict[str, str], str, str]:
    """Return a chain whose steps go round some hosts; nothing else runs there."""
    times = f"wcet: {cost} ms, bcet: {Fraction(cost, 2).limit_denominator()!s} ms".replace("5/2", "2.5")
    nodes = {f"s{at} @h{at % hosts}": f"{'' if at else 'period: 100 ms, '}{times}" for at in range(steps)}
    names = [f"h{at}" for at in range(hosts)]
    rest = (
        f"hosts: {{{', '.join(f'{name}: {{cores: {cores}}}' for name in names)}}}\n"
        f"links: {{lan: {{connects: [{', '.join(names)}], latency: {{best: 100 us, worst: 1 ms}}}}}}\n"
        f"chains: {{c: {{through: [g.s0, g.s{steps - 1}]}}}}"
    )
    return nodes, " ".join(f"s{at}>s{at + 1}" for at in range(steps - 1)), rest


@pytest.mark.parametrize(
    ("steps", "hosts", "cores", "cost", "truth"),
    [
        (4, 2, 1, 5, 23),
        (6, 2, 1, 5, 35),
        (8, 2, 1, 5, 47),
        (10, 2, 1, 5, 59),
        (10, 2, 2, 5, 59),
        pytest.param(20, 4, 2, 6, 139, marks=pytest.mark.slow),
    ],
)
def test_a_chain_to_and_fro_takes_its_own_time(steps: int, hosts: int, cores: int, cost: int, truth: int) -> None:
    model = read_sketch(*draw_to_and_fro(steps, hosts, cores, cost))
    analysis = analyse_architecture(model)
    assert bound_all_chains(analysis, model)["c"].bound.value == (100 + truth) * MS
    assert analysis.host_runs[f"s{steps - 1}"].worst.value == truth * MS


def find_windows(analysis: Analysis) -> TransactionWindows:
    """Return the solved windows of the only transactions of an analysis."""
    assert analysis.state is not None
    windows = ResponseTerms(analysis.state).open_windows("s1")
    assert windows is not None
    return windows


def test_no_delay_is_below_its_own_work_so_that_jitters_are_none_below_zero() -> None:
    # A delay that began at 0, with best cases above it, would let nothing of the others come: b ends after 1 ms then.
    analysis = analyse_sketch(
        {
            "s0 @p": "period: 100 ms, wcet: 9 ms, bcet: 9 ms",
            "s1 @q": "wcet: 1 ms, bcet: 1 ms",
            "s2 @p": "wcet: 9 ms, bcet: 9 ms",
            "t0 @q": "period: 100 ms, wcet: 8 ms, bcet: 8 ms",
            "t1 @p": "wcet: 30 ms, bcet: 30 ms",
            "t2 @q": "wcet: 10 ms, bcet: 10 ms",
        },
        "s0>s1 s1>s2 t0>t1 t1>t2",
        "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], latency: {best: 2 ms, worst: 2 ms}}}",
    )
    windows = find_windows(analysis)
    for key, path in windows.transactions.paths.items():
        way = windows.transactions.ways[key]
        own_time = way.link_time + sum(windows.transactions.system.activities[name].wcet or 0 for name, _ in path)
        assert windows.delays[key] >= own_time >= way.best_before
        # At the end all inequalities hold at once.
        assert min(windows.find_delay(each) for each in windows.list_windows(key)) <= windows.delays[key] < ENDLESS
    # s1 may meet t0 and t2 of one event, or of two that follow one another.
    assert analysis.responses["s1"].worst.value is not None
    assert analysis.responses["s1"].worst.value >= 11 * MS


def test_a_thread_of_another_visit_of_the_way_keeps_a_core_busy_too() -> None:
    # While the way is at `t2s7` both cores run `t1s3` and the next event's `t2s4`: seen in a simulation.
    drawn = draw_system(3017, ranked=True)
    exceeded, _ = hold_against_runs(3017, ranked=True)
    assert (exceeded, len(drawn.steps)) == ([], 15)


KINDS: tuple[dict[str, bool], ...] = (
    {},
    {"pinned": True},
    {"gates": True},
    {"ranked": True},
    {"pinned": True, "gates": True, "ranked": True},
)


def hold_against_runs(seed: int, **kind: bool) -> tuple[list[str], int]:
    """Run a drawn system; say what took longer than its bound, and how many bounds were held against what was seen."""
    drawn = draw_system(seed, **kind)
    analysis = analyse_architecture(architecture(drawn.text))
    assert analysis.state is not None
    ticks = analysis.system.tick / 1000
    bounds: dict[tuple[str, ...], Fraction] = {
        way.steps: (way.delay or 0) * ticks for ways in analysis.state.transaction_ways.values() for way in ways
    }
    for name, response in analysis.responses.items():
        if response.worst.value is not None:
            bounds[name,] = min(response.worst.value / 1000, bounds.get((name,), Fraction(1 << 60)))
    seen: dict[tuple[str, ...], int] = {}
    until = max(4 * max(step.period for step in drawn.steps.values()), 300_000)
    for number in range(len(ORDERS)):
        run = Simulation(drawn, ORDERS[number], 100 * seed + number, until).run()
        for steps, time in (*run.ways.items(), *(((name,), time) for name, time in run.responses.items())):
            seen[steps] = max(seen.get(steps, 0), time)
    held = [(steps, time, bounds[steps]) for steps, time in seen.items() if steps in bounds]
    return [
        f"{' > '.join(steps)}: {time} us seen, bound {float(bound)}" for steps, time, bound in held if time > bound
    ], len(held)


@pytest.mark.parametrize("first", try_some(range(0, 60, 4), 1, 4))
@pytest.mark.parametrize("kind", try_some([(kind,) for kind in KINDS], 1), ids=lambda kind: "-".join(kind) or "plain")
def test_no_run_of_an_independent_simulator_exceeds_a_bound(kind: dict[str, bool], first: int) -> None:
    found = {seed: hold_against_runs(20_000 + seed, **kind) for seed in range(first, first + 4)}
    assert {seed: exceeded for seed, (exceeded, _) in found.items() if exceeded} == {}
    assert any(held for _, held in found.values())
