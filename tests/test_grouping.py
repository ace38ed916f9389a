"""Values are grouped by what they have in common, in the order in which they come."""

from __future__ import annotations

from archgen.grouping import group_pairs


def test_keys_and_values_keep_their_order_and_what_no_pair_begins_with_has_no_values() -> None:
    groups = group_pairs(iter([("b", 1), ("a", 2), ("b", 0), ("b", 1)]))
    assert list(groups.items()) == [("b", [1, 0, 1]), ("a", [2])]
    assert groups["c"] == []
