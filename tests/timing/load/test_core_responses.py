"""Responses on one core on which activities fire one another: the busy periods of cascades, and runs."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.timing.analysis import Analysis
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.load import busy_windows, core_responses, event_streams
from archgen.timing.load.busy_windows import DemandFunction, DivergedError, SearchBudget
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show_ms
from tests.timing.sketches import analyse_sketch, list_responses, read_sketch

ROW = [(3, 10), (3, 20), (4, 10), (5, 4), (5, 6), (5, 8), (8, 4), (10, 2), (15, 1), (9, 11)]
"""Steps, and the execution time of each in ms: a timer every 100 ms fires the first, each fires the next."""


def run_row(steps: int, cost: int, place: str, urgency: Callable[[int], str], rest: str) -> tuple[list[str], str, str]:
    """Return the responses, the reduced reaction and the bound of a chain of equal steps."""
    nodes = {
        f"n{at} {place}": f"{'period: 100 ms' if at == 0 else 'behaviour: event'}, wcet: {cost} ms, bcet: {cost} ms{urgency(at)}"
        for at in range(steps)
    }
    wires = " ".join(f"n{at}>n{at + 1}" for at in range(steps - 1))
    through = ", ".join(f"g.n{at}" for at in range(steps))
    model = read_sketch(nodes, wires, f"{rest}\nchains: {{c: {{through: [{through}]}}}}")
    analysis = analyse_architecture(model)
    chain = bound_all_chains(analysis, model)["c"]
    return (
        [show_ms(time.worst) for time in analysis.responses.values()],
        show_ms(chain.reduced_reaction),
        show_ms(chain.bound),
    )


@pytest.mark.parametrize(("steps", "cost"), ROW)
@pytest.mark.parametrize(
    ("place", "urgency", "rest"),
    [
        ("+box", lambda _: "", "containers: {box: {threads: 1, host: pc}}"),
        ("@pc", lambda _: "", ""),
        ("@pc", lambda at: f", priority: {at + 1}", ""),
        ("@pc", lambda at: f", priority: {90 - at}", ""),
    ],
    ids=["executor", "any order", "rising", "falling"],
)
def test_n_steps_of_one_core_take_n_times_their_work(
    steps: int, cost: int, place: str, urgency: Callable[[int], str], rest: str
) -> None:
    """When the timer comes again, all is done: n C from the timer on, and the gap of 100 ms before it."""
    _, reduced_reaction, bound = run_row(steps, cost, place, urgency, f"hosts: {{pc: {{cores: 1}}}}\n{rest}")
    assert (reduced_reaction, bound) == (str(steps * cost), str(100 + steps * cost))


def test_a_step_of_a_ranked_chain_waits_for_what_is_more_urgent() -> None:
    """Falling: no step waits. Rising: beside the k-th count all steps after it, once: the end of the one before was the start."""
    falling, *_ = run_row(5, 10, "@pc", lambda at: f", priority: {90 - at}", "hosts: {pc: {cores: 1}}")
    rising, *_ = run_row(5, 10, "@pc", lambda at: f", priority: {at + 1}", "hosts: {pc: {cores: 1}}")
    assert falling == ["10", "10", "10", "10", "10"]
    assert rising == ["50", "40", "30", "20", "10"]


def chain_figure(analysis_rest: tuple[dict[str, str], str, str]) -> str:
    """Return the bound of the chain `c` of a sketch."""
    model = read_sketch(*analysis_rest)
    return show_ms(bound_all_chains(analyse_architecture(model), model)["c"].bound)


def test_an_all_of_step_ends_a_run() -> None:
    """C waits for b, which comes every 200 ms: 100 + 1 for a's end, and then the wait and c. Seen: 101 at least."""
    model = read_sketch(
        {
            "s @pc": "period: 100 ms, wcet: 1 ms, bcet: 1 ms",
            "a @pc": "behaviour: event, wcet: 1 ms, bcet: 1 ms",
            "b @pc": "period: 200 ms, wcet: 1 ms, bcet: 1 ms",
            "c @pc": "behaviour: event, trigger: all, wcet: 1 ms, bcet: 1 ms",
        },
        "s>a a>c b>c",
        "hosts: {pc: {cores: 1}}\nchains: {c: {through: [g.s, g.a, g.c]}}",
    )
    bound = bound_all_chains(analyse_architecture(model), model)["c"].reduced_reaction.value
    assert bound is not None
    assert bound >= 101 * 10**6


def test_later_arrivals_overtake_the_earlier_steps_of_a_run() -> None:
    """A 5 ms (90) fires b 4 ms (10), every 10 ms, 5 ms late: a, then a again before b: 5 + 5 + 4 from the first on."""
    bound = chain_figure(
        (
            {
                "a @pc": "period: 10 ms, jitter: 5 ms, wcet: 5 ms, bcet: 5 ms, priority: 90",
                "b @pc": "behaviour: event, wcet: 4 ms, bcet: 4 ms, priority: 10",
            },
            "a>b",
            "hosts: {pc: {cores: 1}}\nchains: {c: {through: [g.a, g.b]}}",
        )
    )
    # The gap of a is 15. With a at 0, 5 and 15, b ends at 14, 23 - 5 and 32 - 15 after its event: the second, of 18, is the
    # longest (0 to 5 a, 5 to 10 a, 10 to 14 b, 15 to 20 a, 14 to 15 and 20 to 23 b).
    assert bound == str(15 + 18)


def analyse_ranked(**timings: str) -> Analysis:
    """Return what follows for activities of one core: `s` fires `low`, that fires `high`."""
    nodes = {f"{name} @pc": timing for name, timing in timings.items()}
    return analyse_sketch(nodes, "s>low low>high", "hosts: {pc: {cores: 1}}")


def test_what_is_less_urgent_fires_once_at_the_start_of_a_busy_period() -> None:
    """While mid keeps the core busy, low cannot end: one activation of high counts for mid, though s comes every 4 ms."""
    analysis = analyse_ranked(
        s="period: 4 ms, wcet: 0 ms, priority: 50",
        low="behaviour: event, wcet: 1 ms, bcet: 1 ms, priority: 1",
        high="behaviour: event, wcet: 1 ms, bcet: 1 ms, priority: 60",
        mid="period: 100 ms, wcet: 20 ms, bcet: 20 ms, priority: 40",
    )
    # mid: 20 + 1. low: 1 + 20 + 7, as high comes seven times within 28 ms.
    assert list_responses(analysis)[1:] == [
        "low 1..28 priorities",
        "high 1..1 priorities",
        "mid 20..21 priorities",
    ]


def test_what_works_only_at_the_start_takes_its_own_time_and_that_of_all_others() -> None:
    """Its work is in nobody else's response: 50 + 2, beside a response of 2 for the others."""
    analysis = analyse_sketch(
        {
            "s @pc": "period: 100 ms, wcet: 1 ms",
            "map @pc": "behaviour: once, wcet: 50 ms",
            "b @pc": "behaviour: event, wcet: 1 ms",
        },
        "s>b",
        "hosts: {pc: {cores: 1}}",
    )
    assert list_responses(analysis) == ["s none ?s..2 host", "map none ?map..52 host", "b none ?b..2 host"]


def test_strictly_periodic_cascades_may_fill_a_core_up_to_a_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """5 + 5 of 10 ms: done at each common multiple of the periods. A round of more jobs than the limit is not looked at."""
    nodes = {
        "a @pc": "period: 10 ms, wcet: 5 ms, bcet: 5 ms, priority: 2",
        "b @pc": "behaviour: event, wcet: 5 ms, bcet: 5 ms, priority: 1",
    }
    assert list_responses(analyse_sketch(nodes, "a>b", "hosts: {pc: {cores: 1}}")) == [
        "a 5..5 priorities",
        "b 5..5 priorities",
    ]
    monkeypatch.setattr(event_streams, "_MAX_JOBS_IN_ROUND", 0)
    assert (
        list_responses(analyse_sketch(nodes, "a>b", "hosts: {pc: {cores: 1}}"))[1] == "b 5..none [overload] priorities"
    )


def test_what_works_once_says_that_no_bound_was_found_for_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """The busy period is found, and the budget spent before the work at the start is on top."""
    search = busy_windows.longest_busy_period

    def search_once(demand: DemandFunction, budget: SearchBudget, *start: int) -> int:
        if start:
            raise DivergedError
        return search(demand, budget)

    monkeypatch.setattr(core_responses, "longest_busy_period", search_once)
    nodes = {
        "map +box": "behaviour: once, wcet: 50 ms",
        "a +box": "period: 100 ms, wcet: 2 ms, bcet: 2 ms",
        "b +box": "behaviour: event, wcet: 3 ms, bcet: 3 ms",
    }
    analysis = analyse_sketch(nodes, "a>b", "hosts: {pc: {cores: 1}}\ncontainers: {box: {threads: 1, host: pc}}")
    assert show_ms(analysis.responses["map"].worst) == "none [diverged]"
