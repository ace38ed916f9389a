"""The names of topics, services and actions that nodes of the shipped library have, as on the robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.link import mapping_values
from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.project.library_reading import load_shipped_component_types
from archgen.syntax.yaml_tree import MappingNode

NAMELESS = {
    "gz_spawner": {"robot_description"},
    "move_group": {"follow_joint_trajectory"},
    "rectify": {"camera_info"},
    "rviz": {"robot_description", "map", "scan", "points", "image", "odometry", "path", "markers"},
}
"""Inputs whose names stand in arguments and files of a program's own, or follow another one's: no source of the package tells them."""


def list_uses(body: MappingNode) -> Iterator[tuple[str, str, MappingNode]]:
    node = mapping_values.get_mapping(body, "node")
    for section in ("publishes", "subscribes", "serves", "calls"):
        for key, _, use in mapping_values.iterate_elements(node, section):
            yield section, key, use


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_each_input_says_what_the_program_calls_it(distro: str) -> None:
    for name, entry in load_shipped_component_types(distro).items():
        body = mapping_values.get_body(entry)
        named = {
            key
            for section, key, use in list_uses(body)
            if section in {"subscribes", "calls"} and {"topic", "own_name", "named_by"} & use.entries.keys()
        }
        inputs = {
            key
            for key, _, port in mapping_values.iterate_elements(body, "inputs")
            if mapping_values.get_text(port, "medium") != "physical"
        }
        assert inputs - named <= NAMELESS.get(name, set()), name
        texts = [
            mapping_values.get_text(port, "description") or ""
            for _, _, port in mapping_values.iterate_elements(body, "inputs")
        ]
        assert not any("Topic `" in text for text in texts), name


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_a_default_that_is_declared_is_the_name_that_the_program_has(distro: str) -> None:
    for name, entry in load_shipped_component_types(distro).items():
        body = mapping_values.get_body(entry)
        parameters = mapping_values.get_mapping(body, "parameters")
        for _, key, use in list_uses(body):
            declared = mapping_values.get_mapping(parameters, mapping_values.get_text(use, "named_by") or "")
            default = mapping_values.get_text(declared, "value")
            assert default is None or default == mapping_values.get_text(use, "own_name"), (name, key)


def check_architecture(tmp_path: Path, text: str) -> Architecture:
    (tmp_path / "archgen.yaml").write_text(text, encoding="utf-8")
    return pipeline.check_project(tmp_path).architecture


def list_program_names(architecture: Architecture, node: str) -> dict[str, list[str]]:
    """Return what a program itself says, made absolute, by use; remaps change what stands in `name`."""
    names: dict[str, list[str]] = {}
    for endpoint in architecture.endpoints:
        if endpoint.node == node:
            names.setdefault(endpoint.use, []).append(endpoint.program_name or endpoint.name or "")
    return {use: sorted(each) for use, each in names.items()}


def test_a_filter_reads_what_its_parameters_name_and_nothing_else(tmp_path: Path) -> None:
    architecture = check_architecture(
        tmp_path,
        "archgen: 1\nproject: {id: robot, title: Robot}\nros: {distro: humble}\nlibraries: {ros: builtin}\n"
        "groups: {base: {components: {localisation: {is: ros.ekf}, user: {inputs: {odom: localisation.odometry_filtered}}}}}\n"
        "nodes:\n"
        "  ekf_filter_node: {implements: base.localisation, remaps: {odometry/filtered: /odom},"
        " parameters: {odom0: odom/unfiltered, imu0: imu/data}}\n"
        "  user: {implements: base.user, package: p, executable: b, subscribes: {odom: /odom}}\n",
    )
    assert list_program_names(architecture, "ekf_filter_node") == {
        "publishes": ["/odometry/filtered", "/tf"],
        "subscribes": ["/imu/data", "/odom/unfiltered", "/set_pose"],
    }
    assert sorted(each.name or "" for each in architecture.endpoints if each.node == "ekf_filter_node") == [
        "/imu/data",
        "/odom",
        "/odom/unfiltered",
        "/set_pose",
        "/tf",
    ]
    assert {finding.rule for finding in pipeline.check_project(tmp_path).findings} == {"missing-detail"}


STRETCH = """\
archgen: 1
project: {id: stretch, title: Stretch}
ros: {distro: humble}
libraries: {ros: builtin}
groups:
  drivers:
    components:
      joints: {is: ros.joint_state_publisher}
      description: {is: ros.robot_state_publisher}
      filter: {is: ros.laser_filter}
      joystick: {is: ros.joy}
      teleop: {is: ros.teleop_twist_joy}
  navigation:
    components:
      controller: {is: ros.controller_server}
      planner: {is: ros.planner_server}
      behaviours: {is: ros.behavior_server}
      navigator: {is: ros.bt_navigator}
      waypoints: {is: ros.waypoint_follower}
      manager: {is: ros.lifecycle_manager}
nodes:
  joint_state_publisher:
    {implements: drivers.joints, status: existing, parameters: {source_list: [/stretch/joint_states], rate: 30.0}}
  robot_state_publisher: {implements: drivers.description, status: existing}
  laser_filter: {implements: drivers.filter, status: existing}
  joy_node: {implements: drivers.joystick, status: existing}
  teleop_twist_joy_node: {implements: drivers.teleop, status: existing, remaps: {cmd_vel: /stretch/cmd_vel}}
  controller_server:
    implements: navigation.controller
    status: existing
    remaps: {/tf: tf, /tf_static: tf_static, /cmd_vel: /stretch/cmd_vel}
    parameter_files: [nav2_params.yaml]
  planner_server: {implements: navigation.planner, status: existing, parameter_files: [nav2_params.yaml]}
  behavior_server: {implements: navigation.behaviours, status: existing, parameter_files: [nav2_params.yaml]}
  bt_navigator: {implements: navigation.navigator, status: existing, parameter_files: [nav2_params.yaml]}
  waypoint_follower: {implements: navigation.waypoints, status: existing}
  lifecycle_manager_navigation: {implements: navigation.manager, status: existing}
"""
STRETCH_PARAMETERS = """\
bt_navigator: {ros__parameters: {odom_topic: /odom}}
controller_server: {ros__parameters: {controller_frequency: 20.0}}
local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [obstacle_layer, voxel_layer, inflation_layer]
      obstacle_layer: {observation_sources: scan, scan: {topic: /scan_filtered, data_type: LaserScan}}
      voxel_layer: {observation_sources: scan, scan: {topic: /scan_filtered, data_type: LaserScan}}
global_costmap:
  global_costmap:
    ros__parameters:
      obstacle_layer: {observation_sources: scan, scan: {topic: /scan_filtered, data_type: LaserScan}}
planner_server: {ros__parameters: {expected_planner_frequency: 20.0}}
behavior_server:
  ros__parameters: {costmap_topic: local_costmap/costmap_raw, footprint_topic: local_costmap/published_footprint}
"""
STRETCH_NAMES = {
    "joint_state_publisher": {
        "publishes": ["/joint_states"],
        "subscribes": ["/robot_description", "/stretch/joint_states"],
    },
    "robot_state_publisher": {
        "publishes": ["/robot_description", "/tf", "/tf_static"],
        "subscribes": ["/joint_states"],
    },
    "laser_filter": {"publishes": ["/scan_filtered"], "subscribes": ["/scan"]},
    "joy_node": {"publishes": ["/joy"], "subscribes": ["/joy/set_feedback"]},
    "teleop_twist_joy_node": {"publishes": ["/cmd_vel"], "subscribes": ["/joy"]},
    "controller_server": {
        "publishes": [
            "/cmd_vel",
            "/local_costmap/costmap",
            "/local_costmap/costmap_raw",
            "/local_costmap/published_footprint",
        ],
        "subscribes": ["/odom", "/scan_filtered", "/speed_limit"],
        "serves": ["/follow_path"],
    },
    "planner_server": {
        "publishes": [
            "/global_costmap/costmap",
            "/global_costmap/costmap_raw",
            "/global_costmap/published_footprint",
            "/plan",
        ],
        "subscribes": ["/map", "/scan_filtered"],
        "serves": ["/compute_path_through_poses", "/compute_path_to_pose"],
    },
    "behavior_server": {
        "publishes": ["/cmd_vel"],
        "subscribes": ["/local_costmap/costmap_raw", "/local_costmap/published_footprint"],
        "serves": ["/backup", "/drive_on_heading", "/spin", "/wait"],
    },
    "bt_navigator": {
        "subscribes": ["/goal_pose", "/odom"],
        "serves": ["/navigate_through_poses", "/navigate_to_pose"],
        "calls": [
            "/backup",
            "/compute_path_through_poses",
            "/compute_path_to_pose",
            "/follow_path",
            "/smooth_path",
            "/spin",
            "/wait",
        ],
    },
    "waypoint_follower": {"serves": ["/follow_waypoints"], "calls": ["/navigate_to_pose"]},
    "lifecycle_manager_navigation": {
        "serves": ["/lifecycle_manager_navigation/is_active", "/lifecycle_manager_navigation/manage_nodes"]
    },
}
"""Read from the robot's public launch and parameter files and the sources of the packages, before remaps."""


def test_a_robot_of_eleven_nodes_of_the_library_has_all_of_its_names(tmp_path: Path) -> None:
    (tmp_path / "nav2_params.yaml").write_text(STRETCH_PARAMETERS, encoding="utf-8")
    architecture = check_architecture(tmp_path, STRETCH)
    names = {node: list_program_names(architecture, node) for node in architecture.nodes}
    assert names == STRETCH_NAMES
    assert sum(len(each) for uses in names.values() for each in uses.values()) == 51
    assert {(each.node, each.program_name, each.name) for each in architecture.endpoints if each.is_moved} == {
        ("teleop_twist_joy_node", "/cmd_vel", "/stretch/cmd_vel"),
        ("controller_server", "/cmd_vel", "/stretch/cmd_vel"),
    }


def test_what_a_condition_turns_off_is_not_there(tmp_path: Path) -> None:
    text = (
        "archgen: 1\nproject: {id: robot, title: Robot}\nros: {distro: jazzy}\nlibraries: {ros: builtin}\n"
        "groups: {g: {components: {it: {is: ros.imu_filter_madgwick, parameters: {use_mag: false, publish_tf: false}}}}}\n"
    )
    names = list_program_names(check_architecture(tmp_path, text), "it")
    assert names == {"publishes": ["/imu/data"], "subscribes": ["/imu/data_raw"]}


def test_a_program_may_be_composed_or_run_by_itself(tmp_path: Path) -> None:
    text = (
        "archgen: 1\nproject: {id: robot, title: Robot}\nros: {distro: jazzy}\nlibraries: {ros: builtin}\n"
        "groups: {g: {components: {it: {is: ros.rectify}}}}\n"
    )
    node = check_architecture(tmp_path, text).nodes["it"]
    assert (node.package, node.executable, node.plugin) == ("image_proc", "rectify_node", "image_proc::RectifyNode")
    assert node.own_name == "RectifyNode"
    assert node.name == "it"


def test_a_topic_that_an_instance_writes_is_remapped_from_what_the_program_says(tmp_path: Path) -> None:
    text = (
        "archgen: 1\nproject: {id: robot, title: Robot}\nros: {distro: jazzy}\nlibraries: {ros: builtin}\n"
        "groups: {g: {components: {lidar: {is: ros.urg_node, node: {publishes: {scan: /front/scan}}},"
        " planner: {is: ros.planner_server, node: {serves: {compute_path_to_pose: /plan}, publishes: {plan: [/a, /b]}}},"
        " filter: {is: ros.laser_filter, inputs: {scan: lidar.scan}}}}}\n"
        "nodes: {f: {implements: g.filter, publishes: {scan_filtered: {qos: sensor_data}}}}\n"
    )
    architecture = check_architecture(tmp_path, text)
    own_names = {each.port: (each.name, each.own_name) for each in architecture.endpoints}
    assert own_names["g.lidar.scan"] == ("/front/scan", "scan")
    assert own_names["g.filter.scan"] == ("/front/scan", "scan")
    assert own_names["g.planner.compute_path_to_pose"] == ("/plan", "compute_path_to_pose")
    assert own_names["g.planner.plan"] == ("/b", None)
    assert own_names["g.filter.scan_filtered"] == ("/scan_filtered", None)
    assert "conflicting-values" not in {finding.rule for finding in pipeline.check_project(tmp_path).findings}
