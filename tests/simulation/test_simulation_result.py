"""What a simulation has observed."""

from __future__ import annotations

from archgen.simulation.simulation_result import ChainFigures, ObservedChain


def test_bounds_hold_for_what_was_forwarded_or_for_all_where_nothing_is_left_out() -> None:
    everything, forwarded = (ChainFigures(None, None, None, None, count) for count in (5, 3))
    assert ObservedChain(("a", "b"), everything, None).bounded_figures == everything
    assert ObservedChain(("a", "b"), everything, forwarded).bounded_figures == forwarded
