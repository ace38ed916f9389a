"""Who owns what timing calls an activity."""

from __future__ import annotations

import pytest

from archgen.compare.asked_limits import find_activity_owners
from archgen.timing.run_analysis import analyse_architecture
from tests.compare.conftest import Checked

ROBOT = """\
partners: {p: P, q: Q, r: R}
groups: {g: {owner: p, components: {a: {outputs: {x: std_msgs/msg/Bool}}, b: {owner: [q, r], inputs: {x: a.x}}}}}
nodes: {na: {implements: a, owner: r}, nb: {implements: b}, tool: {owner: q, internal: {publishes: {t: {topic: /t, message: std_msgs/msg/Bool}}}}}
"""


@pytest.mark.parametrize(
    ("names", "owners"),
    [
        (["na"], "p"),  # that of the component, whoever has the node
        (["nb"], "q r"),
        (["tool"], "q"),
        (["g.a"], "p"),  # a chain without a way names components, or ports
        (["g.a.x"], ""),
        (["nothing"], ""),
        (["na", "tool"], "p q"),
        ([], ""),
    ],
)
def test_the_owners_of_the_component_else_of_the_node(checked: Checked, names: list[str], owners: str) -> None:
    architecture = checked(ROBOT)
    found = find_activity_owners(names, architecture, analyse_architecture(architecture))
    assert " ".join(sorted(found)) == owners
