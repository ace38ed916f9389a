"""Figures that are tried: what they are counted in, how far down they go, and the change that each step is."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.chain_budgets import TriedFigure, find_execution_time, find_own_period
from tests.timing.made import periodic
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch


def _find(timing: str) -> tuple[TriedFigure | None, TriedFigure | None]:
    model = architecture(sketch({"a @p": timing}, "x>a", "hosts: {p: {cores: 1}}"))
    activity = analyse_architecture(model).system.activities["a"]
    return find_execution_time(model, activity), find_own_period(model, activity)


@pytest.mark.parametrize(
    ("timing", "key", "written", "tick", "steps"),
    [
        ("period: 1 s, wcet: 5 ms", "wcet", 5_000_000, 1_000, (5_000, 1)),
        ("period: 1 s, wcet: 5 ms, bcet: 2 ms", "wcet", 5_000_000, 1_000, (5_000, 2_000)),
        ("period: 1 s, wcet: 5 ms, response: 7 ms, bcet: 2 ms", "response", 7_000_000, 1_000, (7_000, 1)),
        ("period: 1 s, wcet: 100 us", "wcet", 100_000, 1_000, (100, 1)),
        ("period: 1 s, wcet: 99999 ns", "wcet", 99_999, 1, (99_999, 1)),
        ("period: 1 s, wcet: 5000999 ns, bcet: 2000001 ns", "wcet", 5_000_999, 1_000, (5_000, 2_001)),
    ],
)
def test_execution_times(timing: str, key: str, written: int, tick: int, steps: tuple[int, int]) -> None:
    figure, _ = _find(timing)
    assert figure is not None
    assert (figure.key, figure.written, figure.tick) == (key, written, tick)
    assert (figure.written_step, figure.least_step) == steps


@pytest.mark.parametrize(
    ("timing", "written"),
    [
        ("period: 100 ms", 10**8),
        ("rate: 20 Hz", 5 * 10**7),
        ("behaviour: event, rate: 20 Hz", None),
        ("wcet: 1 ms", None),
    ],
)
def test_periods_of_what_has_a_clock(timing: str, written: int | None) -> None:
    _, figure = _find(timing)
    assert (None if figure is None else (figure.key, figure.written)) == (
        None if written is None else ("period", written)
    )


def test_what_nobody_wrote_is_not_tried() -> None:
    assert _find("period: 1 s")[0] is None
    assert _find("") == (None, None)


@pytest.mark.parametrize("timing", ["response: 5 ns, wcet: 5 ns", "wcet: 5 ns"])
def test_what_has_no_best_case_may_come_down_to_nothing(timing: str) -> None:
    figure, _ = _find(f"period: 1 s, {timing}")
    assert figure is not None
    assert figure.grow_by(Fraction(1, 1000)) == Fraction(1, 200)
    assert TriedFigure(periodic("a", 100), "wcet", Fraction(5), 1).grow_by(Fraction(1, 1000)) == Fraction(1, 200)


def test_changes() -> None:
    figure = TriedFigure(periodic("a", 100), "wcet", Fraction(5_000_000), 1_000, Fraction(4_000_000))
    assert [figure.grow_by(Fraction(each)) for each in ("1.5", "0.9", "0.5")] == [7_500_000, 4_500_000, 4_000_000]
    assert str(figure.change_to(1_500)) == "a.timing.wcet=1.5ms"
    assert str(figure.change_to_duration(Fraction(20))) == "a.timing.wcet=20ns"
