"""What the command-line tools of ROS print of a running robot becomes nodes that exist, and component types with their ports."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignFileError, ForeignImport
from archgen.pipeline import check_project
from archgen.plugins.ros.running_graph.graph_import import read_ros_1_graph, read_ros_2_graph
from archgen.syntax.yaml_writer import write_yaml

ROS_2 = """\
/front/driver
/planner
/box
$ ros2 node info /front/driver
/front/driver
  Subscribers:
    /clock: rosgraph_msgs/msg/Clock
    /parameter_events: rcl_interfaces/msg/ParameterEvent
  Publishers:
    /front/scan: sensor_msgs/msg/LaserScan
    /rosout: rcl_interfaces/msg/Log
  Service Servers:
    /front/driver/change_state: lifecycle_msgs/srv/ChangeState
    /front/driver/describe_parameters: rcl_interfaces/srv/DescribeParameters
    /front/driver/reset: std_srvs/srv/Empty
  Service Clients:

  Action Servers:

  Action Clients:

$ ros2 param dump /front/driver
/front/driver:
  ros__parameters:
    frame: "laser"
    filter:
      angles: [1.0, 2.5]
    qos_overrides:
      /parameter_events:
        publisher: {depth: 1000}
    use_sim_time: false
$ ros2 node info /planner
/planner
  Subscribers:
    /front/scan: sensor_msgs/msg/LaserScan
  Publishers:
    /planner/plan: nav_msgs/msg/Path
  Service Servers:
  Service Clients:
    /front/driver/reset: std_srvs/srv/Empty
  Action Servers:
    /drive: nav2_msgs/action/NavigateToPose
  Action Clients:

/box
  Service Servers:
    /box/_container/load_node: composition_interfaces/srv/LoadNode
$ ros2 component list
/box
  1  /planner
$ ros2 topic list -t
/front/scan [sensor_msgs/msg/LaserScan]
/parameter_events [rcl_interfaces/msg/ParameterEvent]
$ ros2 topic info -v /front/scan
Type: sensor_msgs/msg/LaserScan

Publisher count: 1

Node name: driver
Node namespace: /front
Topic type: sensor_msgs/msg/LaserScan
Topic type hash: RIHS01_0
Endpoint type: PUBLISHER
GID: 01.0f
QoS profile:
  Reliability: BEST_EFFORT
  History (Depth): KEEP_LAST (5)
  Durability: VOLATILE
  Lifespan: Infinite
  Deadline: 100000000 nanoseconds
  Liveliness: AUTOMATIC
  Liveliness lease duration: 9223372036.854775807 s

Subscription count: 1

Node name: planner
Node namespace: /
Topic type: sensor_msgs/msg/LaserScan
Endpoint type: SUBSCRIPTION
GID: 01.10
QoS profile:
  Reliability: BEST_EFFORT
  History (Depth): UNKNOWN
  Durability: VOLATILE

$ ros2 service list -t
/front/driver/reset [std_srvs/srv/Empty]
"""
ROS_2_NODES = {
    "driver": {
        "kind": "lifecycle",
        "namespace": "/front",
        "status": "existing",
        "observed": True,
        "publishes": {
            "scan": {
                "topic": "/front/scan",
                "message": "sensor_msgs/msg/LaserScan",
                "qos": {
                    "reliability": "best_effort",
                    "history": "keep_last",
                    "depth": 5,
                    "durability": "volatile",
                    "deadline": "100 ms",
                },
            }
        },
        "subscribes": {"clock": {"topic": "/clock", "message": "rosgraph_msgs/msg/Clock"}},
        "serves": {"reset": {"name": "/front/driver/reset", "message": "std_srvs/srv/Empty"}},
        "parameters": {"frame": "laser", "filter.angles": [1.0, 2.5]},
    },
    "planner": {
        "kind": "composable",
        "status": "existing",
        "observed": True,
        "publishes": {"plan": {"topic": "/planner/plan", "message": "nav_msgs/msg/Path"}},
        "subscribes": {
            "front_scan": {
                "topic": "/front/scan",
                "message": "sensor_msgs/msg/LaserScan",
                "qos": {"reliability": "best_effort", "durability": "volatile"},
            }
        },
        "serves": {"drive": {"name": "/drive", "message": "nav2_msgs/action/NavigateToPose"}},
        "calls": {"front_driver_reset": {"name": "/front/driver/reset", "message": "std_srvs/srv/Empty"}},
        "container": "box",
    },
}
ROS_1 = """\
--------------------------------------------------------------------------------
Node [/front/driver]
Publications:
 * /front/scan [sensor_msgs/LaserScan]
 * /rosout [rosgraph_msgs/Log]

Subscriptions:
 * /front/go [unknown type]

Services:
 * /front/driver/get_loggers
 * /front/driver/reset


contacting node http://pc:1234/ ...
Pid: 42
Connections:
 * topic: /rosout
    * to: /rosout
    * direction: outbound (4 - 10.0.0.1:5) [10]
    * transport: TCPROS

--------------------------------------------------------------------------------
Node [/planner]
Publications:
 * /drive/feedback [move_base_msgs/MoveBaseActionFeedback]
 * /drive/result [move_base_msgs/MoveBaseActionResult]
 * /drive/status [actionlib_msgs/GoalStatusArray]

Subscriptions:
 * /drive/cancel [actionlib_msgs/GoalID]
 * /drive/goal [move_base_msgs/MoveBaseActionGoal]
 * /front/scan [sensor_msgs/LaserScan]

Services: None

$ rosservice info /front/driver/reset
Node: /front/driver
URI: rosrpc://pc:4
Type: std_srvs/Empty
Args:
$ rostopic list -v

Published topics:
 * /front/scan [sensor_msgs/LaserScan] 1 publisher

Subscribed topics:
 * /front/scan [sensor_msgs/LaserScan] 1 subscriber
 * /front/go [std_msgs/Bool] 1 subscriber

$ rosparam dump
front:
  driver: {rate: 5.0, deep: {a: 1}}
robot_description: <robot/>
rosdistro: 'noetic

  '
run_id: 1-2
"""


def read_text(text: str, tmp_path: Path, ros: int) -> ForeignImport:
    """Read a dump."""
    dump = tmp_path / "robot.txt"
    # `rosnode` puts a blank behind its headings.
    dump.write_text(text.replace("ons:\n", "ons: \n"), encoding="utf-8")
    return read_ros_1_graph([dump]) if ros == 1 else read_ros_2_graph([dump])


def check_slices(imported: ForeignImport, folder: Path, distro: str) -> list[str]:
    """Return the errors of a project that is made of an import."""
    folder.mkdir()
    (folder / "archgen.yaml").write_text(f"archgen: 1\nproject: {{id: robot}}\nros: {{distro: {distro}}}\n")
    for name, sections in imported.slices.items():
        (folder / name).write_text(write_yaml(sections), encoding="utf-8")
    checked = check_project(folder)
    return [f"{finding.span}: {finding.message}" for finding in checked.findings if checked.has_errors]


def test_a_graph_of_ros_2(tmp_path: Path) -> None:
    imported = read_text(ROS_2, tmp_path, 2)
    assert imported.slices["running_nodes.yaml"] == {"containers": {"box": {}}, "nodes": ROS_2_NODES}
    assert imported.slices["running_types.yaml"]["component_types"]["driver"] == {
        "inputs": {"clock": "rosgraph_msgs/msg/Clock"},
        "outputs": {"scan": "sensor_msgs/msg/LaserScan", "reset": "std_srvs/srv/Empty"},
    }
    assert [note.message for note in imported.notes] == []
    assert imported.taken == {
        "QoS profile": 2,
        "calls": 1,
        "node": 3,
        "parameter": 2,
        "publishes": 3,
        "serves": 5,
        "subscribes": 3,
        "topic or service": 4,
    }
    assert check_slices(imported, tmp_path / "project", "jazzy") == []


def test_a_graph_of_ros_1(tmp_path: Path) -> None:
    imported = read_text(ROS_1, tmp_path, 1)
    nodes = imported.slices["running_nodes.yaml"]["nodes"]
    assert nodes == {
        "driver": {
            "namespace": "/front",
            "status": "existing",
            "observed": True,
            "publishes": {"scan": {"topic": "/front/scan", "message": "sensor_msgs/msg/LaserScan"}},
            "subscribes": {"go": {"topic": "/front/go", "message": "std_msgs/msg/Bool"}},
            "serves": {"reset": {"name": "/front/driver/reset", "message": "std_srvs/srv/Empty"}},
            "parameters": {"rate": 5.0, "deep": {"a": 1}},
        },
        "planner": {
            "status": "existing",
            "observed": True,
            "subscribes": {"front_scan": {"topic": "/front/scan", "message": "sensor_msgs/msg/LaserScan"}},
            "serves": {"drive": {"name": "/drive", "message": "move_base_msgs/action/MoveBase"}},
        },
    }
    assert imported.distro == "noetic"
    assert [note.message for note in imported.notes] == ["1 parameters stand below no node: `/robot_description`"]
    assert check_slices(imported, tmp_path / "project", "noetic") == []


def test_types_fit_the_nodes_that_implement_them(tmp_path: Path) -> None:
    imported = read_text(ROS_2, tmp_path, 2)
    for node_id in ("driver", "planner"):
        imported.slices["running_nodes.yaml"]["nodes"][node_id]["implements"] = f"g.{node_id}"
    components = {
        "driver": {"is": "driver", "inputs": {"clock": {"external": "The simulator"}}},
        "planner": {"is": "planner", "inputs": {"front_scan": "driver.scan", "front_driver_reset": "driver.reset"}},
    }
    imported.slices["running_types.yaml"]["groups"] = {"g": {"components": components}}  # type: ignore[index]
    assert check_slices(imported, tmp_path / "project", "jazzy") == []


def test_equal_nodes_have_keys_alike_and_one_type(tmp_path: Path) -> None:
    def tell(name: str, topic: str) -> str:
        return f"{name}\n  Publishers:\n    {topic}: sensor_msgs/msg/LaserScan\n"

    front, rear = tell("/robot1/front/lidar", "/robot1/front/scan"), tell("/robot1/rear/lidar", "/robot1/rear/scan")
    sections = read_text(front + rear, tmp_path, 2).slices
    assert list(sections["running_nodes.yaml"]["nodes"]) == ["robot1_front_lidar", "robot1_rear_lidar"]
    assert list(sections["running_types.yaml"]["component_types"]) == ["lidar"]
    sections = read_text(front + tell("/robot1/rear/lidar", "/cloud"), tmp_path, 2).slices
    assert list(sections["running_types.yaml"]["component_types"]) == ["robot1_front_lidar", "robot1_rear_lidar"]


def test_topics_of_endpoints_are_found_by_node_and_type(tmp_path: Path) -> None:
    text = "\n".join(line for line in ROS_2.splitlines() if not line.startswith("$"))
    imported = read_text(text, tmp_path, 2)
    node = imported.slices["running_nodes.yaml"]["nodes"]["driver"]
    assert node["publishes"]["scan"]["qos"]["reliability"] == "best_effort"


def test_a_bag_alone_gives_types(tmp_path: Path) -> None:
    bag = "path: x.bag\ntopics:      /scan    12 msgs @ 5.0 Hz : sensor_msgs/LaserScan\n             /tf  1 msg     : tf2_msgs/TFMessage  (2 connections)\n"
    assert read_text(bag, tmp_path, 1).slices == {
        "recorded_types.yaml": {
            "types": {
                "Laser scan": {"message": "sensor_msgs/msg/LaserScan"},
                "TF message": {"message": "tf2_msgs/msg/TFMessage"},
            }
        }
    }
    bag_2 = "Topic information: Topic: /scan | Type: sensor_msgs/msg/LaserScan | Count: 9 | Serialization Format: cdr\n"
    assert list(read_text(bag_2, tmp_path, 2).slices["recorded_types.yaml"]["types"]) == ["Laser scan"]


def test_lines_that_are_not_understood_are_noted(tmp_path: Path) -> None:
    imported = read_text("$ ros2 node list\n/a\nwhat is this\n/t [strange]\n$ x\n/b\n", tmp_path, 2)
    assert [f"{note.span.line}: {note.message}" for note in imported.notes] == [
        "3: it is not understood: `what is this`",
        "4: `strange` of `/t` is no message of ROS 2",
        "6: what `/b` is cannot be told: it stands alone",
    ]


PRINTED = """\
$ ros2 topic list -v
Published topics:
 * /front/scan [sensor_msgs/msg/LaserScan] 1 publisher
 * /plan [std_msgs/msg/String, std_msgs/msg/Int8] 2 publishers

Subscribed topics:
 * /front/scan [sensor_msgs/msg/LaserScan] 1 subscriber

$ ros2 topic list
/front/scan
/plan
$ ros2 service list
/reset
$ ros2 param list
/planner:
  rate (type: double)
  use_sim_time
$ ros2 lifecycle get
/planner: unconfigured [1]
$ ros2 service info /reset
Type: std_srvs/srv/Empty
Clients count: 1
Services count: 1
$ ros2 service type /enable
std_srvs/srv/SetBool
$ ros2 action info -t /drive
Action: /drive
Action clients: 1
    /planner [nav2_msgs/action/NavigateToPose]
Action servers: 1
    /driver [nav2_msgs/action/NavigateToPose]
$ ros2 node info /planner
/planner
  Subscribers:

  Publishers:
    /plan: std_msgs/msg/String
  Service Servers:

  Service Clients:
    /reset: std_srvs/srv/Empty
  Action Servers:

  Action Clients:

$ ros2 topic info -v /plan
Type: std_msgs/msg/String

Publisher count: 1

Node name: planner
Node namespace: /
Topic type: std_msgs/msg/String
Topic type hash: RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18
Endpoint type: PUBLISHER
GID: 01.0f.78.fd.f6.2c.07.64.00.00.00.00.00.00.27.03
QoS profile:
  Reliability: RELIABLE
  History (Depth): UNKNOWN
  Durability: TRANSIENT_LOCAL
  Lifespan: Infinite
  Deadline: Infinite
  Liveliness: AUTOMATIC
  Liveliness lease duration: Infinite

Subscription count: 0

$ ros2 param dump /planner
/planner:
  ros__parameters:
    deep:
      flag: true
    empty: ''
    frames:
    - a
    - b
    start_type_description_service: true
    text: 'a long text with words that go on and on so that yaml folds the line because
      it is longer than eighty characters: yes'
    use_sim_time: false

"""
"""As ros2cli prints it, beside nodes of ROS Jazzy that ran."""


def test_what_the_tools_print_of_real_nodes_is_read(tmp_path: Path) -> None:
    imported = read_text(PRINTED, tmp_path, 2)
    assert [(note.fate, note.span.line, note.message[:40]) for note in imported.notes] == [
        ("noted", 4, "`/plan` has several types: std_msgs/msg/")
    ]
    assert imported.slices["running_nodes.yaml"]["nodes"] == {
        "planner": {
            "status": "existing",
            "observed": True,
            "publishes": {
                "plan": {
                    "topic": "/plan",
                    "message": "std_msgs/msg/String",
                    "qos": {"reliability": "reliable", "durability": "transient_local"},
                }
            },
            "calls": {
                "drive": {"name": "/drive", "message": "nav2_msgs/action/NavigateToPose"},
                "reset": {"name": "/reset", "message": "std_srvs/srv/Empty"},
            },
            "parameters": {
                "deep.flag": True,
                "empty": "",
                "frames": ["a", "b"],
                "text": "a long text with words that go on and on so that yaml folds the line because it is longer than "
                "eighty characters: yes",
            },
        },
        "driver": {
            "status": "existing",
            "observed": True,
            "serves": {"drive": {"name": "/drive", "message": "nav2_msgs/action/NavigateToPose"}},
        },
    }


def test_ends_of_actions_are_taken_without_types(tmp_path: Path) -> None:
    told = (
        "$ ros2 action info /drive\nAction: /drive\nAction clients: 1\n    /planner\nAction servers: 1\n    /driver\n"
    )
    listed = "$ ros2 action list -t\n/drive [nav2_msgs/action/NavigateToPose]\n"
    action = {"name": "/drive", "message": "nav2_msgs/action/NavigateToPose"}
    imported = read_text(told + listed, tmp_path, 2)
    nodes = imported.slices["running_nodes.yaml"]["nodes"]
    assert (nodes["planner"]["calls"], nodes["driver"]["serves"]) == ({"drive": action}, {"drive": action})
    assert imported.notes == ()
    imported = read_text(told, tmp_path, 2)
    assert imported.slices["running_nodes.yaml"]["nodes"]["driver"]["serves"] == {"drive": {"name": "/drive"}}
    assert "the type of `/drive` of `/driver` is not known" in [note.message for note in imported.notes]


@pytest.mark.parametrize("ros", [1, 2])
@pytest.mark.parametrize("data", [b"", b"\n\n", b"hello\n", b"\0\1", b"\xff" * 100, b"/" * 100_000, b"a: [" * 5_000])
def test_what_is_no_dump_is_told(data: bytes, ros: int, tmp_path: Path) -> None:
    dump = tmp_path / "robot.txt"
    dump.write_bytes(data)
    with pytest.raises(ForeignFileError) as caught:
        (read_ros_1_graph if ros == 1 else read_ros_2_graph)([dump])
    assert caught.value.message in {"there is no node in it", "it is no text"}


@pytest.mark.parametrize("ros", [1, 2])
def test_large_dumps_take_time_in_proportion(ros: int, tmp_path: Path) -> None:
    if ros == 1:
        parts = [f"Node [/n{n}]\nPublications: \n * /t{n} [std_msgs/String]\n" for n in range(5_000)]
    else:
        parts = [f"/n{n}\n  Publishers:\n    /t{n}: std_msgs/msg/String\n" for n in range(5_000)]
    imported = read_text("".join(parts), tmp_path, ros)
    assert imported.taken["node"] == 5_000


@pytest.mark.parametrize(("written", "distro"), [("Debian", "noetic"), ("melodic", "melodic"), ("Mine", "")])
def test_the_distribution_is_one_that_there_is(tmp_path: Path, written: str, distro: str) -> None:
    file = tmp_path / "robot.txt"
    file.write_text(ROS_1.replace("noetic", written), encoding="utf-8")
    assert read_ros_1_graph([file]).distro == distro


def test_a_long_list_of_types_that_ends_in_something_else_is_read_at_once(tmp_path: Path) -> None:
    file = tmp_path / "robot.txt"
    types = ",".join(["a/msg/A"] * 5_000)
    file.write_text(f"$ ros2 node info /n\n/n\n  Publishers:\n    /t: {types} b\n    /u: a/msg/B\n", encoding="utf-8")
    imported = read_ros_2_graph([file])
    topics = [use for sections in imported.slices.values() for use in sections.get("nodes", {}).values()]
    assert "/u" in str(topics)
