"""Ports whose names, or whose being there at all, parameters decide: `named_by` and `when`."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.derivation.parameter_names import name_ports_by_parameters

HEAD = "archgen: 1\nproject: {id: robot, title: Robot}\nros: {distro: jazzy}\n"
FILTER = """
component_types:
  filter:
    inputs:
      odom0: {type: nav_msgs/msg/Odometry, optional: true}
      scan: {type: sensor_msgs/msg/LaserScan, optional: true}
      cloud: {type: sensor_msgs/msg/PointCloud2, optional: true}
      reset: {type: std_msgs/msg/Empty, optional: true}
      plan: {type: std_srvs/srv/Trigger, optional: true}
    outputs:
      map: nav_msgs/msg/OccupancyGrid
      tf: tf2_msgs/msg/TFMessage
    parameters: {map_topic: map, publish_tf: true}
    open: ["*"]
    node:
      package: p
      executable: e
      publishes: {map: {own_name: map, named_by: map_topic}, tf: {topic: /tf, when: {publish_tf: true}}}
      subscribes:
        odom0: {named_by: odom0}
        scan: {named_by: "*.{sources}.topic", when: {"*.{sources}.kind": [scan, null]}}
        cloud: {named_by: "*.{sources}.topic", when: {"*.{sources}.kind": cloud}}
        reset: {own_name: ~/reset}
      calls: {plan: {own_name: plan, when: {use_plan: true}}}
"""


def list_names(tmp_path: Path, node: str, extra: str = "", files: dict[str, str] | None = None) -> dict[str, list[str]]:
    """Return the names on the wire of the ports of a node of the filter, in a namespace."""
    for name, content in (files or {}).items():
        (tmp_path / name).write_text(content, encoding="utf-8")
    text = f"groups: {{g: {{components: {{it: {{is: filter}}{extra}}}}}}}\nnodes: {{it: {{implements: g.it, namespace: /r, {node}}}}}\n"
    (tmp_path / "archgen.yaml").write_text(HEAD + FILTER + text, encoding="utf-8")
    names: dict[str, list[str]] = {}
    for endpoint in pipeline.check_project(tmp_path).architecture.endpoints:
        if endpoint.node == "it" and endpoint.port:
            names.setdefault(endpoint.port.rpartition(".")[2], []).append(endpoint.label)
    return names


PLAIN = {"map": ["/r/map"], "tf": ["/tf"], "reset": ["/r/it/reset"]}


def test_what_no_parameter_opens_is_not_there_and_defaults_count(tmp_path: Path) -> None:
    assert list_names(tmp_path, "parameters: {}") == PLAIN


@pytest.mark.parametrize(
    ("parameters", "names"),
    [
        ("odom0: odom/raw", {"odom0": ["/r/odom/raw"]}),
        ("odom0: /odom", {"odom0": ["/odom"]}),
        ("odom0: [a, /b]", {"odom0": ["/r/a", "/b"]}),
        ('odom0: ""', {}),
        ("odom0: []", {}),
        ("map_topic: maps/a", {"map": ["/r/maps/a"]}),
        ("publish_tf: false", {"tf": []}),
        ("use_plan: true", {"plan": ["/r/plan"]}),
        ("a: {sources: x, x: {topic: /s}}", {"scan": ["/s"]}),
        ("a: {sources: x}", {"scan": ["/r/x"]}),
        ("a: {sources: [x, y], x: {kind: cloud, topic: /c}, y: {kind: scan}}", {"scan": ["/r/y"], "cloud": ["/c"]}),
        ("a: {b: {sources: x y, x: {topic: /s}, y: {topic: /s}}}", {"scan": ["/s"]}),
        ("a: {sources: x, x: {topic: /s}}, b: {sources: x, x: {topic: /t}}", {"scan": ["/s", "/t"]}),
        ("a: {sources: x, x: {kind: sonar, topic: /s}}", {}),
        ("a: {sources: ''}", {}),
    ],
)
def test_names_follow_the_parameters(tmp_path: Path, parameters: str, names: dict[str, list[str]]) -> None:
    expected = {port: each for port, each in {**PLAIN, **names}.items() if each}
    assert list_names(tmp_path, f"parameters: {{{parameters}}}") == expected


def test_parameter_files_count_too(tmp_path: Path) -> None:
    files = {"p.yaml": "/**: {ros__parameters: {odom0: from_file}}\n"}
    assert list_names(tmp_path, "parameter_files: [p.yaml]", files=files)["odom0"] == ["/r/from_file"]


@pytest.mark.parametrize(
    "node",
    [
        "parameter_files: [missing.yaml]",
        "parameters: {odom0: $(var odom)}",
        "parameter_commands: {odom0: [find_topic]}",
        "parameters: {a: {sources: $(var sources)}}",
    ],
)
def test_a_name_that_is_not_known_is_none_that_a_parameter_gives(tmp_path: Path, node: str) -> None:
    names = list_names(tmp_path, node)
    opened = "scan" if "sources" in node else "odom0"
    assert opened in names
    assert not any("$(" in name for each in names.values() for name in each)


def test_a_written_topic_outranks_a_parameter_which_is_what_the_program_says(tmp_path: Path) -> None:
    node = "publishes: {map: /maps/best}, parameters: {map_topic: maps/a}"
    assert list_names(tmp_path, node)["map"] == ["/maps/best"]
    endpoints = pipeline.check_project(tmp_path).architecture.endpoints
    assert [each.own_name for each in endpoints if each.port == "g.it.map"] == ["maps/a"]


def test_a_reader_that_is_connected_takes_the_name_of_its_source(tmp_path: Path) -> None:
    wheels = (
        "{outputs: {odom: nav_msgs/msg/Odometry}, node: {package: w, executable: w, publishes: {odom: /wheels/odom}}}"
    )
    text = f"groups: {{g: {{components: {{it: {{is: filter, inputs: {{odom0: wheels.odom}}}}, wheels: {wheels}}}}}}}\n"
    (tmp_path / "archgen.yaml").write_text(HEAD + FILTER + text, encoding="utf-8")
    architecture = pipeline.check_project(tmp_path).architecture
    assert [each.name for each in architecture.endpoints if each.port == "g.it.odom0"] == ["/wheels/odom"]
    (tmp_path / "archgen.yaml").write_text(
        HEAD + FILTER + text.replace("wheels.odom}}", "wheels.odom}, parameters: {odom0: /other}}", 1), encoding="utf-8"
    )
    checked_project = pipeline.check_project(tmp_path)
    assert [each.name for each in checked_project.architecture.endpoints if each.port == "g.it.odom0"] == ["/other"]
    assert "unaccounted-topic" in {finding.rule for finding in checked_project.findings}


def test_inner_nodes_bring_what_files_say_to_them(tmp_path: Path) -> None:
    text = FILTER.replace(
        "      executable: e\n", "      executable: e\n      inner_nodes: {costs: costs/costs}\n"
    ).replace('"*.{sources}', '"costs.*.{sources}')
    (tmp_path / "p.yaml").write_text(
        "r: {costs: {costs: {ros__parameters: {layer: {sources: a b, a: {topic: /front}, b: {topic: rear}}}}}}\n"
        "costs: {costs: {ros__parameters: {layer: {sources: c}}}}\n",
        encoding="utf-8",
    )
    nodes = "nodes: {it: {implements: g.it, namespace: /r, parameter_files: [p.yaml]}}\n"
    project = f"groups: {{g: {{components: {{it: {{is: filter}}}}}}}}\n{nodes}"
    (tmp_path / "archgen.yaml").write_text(HEAD + text + project, encoding="utf-8")
    node = pipeline.check_project(tmp_path).architecture.nodes["it"]
    scan = next(use for use in node.uses if use.key == "scan")
    # Where `rear` leads depends on the version: what is not known is not said.
    assert (scan.is_open, scan.topics, scan.own_name) == (True, (), None)
    file = tmp_path / "p.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("topic: rear", "topic: /rear"), encoding="utf-8")
    node = pipeline.check_project(tmp_path).architecture.nodes["it"]
    assert next(use for use in node.uses if use.key == "scan").topics == ("/front", "/rear")


def test_a_thousand_sources_of_a_thousand_layers_take_no_time(tmp_path: Path) -> None:
    words = " ".join(f"s{number}" for number in range(1000))
    layers = ", ".join(f"l{number}: {{sources: {words if number == 0 else 'x'}}}" for number in range(1000))
    assert len(list_names(tmp_path, f"parameters: {{{layers}}}")["scan"]) == 1001


def test_a_node_without_a_component_follows_its_parameters_too(tmp_path: Path) -> None:
    text = (
        "nodes:\n  it: {package: p, executable: e, parameters: {odom: /wheels, publish_tf: false},"
        " publishes: {tf: {topic: /tf, message: tf2_msgs/msg/TFMessage, when: {publish_tf: true}}},"
        " subscribes: {odom: {named_by: odom, message: nav_msgs/msg/Odometry}, imu: {named_by: imu}}}\n"
    )
    (tmp_path / "archgen.yaml").write_text(HEAD + text, encoding="utf-8")
    endpoints = pipeline.check_project(tmp_path).architecture.endpoints
    assert [(each.use, each.name) for each in endpoints] == [("subscribes", "/wheels")]


def test_what_a_parameter_shuts_stays_shut_beside_files_that_cannot_be_read(tmp_path: Path) -> None:
    text = (
        "nodes:\n  it: {package: p, executable: e, status: existing, parameters: {stamped: false},"
        " parameter_files: [$(find-pkg-share p)/a.yaml],"
        " subscribes: {new: {topic: /new, when: {stamped: true}}, old: {topic: /old, when: {stamped: false}},"
        " third: {topic: /third, when: {third: true}}}}\n"
    )
    (tmp_path / "archgen.yaml").write_text(HEAD + text, encoding="utf-8")
    endpoints = pipeline.check_project(tmp_path).architecture.endpoints
    assert [each.name for each in endpoints] == ["/old", "/third"]


def test_a_project_without_such_ports_is_left_alone(tmp_path: Path) -> None:
    list_names(tmp_path, "parameters: {}")
    (tmp_path / "archgen.yaml").write_text(HEAD + "groups: {g: {components: {it: {}}}}\n", encoding="utf-8")
    architecture = pipeline.check_project(tmp_path).architecture
    assert name_ports_by_parameters(architecture) is architecture
