"""Edits that break partners, as documents show them."""

from __future__ import annotations

from pathlib import Path

from archgen.views.changes.comparison_document import describe_comparison
from tests.views.changes.test_repeated_findings import compare

TYPES = """\
partners: {a: A, b: B}
types: {T: std_msgs/msg/String}
component_types: {motor: {outputs: {x: {type: T, description: in m}}}}
groups:
  g: {owner: a, components: {one: {is: motor}, two: {is: motor}, three: {is: motor}, four: {is: motor}}}
  h: {owner: b, components: {r: {inputs: {x: [one.x, two.x, three.x, four.x]}}}}
"""


def test_what_is_lost_of_each_instance_of_a_type_is_told_once(tmp_path: Path) -> None:
    comparison = compare(tmp_path, TYPES.replace("in m", "in mm"), TYPES)
    (item,) = describe_comparison(comparison, "a", "b").breaking_changes
    assert [loss.reason for loss in item.losses] == [
        "says of `g.four.x`, `g.one.x` and 2 more `in mm` instead of `in m`; `h.r.x` of B reads it"
    ]
