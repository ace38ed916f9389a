"""The packages of nodes that are generated: whole ones, of programs whose modules are no words of Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import write_workspace
from archgen.views.generation.generation_context import GenerationContext


def test_a_module_is_no_word_of_the_language(tmp_path: Path) -> None:
    existing = ", ".join(f"{name}: {{implements: {name}, status: existing}}" for name in "bcd")
    made = make_programs(tmp_path, f"{{a: {{implements: a, package: rt, executable: class}}, {existing}}}")
    assert [(each["executable"], each["module"], each["class_name"]) for each in made.data["programs"]] == [
        ("class", "class_", "Class")
    ]


def test_a_program_of_a_node_that_exists_is_not_made_for_another_one(tmp_path: Path) -> None:
    made = make_programs(
        tmp_path,
        "{a: {implements: a, package: cams, executable: cam, status: existing}, b: {implements: b, package: cams,"
        " executable: cam}, c: {implements: c, package: cams, executable: other}, d: {implements: d, status: existing}}",
    )
    assert [each["executable"] for each in made.data["programs"]] == ["other"]


@pytest.mark.parametrize("part", [{"host": "left"}, {"nodes": frozenset({"a"})}])
def test_a_package_is_made_whole_or_not_at_all(tmp_path: Path, part: dict[str, Any]) -> None:
    nodes = (
        "{a: {implements: a, package: p, executable: go, host: left}, b: {implements: b, package: p, executable: go,"
        " host: right}, c: {implements: c, package: p, host: right}, d: {implements: d, package: q, host: right}}"
    )
    whole, made = make_programs(tmp_path, nodes).data, make_programs(tmp_path, nodes, **part).data
    assert made["packages"] == whole["packages"][:1]
    # The program of two nodes is that of both: its name and topics are those of neither.
    assert [each["executable"] for each in made["programs"]] == ["c", "go"]
    assert [each["id"] for each in made["programs"][1]["nodes"]] == ["a", "b"]


def make_programs(tmp_path: Path, written_nodes: str, **part: Any) -> Any:  # noqa: ANN401 - of the context
    components = ", ".join(f"{name}: {{outputs: {{out: std_msgs/msg/String}}}}" for name in "abcd")
    (tmp_path / "p.yaml").write_text(
        f"archgen: 1\nproject: {{id: rt, title: Robot}}\nros: {{distro: jazzy}}\nhosts: {{left: , right: }}\n"
        f"groups: {{g: {{components: {{{components}}}}}}}\nnodes: {written_nodes.replace('implements: ', 'implements: g.')}\n",
        encoding="utf-8",
    )
    options = {"language": "python"}
    context = GenerationContext(check_project(tmp_path / "p.yaml").architecture, options=options, **part)
    return make_view(context)


ORCHARD = """\
archgen: 1
project: {id: orchard, title: Orchard}
ros: {distro: jazzy}
component_types:
  smoother:
    generic: [T]
    functionality: Smooths.
    inputs: {raw: T}
    outputs: {smooth: T}
    node: {package: filters, executable: smoother}
  arm: {functionality: Picks., inputs: {fruits: Words}, outputs: {state: Words}, parameters: {force: 20.0}}
groups:
  g:
    components:
      cam: {outputs: {words: Words, level: Level, bad: Bad}}
      s1: {is: smoother<Words>, inputs: {raw: cam.words}}
      s2: {is: smoother<Level>, inputs: {raw: cam.level}}
      node: {inputs: {words: s1.smooth, bad: cam.bad}, node: {language: cpp}}
      lifecycle: {inputs: {words: s1.smooth}}
      zleft: {is: arm, inputs: {fruits: cam.words}, parameters: {force: 25.0}}
types: {Words: std_msgs/msg/String, Level: std_msgs/msg/Float32, Bad: {fields: {class: int32}}}
"""
SECOND_ARM = (
    "      right: {is: arm, inputs: {fruits: s1.smooth}, parameters: {force: 35.0}, node: {namespace: /right}}\ntypes"
)


def generate_all(folder: Path, text: str, workspace: Path) -> dict[str, str]:
    """Return all that the backends of ROS 2 write, by path."""
    folder.mkdir()
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    for backend in ("ros_interfaces", "ros2_python", "ros2_cpp", "ros2_launch"):
        write_workspace(check_project(folder), OutputOptions(), backend, workspace)
    files = (each for each in sorted((workspace / "src").rglob("*")) if each.is_file())
    return {str(each.relative_to(workspace)): each.read_text(encoding="utf-8") for each in files}


def test_both_languages_stand_in_one_group(tmp_path: Path) -> None:
    files = generate_all(tmp_path / "p", ORCHARD, tmp_path / "w")
    assert "src/orchard_g/setup.py" in files
    assert "src/orchard_g_cpp/src/node_node.cpp" in files
    (host,) = (text for path, text in files.items() if "/launch/hosts/" in path)
    assert 'pkg="orchard_g_cpp" exec="node"' in host
    assert 'pkg="orchard_g" exec="lifecycle"' in host


def test_what_a_container_loads_is_what_is_made(tmp_path: Path) -> None:
    """Standing in a container, or having a class, says as much of a node as its kind."""
    nodes = "containers: {box: }\nnodes:\n  lifecycle: {implements: lifecycle, container: box}\n  cam: {implements: cam, plugin: 'orchard::Cam'}\n"
    files = generate_all(tmp_path / "p", ORCHARD + nodes, tmp_path / "w")
    (host,) = (text for path, text in files.items() if "/launch/hosts/" in path)
    assert 'plugin="orchard_g_cpp::Lifecycle"' in host
    assert (
        "RCLCPP_COMPONENTS_REGISTER_NODE(orchard_g_cpp::Lifecycle)" in files["src/orchard_g_cpp/src/lifecycle_node.cpp"]
    )
    assert 'pkg="orchard_g_cpp" exec="cam"' in host
    assert "RCLCPP_COMPONENTS_REGISTER_NODE(orchard::Cam)" in files["src/orchard_g_cpp/src/cam_node.cpp"]
    assert not {"src/orchard_g/orchard_g/cam_node.py", "src/orchard_g/orchard_g/lifecycle_node.py"} & files.keys()


def test_generic_programs_keep_their_ports(tmp_path: Path) -> None:
    files = generate_all(tmp_path / "p", ORCHARD, tmp_path / "w")
    assert "self.raw_subscription" in files["src/filters/filters/smoother_words_node.py"]
    assert "import Float32" in files["src/filters/filters/smoother_level_node.py"]


def test_no_class_hides_what_its_module_imports(tmp_path: Path) -> None:
    files = generate_all(tmp_path / "p", ORCHARD, tmp_path / "w")
    assert "class LifecycleProgramNode(Node):" in files["src/orchard_g/orchard_g/lifecycle_node.py"]
    assert "class LifecycleProgram:" in files["src/orchard_g/orchard_g/lifecycle.py"]


def test_a_message_that_cannot_be_is_refused_by_its_nodes_too(tmp_path: Path) -> None:
    files = generate_all(tmp_path / "p", ORCHARD, tmp_path / "w")
    assert not [path for path in files if path.endswith("Bad.msg")]
    assert "Bad" not in files["src/orchard_g/orchard_g/cam_node.py"]
    (said,) = make_view(GenerationContext(check_project(tmp_path / "p").architecture)).findings
    assert said.message == (
        "`g.cam.bad` of the node `cam` is left out: `ros_interfaces` generates no `orchard_msgs/msg/Bad`, and says why"
    )
    assert str(said.span) == "archgen.yaml:15:51"


def test_what_several_nodes_run_names_none_of_them(tmp_path: Path) -> None:
    """Beside a component type, which names itself, nodes share a program by its `executable`."""
    part = "{{functionality: Cuts {0}., title: The {0} one, inputs: {{words: cam.words}}, parameters: {{blade: 1.5}}, timing: {{rate: 2 Hz}}, node: {{package: cut, executable: cutter}}}}"
    parts = "".join(f"      {side}_one: {part.format(side)}\n" for side in ("left", "right"))
    files = generate_all(tmp_path / "p", ORCHARD.replace("\ntypes", "\n" + parts + "types"), tmp_path / "w")
    made = {path: text for path, text in files.items() if path.startswith("src/cut/")}
    assert "# cutter.words" in made["src/cut/cut/cutter_node.py"]
    assert "# cutter.blade" in made["src/cut/cut/cutter_node.py"]
    assert '"""What Cutter does:' in made["src/cut/cut/cutter.py"]
    # The README says which nodes run a program.
    assert [path for path, text in made.items() if "left" in text] == ["src/cut/README.md"]


def test_what_is_filled_in_at_the_start_is_no_default(tmp_path: Path) -> None:
    """A program that is started by hand would take `$(find-pkg-share cams)` for the value."""
    value = '{maps: "$(find-pkg-share cams)/maps", rate: 5}'
    text = ORCHARD.replace("cam: {", f"cam: {{parameters: {value}, ").replace("force: 20.0", 'force: "$(env FORCE)"')
    files = generate_all(tmp_path / "p", text, tmp_path / "w")
    for program, name, ros_type in (("cam", "maps", "STRING"), ("arm", "force", "DOUBLE")):
        node = files[f"src/orchard_g/orchard_g/{program}_node.py"]
        assert "$(" not in node + files[f"src/orchard_g/test/test_{program}_node.py"]
        assert f"'{name}',\n            Parameter.Type.{ros_type}," in node
    (host,) = (text for path, text in files.items() if "/launch/hosts/" in path)
    assert 'name="maps" value="$(find-pkg-share cams)/maps"' in host


def test_a_further_instance_changes_no_program(tmp_path: Path) -> None:
    one = generate_all(tmp_path / "p", ORCHARD, tmp_path / "w")
    two = generate_all(tmp_path / "q", ORCHARD.replace("\ntypes", "\n" + SECOND_ARM), tmp_path / "v")
    changed = {path for path in one if one[path] != two[path] and not path.startswith("src/orchard_bringup/")}
    # The nodes of a package are listed in its README.
    assert changed == {"src/orchard_g/README.md"}
    for path, text in one.items():
        if path.endswith(("_node.py", ".hpp", "_node.cpp")):
            assert "'/" not in text, path
            assert '"/' not in text, path


@pytest.mark.parametrize(("listed", "is_told"), [("ros2_python:", True), ("ros2_python: , ros_interfaces:", False)])
def test_messages_that_no_listed_backend_makes_are_told(tmp_path: Path, listed: str, is_told: bool) -> None:  # noqa: FBT001
    (tmp_path / "p.yaml").write_text(
        "archgen: 1\nproject: {id: rt, title: Robot}\nros: {distro: jazzy}\n"
        f"generate: {{into: ws, backends: {{{listed} }}}}\n"
        "groups: {g: {components: {a: {outputs: {out: Force}}}}}\nnodes: {a: {implements: g.a}}\n"
        "types: {Force: {fields: {level: float64}}}\n",
        encoding="utf-8",
    )
    context = GenerationContext(check_project(tmp_path / "p.yaml").architecture, options={"language": "python"})
    words = "programs need the package `rt_msgs`, which no backend makes that `generate` lists"
    assert [each.message for each in make_view(context).findings] == [words] * is_told
