"""Models for other tools: what they hold is what the architecture holds, and any text of it stays text."""

from __future__ import annotations

import csv
import io
import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml

from archgen.emit.backend_manifests import find_backends
from archgen.pipeline import CheckedProject, check_project
from archgen.products.output_options import OutputOptions
from archgen.products.project_outputs import render_exported
from archgen.products.project_views import select_elements
from archgen.products.workspace_product import write_workspace
from archgen.views.generation.generation_context import GenerationContext
from archgen.views.generation.structure_view import make_view
from tests import hostile
from tests.outside_tools import JUDGES_FOLDER, find_tool, run_judge
from tests.running import ROOT, archgen_here

PROJECT = """\
archgen: 1
project: {id: lab, title: The lab}
ros: {distro: jazzy}
component_types:
  arm:
    functionality: Grips.
    inputs: {goal: std_msgs/String}
    outputs: {state: {from: grip.state}}
    components:
      grip: {functionality: Closes., inputs: {goal: {from: self.goal}}, outputs: {state: State}}
groups:
  g:
    title: First
    owner: certh
    components:
      left: {is: arm}
      right: {is: arm, title: Left}
      user:
        functionality: Wants.
        inputs: {states: {from: [left.state, right.state]}, reset: {from: server.reset}}
        outputs: {goal: std_msgs/String}
        parameters:
          speed: {value: 1.5, range: [0, 2], unit: m/s}
          mode: {value: slow, choices: [slow, fast], read_only: true}
          names: [a, b]
          count: 3
      server: {functionality: Serves., inputs: {}, outputs: {reset: std_srvs/srv/Trigger}}
  other:
    title: "A \\"second\\" group"
    components:
      logger: {functionality: Writes., inputs: {states: {from: g.left.state}}, outputs: {}}
nodes:
  user: {implements: g.user, host: pc, package: pack, executable: run, publishes: {goal: {qos: {depth: 3, deadline: 20 ms}}}}
  driver: {kind: program, command: [drive]}
hosts: {pc: {title: Computer}}
partners: {certh: {title: CERTH}}
types: {State: {fields: {text: string}}}
"""
FILES = [
    name for name, each in find_backends(ROOT / "docs")[0].items() if each.makes == "file" and each.emitter == "text"
]


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> CheckedProject:
    folder = tmp_path_factory.mktemp("lab")
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    checked_project = check_project(folder)
    assert not checked_project.has_errors, [each.message for each in checked_project.findings]
    return checked_project


def export(checked_project: CheckedProject, backend: str, selector: str = "", level: str = "implementation") -> str:
    selection = select_elements(checked_project, selector)[0] if selector else None
    options = OutputOptions(selection, selector, level)  # type: ignore[arg-type]
    return render_exported(checked_project, options, backend).decode()


def test_every_neighbour_is_tried() -> None:
    assert FILES == ["d2", "graphml", "mermaid", "plantuml", "structurizr", "xmi"]


def test_the_view_holds_both_levels(lab: CheckedProject) -> None:
    data = make_view(GenerationContext(lab.architecture)).data
    assert [each["id"] for each in data["components"]] == [
        *("g.left", "g.left.grip", "g.right", "g.right.grip", "g.user", "g.server", "other.logger"),
    ]
    assert [(each["id"], each["parent"], each["is_composed"]) for each in data["components"][:2]] == [
        ("g.left", "", True),
        ("g.left.grip", "g.left", False),
    ]
    assert [each["id"] for each in data["groups"][0]["components"]] == ["g.left", "g.right", "g.user", "g.server"]
    assert {(each["output"], each["input"]) for each in data["connections"]} == {
        *((f"g.{side}.grip.state", "g.user.states") for side in ("left", "right")),
        *(("g.left.grip.state", each) for each in ("other.logger.states",)),
        ("g.server.reset", "g.user.reset"),
    }
    # Who calls is at the tail, although the answer flows to him.
    assert {"tail": "g.user", "head": "g.server", "flow": "service", "labels": ["Trigger"]} in data["arrows"]
    assert {each["name"] for each in data["topics"]} >= {"/g/left/grip/state"}
    assert [(each["id"], each["nodes"]) for each in data["hosts"]] == [("pc", ["user"])]


def test_a_selection_and_a_level_are_obeyed(lab: CheckedProject) -> None:
    selected = export(lab, "graphml", "other")
    assert "other.logger" in selected
    assert "g.user" not in selected
    assert "ROS node" in export(lab, "graphml")
    assert "ROS node" not in export(lab, "graphml", level="functional")


def read_graph(text: str) -> tuple[dict[str, dict[str, str]], list[tuple[str, str, dict[str, str]]]]:
    names = "{http://graphml.graphdrawing.org/xmlns}"
    root = ET.fromstring(text)  # noqa: S314 - just made
    keys = {each.get("id"): each.get("attr.name") for each in root.iter(f"{names}key")}

    def read_data(element: ET.Element) -> dict[str, str]:
        return {str(keys[each.get("key")]): each.text or "" for each in element.iter(f"{names}data")}

    nodes = {str(each.get("id")): read_data(each) for each in root.iter(f"{names}node")}
    edges = [(str(each.get("source")), str(each.get("target")), read_data(each)) for each in root.iter(f"{names}edge")]
    assert len(nodes) == len(list(root.iter(f"{names}node")))
    assert all(end in nodes for tail, head, _ in edges for end in (tail, head))
    return nodes, edges


def test_graphml_joins_all_that_there_is(lab: CheckedProject) -> None:
    nodes, edges = read_graph(export(lab, "graphml"))
    assert nodes["component:g.left"]["kind"] == "composed component"
    assert nodes["node:user"] == {
        "kind": "ROS node",
        "label": "User",
        "id": "user",
        "package": "pack",
        "executable": "run",
    }
    assert nodes["node:driver"]["kind"] == "program"
    found = {(tail, head, data["kind"]) for tail, head, data in edges}
    assert {
        ("component:g.left", "component:g.left.grip", "contains"),
        ("component:g.left.grip", "component:other.logger", "connection"),
        ("node:user", "component:g.user", "implements"),
        ("node:user", "host:pc", "runs on"),
    } <= found
    assert {data["kind"] for *_, data in edges} >= {"publishes", "subscribes", "serves", "calls"}


def check_structurizr(text: str) -> set[str]:
    """Hold a workspace against the rules that Structurizr documents for its DSL; return the identifiers."""
    token = re.compile(r'"(?:[^"\\\n]|\\")*"|[^\s"]+')
    depth, identifiers, keys = 0, set[str](), set[str]()
    for line in text.splitlines():
        words = token.findall(line)
        if not words or words[0] == "#":
            continue
        assert "".join(words).replace(" ", "") == line.replace(" ", ""), line
        assert not line.rstrip().endswith("\\")
        assert "${" not in line
        if words == ["}"]:
            depth -= 1
            continue
        assert "}" not in words, line
        assert "{" not in words[:-1], line
        depth += words[-1] == "{"
        if len(words) > 1 and words[1] == "=":
            assert re.fullmatch(r"[A-Za-z0-9_]+", words[0])
            assert words[0] not in identifiers
            identifiers.add(words[0])
        elif len(words) > 1 and words[1] == "->":
            # No reference looks ahead.
            assert {words[0], words[2]} <= identifiers, line
        elif words[0] in {"systemContext", "container", "component", "deployment"} and words[1] in identifiers:
            assert words[-2] not in keys
            keys.add(words[-2])
    assert depth == 0
    return identifiers


def test_structurizr_has_groups_components_and_relationships(lab: CheckedProject) -> None:
    text = export(lab, "structurizr")
    identifiers = check_structurizr(text)
    assert {"group___g", "g__left__grip", "other__logger"} <= identifiers
    assert 'g__user -> g__server "Trigger" "service"' in text
    assert 'infrastructureNode "User (user)" "" "pack/run"' in text
    # Components of a container differ in their names.
    assert 'g__left__grip = component "Grip (g.left.grip)"' in text


def test_boxes_stand_in_their_frames(lab: CheckedProject) -> None:
    for backend, frame, box, arrow in (
        ("mermaid", 'subgraph g__left["Left"]', 'g__left__grip("Grip")', 'g__user -.->|"Trigger"| g__server'),
        (
            "plantuml",
            'component "Left" as g__left {',
            'component "Grip" as g__left__grip',
            "g__user ..> g__server : Trigger",
        ),
        ("d2", "g__left: 'Left' {", "g__left__grip: 'Grip'", "group___g.g__user -> group___g.g__server: 'Trigger'"),
    ):
        lines = [line.strip() for line in export(lab, backend).splitlines()]
        assert lines.index(frame) < lines.index(box), backend
        assert any(line.startswith(arrow) for line in lines), backend


def test_nodl_says_what_a_node_has(lab: CheckedProject, tmp_path: Path) -> None:
    write_workspace(lab, OutputOptions(), "nodl", tmp_path)
    files = {each.name: yaml.safe_load(each.read_text(encoding="utf-8")) for each in tmp_path.rglob("*.nodl.yaml")}
    # A program is no node.
    assert "driver.nodl.yaml" not in files
    for document in files.values():
        check_nodl(document)
    user = files["user.nodl.yaml"]
    assert user["publishers"] == [
        {
            "name": "/g/user/goal",
            "type": "std_msgs/msg/String",
            "qos": {
                "history": "KEEP_LAST",
                "depth": 3,
                "reliability": "RELIABLE",
                "durability": "VOLATILE",
                "liveliness": "AUTOMATIC",
                "deadline_ns": 20_000_000,
            },
        }
    ]
    assert [each["type"] for each in user["service_clients"]] == ["std_srvs/srv/Trigger"]
    assert user["parameters"] == {
        "speed": {
            "type": "double",
            "default_value": 1.5,
            "description": "(m/s)",
            "validation": {"bounds<>": [0.0, 2.0]},
        },
        "mode": {
            "type": "string",
            "default_value": "slow",
            "read_only": True,
            "validation": {"one_of<>": [["slow", "fast"]]},
        },
        "names": {"type": "string_array", "default_value": ["a", "b"]},
        "count": {"type": "int", "default_value": 3},
    }


def check_nodl(document: dict[str, object]) -> None:
    """Hold a document against what version 2 of NoDL documents of its keys and values."""
    topics = {"name", "type", "qos", "description"}
    keys = {
        **dict.fromkeys(("publishers", "subscriptions"), topics),
        **dict.fromkeys(("service_servers", "service_clients"), topics),
        **dict.fromkeys(("action_servers", "action_clients"), topics - {"qos"}),
    }
    assert document["nodl_version"] == 2
    assert set(document) <= {"nodl_version", "description", "parameters", *keys}
    for section, allowed in keys.items():
        for each in document.get(section, ()):  # type: ignore[attr-defined]
            assert {"name", "type"} <= set(each) <= allowed
            assert re.fullmatch(r"[/~A-Za-z][A-Za-z0-9_/]*[A-Za-z0-9_]|[A-Za-z]", each["name"])
            assert re.fullmatch(r"[a-zA-Z][a-zA-Z0-9_]*(/(msg|srv|action))?/[A-Z][a-zA-Z0-9]*", each["type"])
            if section in {"publishers", "subscriptions"}:
                assert {"history", "reliability"} <= set(each["qos"])
                assert ("depth" in each["qos"]) == (each["qos"]["history"] == "KEEP_LAST")


def test_tables_hold_what_the_model_holds(lab: CheckedProject, tmp_path: Path) -> None:
    archgen_here("build", "--only", "csv", "-C", str(lab.root), "-o", str(tmp_path), cwd=tmp_path)
    tables = {
        each.stem: list(csv.DictReader(io.StringIO(each.read_text(encoding="utf-8"), newline="")))
        for each in tmp_path.rglob("*.csv")
    }
    assert sorted(tables) == [
        *("components", "connections", "endpoints", "groups", "hosts", "nodes", "parameters", "ports", "topics"),
    ]
    assert [each["title"] for each in tables["groups"]] == ["First", 'A "second" group']
    assert {each["id"] for each in tables["ports"]} >= {"g.left.goal", "g.left.grip.state", "other.logger.states"}
    (goal,) = (each for each in tables["endpoints"] if each["name"] == "/g/user/goal")
    assert (goal["node"], goal["use"], goal["message"], goal["depth"]) == (
        "user",
        "publishes",
        "std_msgs/msg/String",
        "3",
    )
    assert {each["name"]: each["value"] for each in tables["parameters"]}["speed"] == "1.5"


def make_hostile_project(kind: str, folder: Path) -> CheckedProject:
    (folder / "archgen.yaml").write_text(hostile.written(hostile.project(hostile.TEXTS[kind])), "utf-8")
    return check_project(folder)


@pytest.mark.parametrize("kind", hostile.TEXTS)
def test_hostile_text_stays_text(kind: str, tmp_path: Path) -> None:
    hostile_project = make_hostile_project(kind, tmp_path)
    read_graph(export(hostile_project, "graphml"))
    check_structurizr(export(hostile_project, "structurizr"))
    for line in export(hostile_project, "mermaid").splitlines()[2:]:
        # Outside of labels stand names and arrows alone.
        assert re.fullmatch(r"[\w\s().|\[\]<>=-]*", re.sub(r'"[^"]*"', "", line)), line
    for line in export(hostile_project, "d2").splitlines()[1:]:
        assert re.fullmatch(
            r"[\w\s.:{}>-]*", re.sub(r"'(?:[^']|'')*'", "", line).replace("style.stroke-dash: 4", "")
        ), line


@pytest.fixture(scope="module")
def all_projects(lab: CheckedProject, tmp_path_factory: pytest.TempPathFactory) -> list[CheckedProject]:
    return [lab, *(make_hostile_project(each, tmp_path_factory.mktemp("hostile")) for each in hostile.TEXTS)]


@pytest.mark.build
def test_plantuml_reads_it(all_projects: list[CheckedProject], tmp_path: Path) -> None:
    files = [tmp_path / f"{position}.puml" for position in range(len(all_projects))]
    for file, checked_project in zip(files, all_projects, strict=True):
        file.write_text(export(checked_project, "plantuml"), encoding="utf-8")
    command: tuple[str | Path, ...] = (find_tool("plantuml"), "-checkonly", "-charset", "UTF-8", *files)
    run_judge(*command)
    # The judge can tell: it refuses what is wrong.
    files[-1].write_text('@startuml\ncomponent "a\n@enduml\n', encoding="utf-8")
    assert run_judge(*command, statuses=range(256)).returncode != 0


@pytest.mark.build
def test_d2_reads_it(all_projects: list[CheckedProject], tmp_path: Path) -> None:
    files = [tmp_path / f"{position}.d2" for position in range(len(all_projects))]
    expected = []
    for file, checked_project in zip(files, all_projects, strict=True):
        file.write_text(export(checked_project, "d2"), encoding="utf-8")
        data = make_view(GenerationContext(checked_project.architecture)).data
        # A shape for each group and component: no text made another one.
        expected.append(f"{file.name} {len(data['components']) + len(data['groups'])} shapes")
    done = run_judge(find_tool("node"), JUDGES_FOLDER / "compile_d2.mjs", *files)
    assert done.stdout.splitlines() == expected
