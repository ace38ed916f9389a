"""Places of boxes: columns from left to right, heights that do not overlap, the same in every run."""

from __future__ import annotations

import random
from collections import defaultdict
from itertools import pairwise

import pytest

from archgen.views.explorer.column_layout import FlowWeights, place_in_columns


def weights(text: str) -> FlowWeights:
    """Read flows: `a>b b>c`."""
    return {(tail, head): 1 for tail, _, head in (flow.partition(">") for flow in text.split())}


@pytest.mark.parametrize(
    ("items", "flows", "columns"),
    [
        ("", "", ""),
        ("a", "", "a"),
        ("a", "a>a", "a"),
        ("a b", "a>b", "a|b"),
        ("b a", "a>b", "a|b"),  # the order of the files does not matter
        ("a b c", "a>b b>c", "a|b|c"),
        ("a b c", "a>b b>a", "ac|b"),  # what has no flow goes where there is room
        ("a b c d e", "a>b a>c b>d c>d e>d", "ae|bc|d"),
    ],
)
def test_most_flows_run_to_the_right(items: str, flows: str, columns: str) -> None:
    places = place_in_columns(items.split(), weights(flows))
    by_column: dict[int, list[str]] = defaultdict(list)
    for item, (column, _) in places.items():
        by_column[column].append(item)
    assert "|".join("".join(sorted(by_column[number])) for number in sorted(by_column)) == columns


def test_boxes_of_one_column_do_not_overlap_and_few_flows_run_back() -> None:
    dice = random.Random(7)  # noqa: S311 - a test's dice
    items = [f"n{number}" for number in range(40)]
    flows = {(dice.choice(items[:index] or items), item): 1 + index % 3 for index, item in enumerate(items) if index}
    places = place_in_columns(items, flows)
    assert places.keys() == set(items)
    heights: dict[int, list[float]] = defaultdict(list)
    for column, height in places.values():
        heights[column].append(height)
    for column_heights in heights.values():
        assert all(below - above >= 0.99 for above, below in pairwise(sorted(column_heights)))
    # A map about as wide as a screen: boxes are three to four times as wide as high.
    assert 4 <= len(heights) <= 7
    backward = [ends for ends in flows if places[ends[0]][0] > places[ends[1]][0]]
    assert len(backward) <= len(flows) / 10


def test_the_order_of_items_and_flows_changes_nothing_but_ties() -> None:
    flows = weights("a>b b>c c>a c>d d>e b>e")
    first = place_in_columns(list("abcde"), flows)
    assert first == place_in_columns(list("abcde"), dict(flows))
    assert [first[name][0] for name in "abe"] == sorted(first[name][0] for name in "abe")


def test_what_lies_in_a_frame_takes_fewer_columns() -> None:
    items = [f"n{number}" for number in range(20)]
    flows = dict.fromkeys(pairwise(items), 1)
    outer = max(column for column, _ in place_in_columns(items, flows).values())
    inner = max(column for column, _ in place_in_columns(items, flows, is_inner=True).values())
    assert inner < outer
