"""Launch files, the running robot and the library say one endpoint in their own ways: in a project it stands once."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.edit.said_endpoints import join_endpoints
from archgen.pipeline import check_project
from archgen.syntax.yaml_writer import FlowMapping

PROJECT = """\
project: {id: p}
ros: {distro: jazzy}
groups:
  g:
    components:
      guard:
        inputs: {scan: lidar.scan}
        outputs: {cmd_vel: geometry_msgs/msg/Twist}
      lidar: {outputs: {scan: sensor_msgs/msg/LaserScan}}
nodes:
  guard:
    implements: g.guard
    namespace: /front
    package: p
    executable: guard
    status: existing
    remaps: {scan: /scan}
    subscribes: {scan: {own_name: scan}}
    publishes: {cmd_vel: cmd_vel}
  lidar: {implements: g.lidar, package: p, executable: lidar, status: existing, publishes: {scan: scan}}
"""
GRAPH = {
    "publishes": FlowMapping(
        {"out": {"topic": "/front/cmd_vel", "message": "geometry_msgs/msg/Twist", "qos": {"depth": 5}}}
    ),
    "subscribes": {"in": {"topic": "/scan", "message": "sensor_msgs/msg/LaserScan"}},
}
NODE = {"namespace": "/front", "status": "existing"}


@pytest.mark.parametrize(
    ("node", "kept"),
    [
        # Said twice, in two ways: only what is new stays, by the key that it has in the project.
        (NODE | GRAPH, {"nodes": {"guard": NODE | {"publishes": {"cmd_vel": {"qos": {"depth": 5}}}}}}),
        # The robot has another message, and an endpoint more: the component gets a port.
        (
            NODE
            | {
                "publishes": {"out": {"topic": "/front/cmd_vel", "message": "geometry_msgs/msg/TwistStamped"}},
                "subscribes": {"stop": {"topic": "/stop", "message": "std_msgs/msg/Bool"}, "seen": {"topic": "/scan"}},
            },
            {
                "nodes": {
                    "guard": NODE
                    | {
                        "publishes": {"cmd_vel": {"message": "geometry_msgs/msg/TwistStamped"}},
                        "subscribes": {"stop": {"topic": "/stop", "message": "std_msgs/msg/Bool"}},
                    }
                },
                "groups": {
                    "g": {
                        "components": {
                            "guard": {
                                "inputs": {"stop": {"external": "Nobody here has /stop", "type": "std_msgs/msg/Bool"}}
                            }
                        }
                    }
                },
            },
        ),
    ],
)
def test_what_a_project_says_is_not_said_again(node: dict[str, object], kept: object, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    others = check_project(tmp_path / "archgen.yaml")
    slices = {"graph.yaml": {"nodes": {"guard": node}, "component_types": {"guard": {"inputs": {}}, "other": {}}}}
    documents = others.loaded_project.documents
    joined = join_endpoints(slices, others.architecture, documents, {"guard": "guard"})
    # The type that the graph makes of a node is for those without a component.
    assert joined.slices["graph.yaml"] == {**kept, "component_types": {"other": {}}}  # type: ignore[dict-item]
    assert (slices["graph.yaml"]["nodes"], joined.ports) == ({"guard": node}, {})


def test_what_no_port_of_a_type_is_becomes_internal_and_internal_topics_are_said_once(tmp_path: Path) -> None:
    text = """\
project: {id: p}
ros: {distro: jazzy}
component_types: {t: {outputs: {tick: std_msgs/msg/Bool}}}
groups: {g: {components: {clock: {is: t}}}}
nodes:
  clock:
    implements: g.clock
    publishes: {tick: /tick}
    internal: {publishes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage}}}
"""
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    others = check_project(tmp_path / "archgen.yaml")
    assert not [each for each in others.findings if each.severity is Severity.ERROR]
    seen = {
        "publishes": {
            "tick": {"topic": "/tick", "message": "std_msgs/msg/Bool"},
            "frames": {"topic": "/tf", "message": "tf2_msgs/msg/TFMessage"},
            "more": {"topic": "/more", "message": "std_msgs/msg/Bool"},
        }
    }
    documents = others.loaded_project.documents
    joined = join_endpoints({"a.yaml": {"nodes": {"clock": seen}}}, others.architecture, documents, {"clock": "clock"})
    internal = {"publishes": {"more": {"topic": "/more", "message": "std_msgs/msg/Bool"}}}
    assert joined.slices["a.yaml"] == {"nodes": {"clock": {"internal": internal}}}


def test_ports_of_a_component_are_called_as_its_node_was_seen_with(tmp_path: Path) -> None:
    text = "project: {id: p}\nros: {distro: jazzy}\nnodes: {imu: {publishes: {data: /imu/data, state: /imu/state}}}\n"
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    others = check_project(tmp_path / "archgen.yaml")
    slices = {
        "w.yaml": {
            "groups": {"g": {"components": {"imu": {"outputs": {"imu_data": "sensor_msgs/msg/Imu"}}}}},
            "nodes": {"imu": {"implements": "g.imu", "publishes": {"imu_data": "imu/data"}}},
        }
    }
    joined = join_endpoints(slices, others.architecture, others.loaded_project.documents, {"imu": "imu"})
    assert joined.ports == {"g.imu": {"imu_data": "data"}}
    assert joined.slices["w.yaml"]["nodes"] == {"imu": {"implements": "g.imu"}}
    assert joined.slices["w.yaml"]["groups"]["g"]["components"]["imu"]["outputs"] == {
        "imu_data": "sensor_msgs/msg/Imu",
        "state": None,
    }
