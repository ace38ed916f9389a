"""Topics and services that ROS gives each node are told from those of a robot."""

from __future__ import annotations

import pytest

from archgen.model.common_callbacks import is_common_callback


@pytest.mark.parametrize(
    ("kind", "name", "expected"),
    [
        ("subscription", "/parameter_events", True),
        ("subscription", "/scan", False),
        ("service", "/a/b/set_parameters", True),
        ("service", "/drive/_action/send_goal", True),
        ("service", "/a/grasp", False),
        ("timer", "1000", False),
    ],
)
def test_what_every_node_has(kind: str, name: str, *, expected: bool) -> None:
    assert is_common_callback(kind, name) is expected
