"""Figures as whole numbers: sums compare as the figures do, and what is unknown or boundless has its place."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.frozen import replace
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.chains.cost_network import _make_scale as make_scale
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.sketches import read_sketch


def read_value(text: str) -> TimingValue:
    """Read `10`, `1/3`, `5?` (at least 5: something is missing), `?` (unknown) or `inf` (boundless)."""
    if text == "inf":
        return TimingValue(None, assumptions=("unbounded",))
    number = text.rstrip("?")
    return TimingValue(Fraction(number) if number else None, complete="?" not in text)


def weigh_rows(text: str) -> list[int]:
    """Return the weights of `10 1/2; 10 ?`."""
    rows = [tuple(map(read_value, row.split())) for row in text.split("; ")]
    weigh = make_scale(rows)
    return [weigh(row) for row in rows]


@pytest.mark.parametrize(
    "rows",
    [
        "0; 1/3; 1/2; 2/3; 1",
        "1/3 1/3; 2/3 1/7; 1",
        # What is unknown breaks ties, and no more than that.
        "10; 10 ?; 10 ? ?; 10 1/1000",
        "3 4; 7?; 7? ?; 8",
        "0; ?; 1/1000000",
        # What is boundless outweighs all that is not, taken together.
        "1000000 999999 ? 7?; inf",
        "1 1 1 1; inf; inf 1",
        "?; inf",
        "0; inf",
    ],
)
def test_rows_weigh_more_and_more(rows: str) -> None:
    weights = weigh_rows(rows)
    assert weights == sorted(set(weights))


@pytest.mark.parametrize(
    ("rows", "weights"),
    [
        ("0; 1; ?; 1?", [0, 1 << 24, 1, (1 << 24) + 1]),
        ("1/2; 1/3", [3 << 24, 2 << 24]),
        ("?; inf", [1, 1 << 25]),
        ("3; inf", [3 << 24, 1 << (3 + 25)]),
    ],
)
def test_a_figure_weighs_its_share_of_the_common_denominator(rows: str, weights: list[int]) -> None:
    assert weigh_rows(rows) == weights


def test_a_boundless_figure_outweighs_all_others_together() -> None:
    *others, boundless = weigh_rows("1000000 999999 ?; 7? 3; 12345; inf")
    assert sum(others) * 2 < boundless


def test_who_asks_one_analysis_shares_what_its_steps_cost() -> None:
    model = read_sketch(
        {"a @p": "period: 10 ms, wcet: 1 ms", "b @p": "trigger: [a], wcet: 1 ms"}, "a>b", "hosts: {p: {cores: 1}}"
    )
    analysis = analyse_architecture(model)
    network = CostNetwork.of_analysis(analysis)
    assert CostNetwork.of_analysis(analysis) is network
    assert CostNetwork.of_analysis(replace(analysis)) is not network
    # What chains name is looked up in the architecture of whoever asks: one that differs may have the same timing.
    index = network.index_elements(model)
    assert network.index_elements(model) is index
    assert network.index_elements(replace(model)) is not index
