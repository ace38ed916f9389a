"""The types that ship: each distribution has those for which it has a message."""

from __future__ import annotations

from archgen.link.project_types import load_shipped_types


def test_a_type_is_left_out_where_no_package_of_the_distribution_has_it() -> None:
    name = "Navigation through poses"
    assert name not in load_shipped_types("noetic")
    assert load_shipped_types("jazzy")[name].message == "nav2_msgs/action/NavigateThroughPoses"
    # Without a distribution everything that ships is known.
    assert name in load_shipped_types(None)
