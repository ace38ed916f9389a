"""Inputs and outputs that are exchanged: one finding, and nothing that follows from it."""

from __future__ import annotations

import pytest

from archgen.schema.schema_validation import mend_exchanged_ports
from archgen.syntax import yaml_parser
from tests.judged_projects import check_text
from tests.schema.findings import find_mistakes

_ROBOT = """\
groups:
  g:
    components:
      lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
      stop: {%s}
      wheels: {inputs: {velocity: stop.velocity}}
nodes: {lidar: lidar, stop: stop, wheels: wheels}
rules: {unmapped-type: off}
"""


@pytest.mark.parametrize(
    "ports",
    [
        "inputs: {velocity: Velocity command}, outputs: {scan: lidar.scan}",
        "inputs: {velocity: geometry_msgs/msg/Twist}, outputs: {scan: g.lidar.scan}",
        "outputs: {scan: {from: lidar.scan}}, inputs: {velocity: {type: Velocity command}}",
        "outputs: {scan: [lidar.scan]}, inputs: {velocity: Velocity command, stub: }",
    ],
)
def test_exchanged_ports_are_one_finding(ports: str) -> None:
    (finding,) = (d for d in check_text(_ROBOT % ports) if d.severity != "note")
    assert (
        finding.message
        == "the inputs and outputs of `g.stop` look exchanged: the inputs are types, the outputs references"
    )
    assert (finding.span.line, finding.span.column) == (5, 14 + ports.index("inputs"))


@pytest.mark.parametrize(
    "ports",
    [
        "inputs: {scan: lidar.scan}, outputs: {velocity: Velocity command}",
        "inputs: {scan: lidar.scan}, outputs: {velocity: velocity.command}",  # a type may have a dot
        "inputs: {light: {external: Light, medium: physical}}, outputs: {velocity: velocity.command}",
        "inputs: {}, outputs: {scan: lidar.scan}",
        "inputs: {scan: lidar}, outputs: {velocity: velocity}",
        # What is composed says types of its inputs, and gives on what its components send.
        "inputs: {i: {external: World, type: A type}}, outputs: {o: {from: a.o}}, components: {a: {}}",
        "is: whole, inputs: {i: {external: World, type: A type}}, outputs: {o: {from: a.o}}",
    ],
)
def test_what_may_be_right_is_left_alone(ports: str) -> None:
    assert find_mistakes(f"groups: {{g: {{components: {{c: {{{ports}}}}}}}}}") == []


def test_the_tree_is_put_right() -> None:
    text = "groups: {g: {components: {c: {inputs: {o: A type}, outputs: {i: a.b}}}}}"
    document, _ = yaml_parser.parse_yaml("f", text)
    assert document is not None
    assert len(list(mend_exchanged_ports(document))) == 1
    assert list(mend_exchanged_ports(document)) == []
