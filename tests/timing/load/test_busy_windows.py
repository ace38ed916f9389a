"""Busy windows of large hosts: exact, in bounded time, and where nothing ends that is said."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from random import Random

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.load.busy_windows import (
    NO_DEMAND,
    ActivityWork,
    DivergedError,
    GrowingLoad,
    SearchBudget,
    find_worst_activation,
    longest_busy_period,
    subtract_demand,
)
from archgen.timing.load.event_streams import EventStream, max_arrivals
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.quiet_seconds import measure_quiet_seconds

Derived = Callable[[str], Architecture]


def _slow(own: int, works: Sequence[ActivityWork], jobs: int) -> int:
    """Step through time for the end of the n-th job."""
    window = 1
    while jobs * own + sum(work.cost * max_arrivals(work.streams, window) for work in works) > window:
        window += 1
    return window


def _worst(own: ActivityWork, works: Sequence[ActivityWork]) -> int:
    """Look at each job in turn, until one ends before the next comes."""
    (stream,) = own.streams
    longest, jobs = 0, 0
    while True:
        jobs += 1
        came, comes = (max((k * stream.period) - stream.jitter, k * stream.distance, 0) for k in (jobs - 1, jobs))
        done = _slow(own.cost, works, jobs)
        longest = max(longest, done - came)
        if done <= comes:
            return longest


@pytest.mark.parametrize("seed", range(60))
def test_searches_find_what_steps_of_one_find(seed: int) -> None:
    chance = Random(seed)  # noqa: S311 - the same at each run
    works = []
    for _ in range(chance.randrange(1, 6)):
        period = chance.randrange(8, 60)
        stream = EventStream(period, chance.choice((0, chance.randrange(2 * period))), chance.choice((0, 0, 3)))
        works.append(ActivityWork(chance.randrange(1, 3), (stream,)))
    own, others, load = works[0], works[1:], GrowingLoad(works)
    whole = longest_busy_period(load.demand_function(), SearchBudget())
    assert whole == _slow(0, works, 0)
    rest = subtract_demand(load.demand_function(), GrowingLoad((own,)).demand_function())
    assert (
        find_worst_activation(own, rest, SearchBudget(), whole).response
        == find_worst_activation(own, GrowingLoad(others).demand_function(), SearchBudget()).response
        == _worst(own, others)
    )


def test_a_search_that_takes_too_long_leaves_steps_for_others() -> None:
    budget = SearchBudget()
    endless = GrowingLoad([ActivityWork(1, (EventStream(1),))]).demand_function()._replace(term_count=500_000)
    with pytest.raises(DivergedError):
        longest_busy_period(endless._replace(within=lambda window: window + 1), budget)
    assert longest_busy_period(GrowingLoad([ActivityWork(2, (EventStream(10),))]).demand_function(), budget) == 2


def _host(share: int, priorities: str) -> str:
    """Write a thousand elements of as many periods, with this many thousandths of a core together."""
    chance = Random(share)  # noqa: S311 - the same
    components, nodes = [], []
    for number in range(1000):
        period = chance.randrange(50_000, 1_000_000)
        figures = f"period: {period} us, wcet: {period * share // 1000} ns{priorities.format(1000 - number)}"
        components.append(f"      c{number}: {{outputs: {{out: std_msgs/msg/Empty}}}}")
        nodes.append(f"  c{number}: {{implements: c{number}, host: pc, timing: {{{figures}}}}}")
    return "\n".join(["groups:\n  g:\n    components:", *components, "nodes:", *nodes, "hosts: {pc: {cores: 1}}\n"])


@pytest.mark.parametrize("priorities", try_some(["", ", priority: {}"]))
def test_a_host_with_a_thousand_elements_and_95_per_cent(derived: Derived, priorities: str) -> None:
    architecture = derived(_host(950, priorities))
    found = analyse_architecture(architecture)
    assert found.diverged == ()
    assert float(found.hosts["pc"].utilisation.value or 0) == pytest.approx(0.95, rel=1e-4)
    assert all(response.worst.complete and response.worst.value for response in found.responses.values())


@pytest.mark.slow
def test_what_has_no_end_is_given_up_in_time(derived: Derived) -> None:
    """A hundred chains, each from one host to the other and back: each response makes the next jitter larger."""
    rows = [(f"{letter}{number}", letter) for number in range(100) for letter in "abcd"]
    before = {"b": "a", "c": "b", "d": "c"}
    components = [
        f"      {name}: {{inputs: {{i: {before[letter]}{name[1:]}.out}}, outputs: {{out: std_msgs/msg/Empty}}}}"
        if letter in before
        else f"      {name}: {{outputs: {{out: std_msgs/msg/Empty}}}}"
        for name, letter in rows
    ]
    cost = {"a": "wcet: 1 us, period: 1 ms", "b": "wcet: 4500 ns", "c": "wcet: 4500 ns", "d": "wcet: 4500 ns"}
    nodes = [
        f"  {name}: {{implements: {name}, host: {'pq'['bd'.count(letter)]}, timing: {{{cost[letter]}}}}}"
        for name, letter in rows
    ]
    end = "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], latency: 0 ms}}\n"
    architecture = derived("\n".join(["groups:\n  g:\n    components:", *components, "nodes:", *nodes, end]))
    analyses: list[Analysis] = []
    assert measure_quiet_seconds(lambda: analyses.append(analyse_architecture(architecture))) < 10
    (found,) = analyses
    assert set(found.diverged) == {name for name, _ in rows}
    assert {response.worst.value for response in found.responses.values()} == {None}


def test_a_search_in_which_nothing_else_runs_ends_too() -> None:
    """Where jitter grew without end, each activation is looked at, and none needs a second look."""
    streams = (EventStream(60_000, 180_858_867_990, 5_610, 1, 1), EventStream(60_000, 361_717_702_050, 9_540, 1, 1))
    with pytest.raises(DivergedError):
        find_worst_activation(ActivityWork(14_700, streams), NO_DEMAND, SearchBudget(100_000))
