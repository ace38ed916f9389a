"""What the jobs of a run show of a chain."""

from __future__ import annotations

from archgen.simulation import simulate_system
from archgen.simulation.chain_series import ChainTrace, measure_chain
from tests.simulation.systems import arc, event, process, system, timed, within


def test_a_job_that_has_not_ended_shows_nothing() -> None:
    """Of a reentrant element the one before may end later, or not at all in this run (-1)."""
    trace = ChainTrace([0, 10, 20, 30], [[0, 1, 2, 3]], [5, -1, 22, 31], [None], samples_world=True)
    series = measure_chain(trace)
    assert series.reactions == ((12, 22), (2, 12), (1, 11))
    assert series.ages == ((5, 22), (2, 11))


def test_no_figure_of_a_reentrant_end_is_negative() -> None:
    nodes = [timed("n0", 10, 0), *within("many", event("n1", 25, "n0", bcet=1), group=None)]
    made = system(nodes, [arc("n0", "n1")], executors=process("many", 4))
    seen = simulate_system(made, 1, 8, {"c": ("n0", "n1")}).chains["c"].all_inputs
    assert seen.reaction is not None
    assert seen.age is not None
    assert min(seen.reaction.least, seen.age.least) >= 0
