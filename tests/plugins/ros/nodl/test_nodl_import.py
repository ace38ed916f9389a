"""Files of NoDL become component types; what `archgen generate nodl` wrote comes back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from archgen.importers.foreign_import import ForeignFileError, ForeignImport
from archgen.pipeline import check_project
from archgen.plugins.ros.nodl.nodl_import import read_nodl
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from archgen.syntax.yaml_writer import write_yaml
from tests.generators.test_neighbours import PROJECT

INTERFACE = """\
<interface version="1">
  <node name="Watcher" executable="watch">
    <parameter name="rate" type="int"/>
    <parameter name="names" type="string_array"/>
    <topic name="/scan" type="sensor_msgs/msg/LaserScan" role="subscription"/>
    <topic name="~/state" type="std_msgs/String" role="both"/>
    <service name="reset" type="std_srvs/srv/Trigger" role="server"/>
    <action name="/go" type="nav2_msgs/action/NavigateToPose" role="client"/>
  </node>
  <node name="empty" executable="empty"/>
</interface>
"""
DOCUMENT = """\
nodl_version: 2
description: Finds things.
parameters:
  rate: {type: double, default_value: 10.0, description: How often., validation: {bounds<>: [1.0, 100.0]}}
publishers:
  - name: /found
    type: geometry_msgs/msg/Pose
    description: What was found.
    qos: {history: KEEP_LAST, depth: 3, reliability: BEST_EFFORT, durability: SYSTEM_DEFAULT, deadline_ns: 20000000, lifespan_ns: 0}
subscriptions:
  - {name: image, type: sensor_msgs/Image, qos: {history: KEEP_ALL, reliability: RELIABLE}}
service_servers: [{name: /reset, type: std_srvs/srv/Trigger}]
action_clients: [{name: /go, type: nav2_msgs/action/NavigateToPose}]
"""


def read_text(folder: Path, name: str, text: str | bytes) -> ForeignImport:
    path = folder / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    return read_nodl([path])


def list_types(result: ForeignImport) -> dict[str, Any]:
    return dict(result.slices["nodl_types.yaml"]["component_types"])


def test_the_first_version_is_xml(tmp_path: Path) -> None:
    result = read_text(tmp_path, "a.nodl.xml", INTERFACE)
    assert result.notes == ()
    assert list_types(result) == {
        "watcher": {
            "inputs": {
                "scan": "sensor_msgs/msg/LaserScan",
                "state": "std_msgs/msg/String",
                "go": "nav2_msgs/action/NavigateToPose",
            },
            "outputs": {"state": "std_msgs/msg/String", "reset": "std_srvs/srv/Trigger"},
            "parameters": {"rate": {"type": "integer"}, "names": {"type": "string[]"}},
            "node": {
                "executable": "watch",
                "name": "Watcher",
                "subscribes": {"scan": "/scan", "state": "~/state"},
                "publishes": {"state": "~/state"},
                "serves": {"reset": "reset"},
                "calls": {"go": "/go"},
            },
        },
        "empty": {"inputs": {}, "outputs": {}, "node": {"executable": "empty"}},
    }
    assert result.taken == {"action": 1, "node": 2, "parameter": 2, "service": 1, "topic": 3}


def test_the_second_version_is_yaml(tmp_path: Path) -> None:
    result = read_text(tmp_path, "finder.nodl.yaml", DOCUMENT)
    types = list_types(result)
    assert types["finder"]["outputs"]["found"] == {"type": "geometry_msgs/msg/Pose", "description": "What was found."}
    assert types["finder"]["inputs"] == {"image": "sensor_msgs/msg/Image", "go": "nav2_msgs/action/NavigateToPose"}
    assert types["finder"]["description"] == "Finds things."
    assert types["finder"]["parameters"]["rate"]["type"] == "float"
    assert types["finder"]["node"]["publishes"]["found"] == {
        "topic": "/found",
        "qos": {"history": "keep_last", "depth": 3, "reliability": "best_effort", "deadline": "20000000 ns"},
    }
    assert [(each.kind, each.fate, each.span.line) for each in result.notes] == [("qos", "noted", 9)]
    folder = tmp_path / "project"
    folder.mkdir()
    sections = {"project": {"id": "p"}, "ros": {"distro": "jazzy"}, "component_types": types}
    sections["groups"] = {"g": {"components": {"finder": {"is": "finder"}}}}
    (folder / "archgen.yaml").write_text(write_yaml(sections), encoding="utf-8")
    assert not check_project(folder).has_errors


def test_what_was_generated_comes_back(tmp_path: Path) -> None:
    source, again = tmp_path / "source", tmp_path / "again"
    for folder in (source, again):
        folder.mkdir()
    (source / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    written = read_documents(source)
    types = list_types(read_nodl(sorted(source.rglob("*.nodl.yaml"))))
    sections = {"project": {"id": "lab"}, "ros": {"distro": "jazzy"}, "component_types": types}
    sections["groups"] = {"g": {"components": {name: {"is": name} for name in types}}}
    sections["nodes"] = {name: {"implements": f"g.{name}"} for name in types}
    (again / "archgen.yaml").write_text(write_yaml(sections), encoding="utf-8")
    assert read_documents(again) == written


def test_names_that_nobody_knows_are_left_out(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        """\
archgen: 1
project: {id: lab}
ros: {distro: jazzy}
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool, p: std_msgs/msg/Bool, s: std_srvs/srv/Trigger}}}}}
nodes: {old: {implements: a, status: existing, package: p, executable: e, publishes: {p: /known}}}
""",
        encoding="utf-8",
    )
    (document,) = read_documents(tmp_path).values()
    assert [each["name"] for each in document["publishers"]] == ["/known"]
    assert "service_servers" not in document


def read_documents(folder: Path) -> dict[str, Any]:
    project = check_project(folder)
    assert not project.has_errors, [each.message for each in project.findings]
    write_workspace(project, OutputOptions(), "nodl", folder / "ws")
    return {each.name: yaml.safe_load(each.read_text(encoding="utf-8")) for each in folder.rglob("*.nodl.yaml")}


@pytest.mark.parametrize(
    ("text", "kind", "line"),
    [
        ("nodl_version: 2\ninclude: [{ref: 'local://b.nodl.yaml'}]\n", "include", 2),
        ("nodl_version: 2\npublishers: {a: b}\n", "publishers", 2),
        ("nodl_version: 2\npublishers:\n  - word\n", "publishers", 3),
        ("nodl_version: 2\npublishers:\n  - {name: 'a b', type: std_msgs/String}\n", "topic", 3),
        ("nodl_version: 2\npublishers:\n  - {name: a, type: String}\n", "topic", 3),
        ("nodl_version: 2\nservice_servers:\n  - {name: a, type: std_msgs/msg/String}\n", "service", 3),
        ("nodl_version: 2\nservice_servers:\n  - {name: a, type: p/A, qos: {depth: 1}}\n", "qos", 3),
        ("nodl_version: 2\npublishers:\n  - {name: a, type: p/A, qos: {depth: -1}}\n", "qos", 3),
    ],
)
def test_what_is_not_taken_is_told(text: str, kind: str, line: int, tmp_path: Path) -> None:
    result = read_text(tmp_path, "a.nodl.yaml", text)
    assert [(each.kind, each.fate, each.span.line) for each in result.notes] == [(kind, "not taken", line)]


@pytest.mark.parametrize(
    ("element", "kind"),
    [
        ('<topic name="a" type="p/msg/A" role="server"/>', "topic"),
        ('<parameter name="a b" type="int"/>', "parameter"),
        ('<parameter name="a" type="thing"/>', "parameter"),
        ("<other/>", "other"),
    ],
)
def test_elements_that_are_not_taken_are_told(element: str, kind: str, tmp_path: Path) -> None:
    text = f'<interface version="1"><node name="n" executable="n">\n{element}</node></interface>'
    assert [(each.kind, each.span.line) for each in read_text(tmp_path, "a.nodl.xml", text).notes] == [(kind, 2)]


def test_a_node_without_a_name_is_told(tmp_path: Path) -> None:
    result = read_text(tmp_path, "a.nodl.xml", '<interface version="1"><node/></interface>')
    assert [each.message for each in result.notes] == ["a node has no name"]
    assert result.slices == {}


@pytest.mark.parametrize(
    "text",
    [
        "nodl_version: 1\n",
        "- a\n",
        "a: [\n",
        "<robot/>",
        "<interface>",
        '<!DOCTYPE a [<!ENTITY b "c">]><interface>&b;</interface>',
        b"\xff\xfe\x00",
        "",
    ],
)
def test_files_that_are_no_nodl_are_refused(text: str | bytes, tmp_path: Path) -> None:
    with pytest.raises(ForeignFileError):
        read_text(tmp_path, "a.nodl.yaml", text)


def test_a_large_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ForeignFileError):
        read_text(tmp_path, "a.nodl.yaml", "nodl_version: 2\n" + "# " + "x" * 4_000_000)
