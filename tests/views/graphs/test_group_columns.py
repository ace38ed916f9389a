"""Columns of groups: few lines cross, little runs back, the same in every run and process."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from collections.abc import Sequence
from itertools import pairwise, permutations, product

import pytest

from archgen.views.graphs import group_columns
from archgen.views.graphs.group_columns import (
    GroupColumns,
    Lane,
    align_columns,
    arrange_groups,
    count_least_crossings,
    spread_apart,
)

Weights = dict[tuple[str, str], int]


def weights(text: str) -> Weights:
    """Read flows: `a>b b>c`."""
    return {(tail, head): 1 for tail, _, head in (flow.partition(">") for flow in text.split())}


def show(arranged: GroupColumns) -> str:
    return "|".join("".join("-" if isinstance(item, Lane) else item for item in column) for column in arranged.columns)


@pytest.mark.parametrize(
    ("groups", "flows", "columns"),
    [
        ("", "", ""),
        ("a", "", "a"),
        ("a", "a>a", "a"),
        ("a b", "a>b", "a|b"),
        ("b a", "a>b b>a", "b|a"),
        ("a b c", "a>b b>c", "a|b|c"),
        ("a b c", "a>b b>c a>c", "a|b-|c"),
        ("a b c d e", "", "ad|be|c"),
        ("a b c", "a>b", "ac|b"),
    ],
)
def test_flows_run_to_the_right_and_lines_have_lanes(groups: str, flows: str, columns: str) -> None:
    assert sorted(show(arrange_groups(groups.split(), weights(flows))).split("|")) == sorted(columns.split("|"))


def make_flows(seed: int, count: int, share: float) -> tuple[list[str], Weights]:
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    names = [f"g{at}" for at in range(count)]
    pairs = [ends for ends in permutations(names, 2) if dice.random() < share]
    return names, {ends: dice.randint(1, 5) for ends in pairs}


def test_groups_without_a_line_are_none_of_the_lanes() -> None:
    # The last group has no line, and a line passes a column.
    arranged = arrange_groups(["a", "b", "c", "d"], weights("a>b b>c a>c"))
    assert sorted(arranged.find_column()) == ["a", "b", "c", "d"]
    assert sum(isinstance(item, Lane) for column in arranged.columns for item in column) == 1


@pytest.mark.parametrize("seed", [0, 1, 3, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (2, 4, 5))])
def test_each_pair_is_one_line_through_all_columns_between(seed: int) -> None:
    names, flows = make_flows(seed, 4 + 3 * seed, 0.25)
    arranged = arrange_groups(names, flows)
    columns = arranged.find_column()
    assert sorted(columns) == sorted(names)
    assert sorted({frozenset(ends) for ends in flows}, key=sorted) == sorted(
        (frozenset((str(line[0]), str(line[-1]))) for line in arranged.lines), key=sorted
    )
    for line in arranged.lines:
        first, last = columns[str(line[0])], columns[str(line[-1])]
        assert [lane.column for lane in line[1:-1] if isinstance(lane, Lane)] == list(range(first + 1, last))
        assert all(lane in arranged.columns[lane.column] for lane in line[1:-1] if isinstance(lane, Lane))


@pytest.mark.slow
def test_sifting_finds_the_best_order_of_the_columns() -> None:
    """Of 50 random graphs of 6 to 8 groups the order is as good as the best of all orders of their columns."""
    compared = 0
    for seed in range(200):
        dice = random.Random(seed)  # noqa: S311 - a test's dice
        count = dice.randint(6, 8)
        flows = {(a, b): 1 for a in range(count) for b in range(a + 1, count) if dice.random() < 0.3}
        if not flows:
            continue
        search = group_columns._Search(count, sorted({end for ends in flows for end in ends}), flows)  # noqa: SLF001
        chosen = search.run()
        graph = search._expand(chosen.columns)  # noqa: SLF001
        orders = 1
        for column in graph.members:
            for at in range(len(column)):
                orders *= at + 1
        if orders > 3000:
            continue
        compared += 1
        crossings = [_count(graph, order) for order in product(*(list(permutations(each)) for each in graph.members))]
        assert _count(graph, chosen.order) == min(crossings), seed
        if compared == 50:
            break
    assert compared == 50


def _count(graph: group_columns._Graph, order: Sequence[Sequence[int]]) -> int:
    place = [0] * len(graph.before)
    for column in order:
        for at, item in enumerate(column):
            place[item] = at
    return group_columns._count_crossings(graph, order, place)  # noqa: SLF001


def test_two_hash_seeds_give_the_same_columns() -> None:
    code = (
        "from archgen.views.graphs.group_columns import arrange_groups\n"
        "names = [f'g{at}' for at in range(9)]\n"
        "print(arrange_groups(names, {(a, b): 1 for a in names for b in names if hash((len(a), a[1:] > b[1:])) and a != b and (int(a[1]) * int(b[1])) % 3 == 1}))"
    )
    outputs = {
        subprocess.run(  # noqa: S603 - this interpreter
            [sys.executable, "-c", code], env={**os.environ, "PYTHONHASHSEED": seed}, capture_output=True, check=True
        ).stdout
        for seed in ("1", "2")
    }
    assert len(outputs) == 1


@pytest.mark.parametrize(("groups", "pairs", "least"), [(10, 30, 6), (8, 19, 1), (50, 318, 174), (3, 2, 0), (1, 0, 0)])
def test_no_drawing_crosses_less(groups: int, pairs: int, least: int) -> None:
    assert count_least_crossings(groups, pairs) == least


def test_items_of_a_column_keep_their_distance() -> None:
    names, flows = make_flows(3, 12, 0.3)
    arranged = arrange_groups(names, flows)
    heights = align_columns(
        arranged, lambda one, other: 1.0 if isinstance(one, str) and isinstance(other, str) else 0.5
    )
    for column in arranged.columns:
        for one, other in pairwise(column):
            wanted = 1.0 if isinstance(one, str) and isinstance(other, str) else 0.5
            assert heights[other] - heights[one] > wanted - 1e-6


@pytest.mark.parametrize(
    ("wishes", "heights"),
    [
        ([], []),
        ([3.0], [3.0]),
        ([0.0, 5.0], [0.0, 5.0]),
        ([0.0, 0.0], [-0.5, 0.5]),
        ([0.0, 0.0, 0.0, 9.0], [-1.0, 0.0, 1.0, 9.0]),
        ([5.0, 0.0], [2.0, 3.0]),  # the order stays
    ],
)
def test_heights_are_as_near_as_can_be_to_the_wished_ones(wishes: list[float], heights: list[float]) -> None:
    assert spread_apart(wishes, [1.0] * len(wishes)) == pytest.approx(heights)
