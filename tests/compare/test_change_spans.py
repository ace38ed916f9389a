"""Where a change stands in the files of the second version."""

from __future__ import annotations

import pytest

from archgen.compare.change_spans import find_change_span
from tests.compare.conftest import Compared

ROBOT = """\
groups:
  g:
    components:
      a: {outputs: {x: std_msgs/msg/Bool, y: std_msgs/msg/Bool}}
      b:
        functionality: Looks
        inputs:
          i: a.x
"""


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("i: a.x", "i: a.y", "connection g.b.i 8:11"),
        ("Looks", "Sees", "component g.b 5:7"),
        (", y: std_msgs/msg/Bool", "", "output g.a.y 4:7"),
    ],
)
def test_a_change_stands_at_its_element_else_at_what_held_it(
    compared: Compared, old: str, new: str, place: str
) -> None:
    comparison = compared(ROBOT, ROBOT.replace(old, new))
    (change,) = comparison.changes
    span = find_change_span(change, comparison)
    assert f"{change.element_kind} {change.element_id} {span.line}:{span.column}" == place
