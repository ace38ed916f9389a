"""What hosts and containers are called by others."""

from __future__ import annotations

from collections.abc import Callable

from archgen.model.architecture import Architecture
from archgen.model.deployment import Container, Link

ROBOT = """
partners: {p: {}, q: {}}
groups: {g: {components: {a: {owner: p, outputs: {x: std_msgs/msg/Empty}}, b: {owner: q, inputs: {x: a.x}}}}}
hosts: {pc: {address: 10.0.0.2}, arm: {}}
containers: {box: {host: pc, namespace: /n/}, named: {host: pc, name: own}}
nodes: {a: {implements: a, host: pc}, b: {implements: b, host: arm}}
"""


def test_names_are_those_that_others_use(derived: Callable[[str], Architecture]) -> None:
    architecture = derived(ROBOT)
    assert {name: host.network_name for name, host in architecture.hosts.items()} == {"pc": "10.0.0.2", "arm": "arm"}
    assert [each.full_name for each in architecture.containers.values()] == ["/n/box", "/own"]


def test_what_nobody_declares_has_plain_names() -> None:
    assert Container("box", "Box").full_name == "/box"
    assert (Link("lan", "Lan", owner="p").owners, Link("lan", "Lan").owners) == (("p",), ())
