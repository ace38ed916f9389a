"""Callback groups of a program: who is in which, and which of them are written at all."""

from __future__ import annotations

import pytest

from archgen.model.node import Node
from archgen.plugins.ros_code.node_programs import CALLED_SECTIONS, add_callback_groups

GROUPS = {"fast": ("g.stop",), "class": ("g.map",), "idle": ("g.log",)}


def make_sections() -> dict[str, list[dict[str, object]]]:
    sections: dict[str, list[dict[str, object]]] = {name: [] for name in CALLED_SECTIONS}
    sections["subscriptions"] += [{"port": "g.stop.image"}, {"port": "g.cam.image"}, {"port": ""}]
    return sections


@pytest.mark.parametrize(
    ("node", "expected", "given"),
    [
        (
            Node("n", "N", callback_groups=GROUPS),
            [{"key": "fast", "components": ["g.stop"]}, {"key": "class", "components": ["g.map"]}],
            ["fast", "", "", "class"],
        ),
        (Node("n", "N", callback_groups=GROUPS, reentrant=True), [], ["", "", "", ""]),
        (Node("n", "N"), [], ["", "", "", ""]),
    ],
    ids=["groups", "reentrant", "none"],
)
def test_each_callback_knows_its_group(node: Node, expected: list[dict[str, object]], given: list[str]) -> None:
    sections = make_sections()
    timers: list[dict[str, object]] = [{"component": "g.map"}]
    assert add_callback_groups(node, sections, timers) == expected
    assert [each["callback_group"] for each in (*sections["subscriptions"], *timers)] == given
