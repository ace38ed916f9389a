"""The floor of a chain: by hand, and never above what it takes in any configuration."""

from __future__ import annotations

import pytest

from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.change_trials import find_floors
from tests.property_sizes import try_some
from tests.timing.random_systems import architecture
from tests.timing.search.late_systems import draw_late_system, propose_for
from tests.timing.sketches import sketch

MS = 10**6


def test_a_floor_is_the_sum_of_gaps_links_and_own_work() -> None:
    """100 ms for the clock and 3 of work; a link of 2 ms; 40 ms for the other clock, 5 of work and 7 on the GPU."""
    text = sketch(
        {
            "a @p": "period: 90 ms, jitter: 10 ms, wcet: 3 ms",
            "b @q": "period: 40 ms, wcet: 5 ms, uses: {gpu: 7 ms}",
            "busy @q": "period: 20 ms, wcet: 9 ms, uses: {gpu: 1 ms}",
            "open": "period: 20 ms",
        },
        "a>b a>open",
        "hosts: {p: {cores: 1}, q: {cores: 1}}\nresources: {gpu: {host: q}}\n"
        "links: {lan: {connects: [p, q], latency: {best: 1 ms, worst: 2 ms}}}\n"
        "chains: {c: {through: [a, b], deadline: 150 ms}, d: {through: [a, b], deadline: 160 ms}, "
        "e: {through: [a, b]}, f: {through: [a, open], deadline: 1 s}}",
    )
    asked = architecture(text)
    floors = find_floors(analyse_architecture(asked), asked)
    assert floors == {"c": 157 * MS, "d": 157 * MS}
    assert propose_for(asked).hopeless == {"c": 157 * MS}


def test_without_deadlines_nothing_is_asked() -> None:
    asked = architecture(sketch({"a": "period: 90 ms, wcet: 3 ms"}))
    assert find_floors(analyse_architecture(asked), asked) == {}


@pytest.mark.parametrize("first_seed", try_some(range(0, 80, 10), 1, 4))
def test_no_configuration_takes_less_than_the_floor(first_seed: int) -> None:
    for seed in range(first_seed, first_seed + 10):
        asked = draw_late_system(seed)
        if asked is None:
            continue
        analysis = analyse_architecture(asked)
        floors = find_floors(analysis, asked)
        for name, result in bound_all_chains(analysis, asked).items():
            assert result.slack is None or result.bound.value is None or result.bound.value >= floors[name], (
                seed,
                name,
            )
        for tried in propose_for(asked).tried:
            for name, bound in tried.bounds.items():
                # A trigger is what a floor says may help.
                assert bound is None or tried.changes_triggers or bound >= floors[name], (seed, name, tried.words)
