"""Short forms of composed components, written out file by file."""

from __future__ import annotations

import pytest

from archgen.schema import normalise_document
from archgen.schema.component_sugar import name_port_after
from archgen.syntax import yaml_parser
from archgen.syntax.yaml_tree import node_to_data


def write_out(components: str) -> object:
    document, _ = yaml_parser.parse_yaml("a.yaml", f"groups: {{g: {{components: {components}}}}}")
    assert document is not None
    assert normalise_document(document) == ()
    return node_to_data(document.root)["groups"]["g"]["components"]  # type: ignore[index]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("[motor, drivers.lidar]", {"motor": {"is": "motor"}, "lidar": {"is": "drivers.lidar"}}),
        ("{a: {inputs: [Laser pose]}}", {"a": {"inputs": {"laser_pose": {"type": "Laser pose"}}}}),
        ("{a: {outputs: []}}", {"a": {"outputs": {}}}),
        ("{a.b: {tags: [x]}}", {"a": {"components": {"b": {"tags": ["x"]}}}}),
        ("{a: Arm, a.b: {tags: [x]}}", {"a": {"title": "Arm", "components": {"b": {"tags": ["x"]}}}}),
        (
            "{a: {outputs: {o: {type: T, to: b.i}}}, b: {inputs: {i: {type: T}}}}",
            {"a": {"outputs": {"o": {"type": "T"}}}, "b": {"inputs": {"i": {"type": "T", "from": ["a.o"]}}}},
        ),
        (
            "{a: {outputs: {o: {to: [b.i, b.j]}}}, b: {inputs: {i: c.x}}}",
            {"a": {"outputs": {"o": {}}}, "b": {"inputs": {"i": {"from": ["c.x", "a.o"]}, "j": {"from": ["a.o"]}}}},
        ),
        ("{a: {from: b}}", {"a": {"from": ["b"]}}),
        ("{a: {outputs: {o: {from: b.x}}}}", {"a": {"outputs": {"o": {"from": ["b.x"]}}}}),
    ],
)
def test_short_forms_stand_for_what_is_written_out(written: str, meant: object) -> None:
    assert write_out(written) == meant


@pytest.mark.parametrize(
    ("type_name", "port"),
    [
        ("Pose", "pose"),
        ("Laser pose", "laser_pose"),
        ("scan/LaserPose", "laser_pose"),
        ("sensor_msgs/msg/LaserScan", "laser_scan"),
        ("GPSFix", "gps_fix"),
        ("Envelope<Pose>", "envelope"),
    ],
)
def test_a_listed_port_is_called_after_its_type(type_name: str, port: str) -> None:
    assert name_port_after(type_name) == port
