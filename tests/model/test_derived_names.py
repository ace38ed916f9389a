"""Ids of nodes from the paths of components."""

from __future__ import annotations

import pytest

from archgen.model.derived_names import derive_node_ids


@pytest.mark.parametrize(
    ("component_ids", "used_ids", "node_ids"),
    [
        (["g.a"], [], ["a"]),
        (["g.a"], ["a"], ["g_a"]),
        (["g.a", "h.a"], [], ["a", "h_a"]),
        (["g.a"], ["a", "g_a"], ["g_a_2"]),
        (["g.left.motor", "g.right.motor"], [], ["left_motor", "right_motor"]),
        (["g.left.motor", "g.right.lamp"], [], ["motor", "lamp"]),
        # A deeper component never takes the name that one of its group has had all along.
        (["g.left.motor", "g.motor"], [], ["left_motor", "motor"]),
        (["g.left.motor"], ["motor"], ["left_motor"]),
        (["g.x.arm.motor", "g.y.arm.motor"], [], ["x_arm_motor", "y_arm_motor"]),
    ],
)
def test_the_shortest_end_that_is_unique(component_ids: list[str], used_ids: list[str], node_ids: list[str]) -> None:
    assert derive_node_ids(component_ids, component_ids, used_ids) == dict(zip(component_ids, node_ids, strict=True))
