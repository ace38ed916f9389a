"""What a simulation has observed."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.simulation import simulate_system
from archgen.simulation.simulation_result import ChainFigures, DurationDistribution, ObservedChain, list_seen_shares
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.sketches import read_sketch


def test_bounds_hold_for_what_was_forwarded_or_for_all_where_nothing_is_left_out() -> None:
    everything, forwarded = (ChainFigures(None, None, None, None, count) for count in (5, 3))
    assert ObservedChain(("a", "b"), everything, None).bounded_figures == everything
    assert ObservedChain(("a", "b"), everything, forwarded).bounded_figures == forwarded


@pytest.mark.parametrize(
    ("count", "verdicts"), [(200, ["kept", "late"]), (100, ["kept", "late"]), (19, ["too few", "late"])]
)
def test_a_share_is_judged_by_what_it_took_where_enough_was_seen(count: int, verdicts: list[str]) -> None:
    rest = "chains: {c: {through: [a, b], deadline: {95 %: 96 ms, 99 %: 98 ms}}}"
    model = read_sketch({"a": "period: 100 ms, wcet: 1 ms", "b": "wcet: 1 ms"}, "a>b", rest)
    result = bound_all_chains(analyse_architecture(model), model)["c"]
    # All from 0 to 100 ms are equally likely.
    seen = DurationDistribution(
        Fraction(0), Fraction(0), Fraction(0), Fraction(100), ranges=((0, 100),), unit=Fraction(10**6)
    )
    observed = ObservedChain(("a", "b"), ChainFigures(seen, None, None, None, count), None)
    found = list(list_seen_shares(observed, result))
    assert [(each.share, each.seen, each.verdict) for each in found] == [
        ("95 %", 95 * 10**6, verdicts[0]),
        ("99 %", 99 * 10**6, verdicts[1]),
    ]
    nothing = ObservedChain(("a", "b"), ChainFigures(None, None, None, None, 0), None)
    assert [(each.seen, each.verdict) for each in list_seen_shares(nothing, result)] == [(None, "too few")] * 2


def test_runs_are_counted_while_they_are_simulated() -> None:
    system = analyse_architecture(read_sketch({"a": "period: 100 ms, wcet: 1 ms"}, "", "")).system
    told: list[tuple[int, int]] = []
    simulate_system(system, 1, 3, progress=lambda done, total: told.append((done, total)))
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]
