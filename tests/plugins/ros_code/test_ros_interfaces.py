"""Packages of messages: what comes out is read back, by archgen, by rosbags, and by ROS itself."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from archgen.syntax.interface_definitions import parse_interface_definition
from archgen.syntax.yaml_writer import write_yaml
from tests.outside_tools import ask_ros_parsers
from tests.property_sizes import count_examples
from tests.running import ROOT, contents

COMMENTS = st.text(st.characters(exclude_categories=["Cs", "Cc"]), min_size=1) | st.sampled_from(
    ("a\nb", "a\r\nint8 evil", "---", "# x", "\u2028int8 evil", "int8 evil=1", "\\\nint8 evil", "@optional")
)
JUDGES = ROOT / "tests" / "judges" / "ros_definitions.py"
PROJECT = """\
archgen: 1
project: {id: bot, title: "Bot & Co <x>", version: 1.2.3}
ros: {distro: DISTRO}
partners: {lab: {title: The lab, contact: "Ann, ann@lab.example"}}
types:
  Grip:
    message: arm_msgs/msg/Grip
    comment: "How */ wide\\nand where."
    constants: {WIDEST: {type: float32, value: 0.2, comment: m}, NAME: {type: string, value: "it is so"}}
    fields:
      stamp: std_msgs/Header
      width: {type: float64, unit: m, comment: between the fingers}
      joints: {type: "float64[7]"}
      mode: Mode
      poses: Pose[]
      at: time
  Mode: {values: [IDLE, RUN, 'OFF']}
  Pose: geometry_msgs/Pose
  Boxed: {generic: [T], fields: {sender: string, payload: T}}
  Plan: {request: {goal: Pose}, response: {ok: bool, grips: "Grip[]"}}
  Move: {request: Grip, response: {ok: bool}, feedback: {left: float32}}
groups:
  g:
    components:
      a: {functionality: Grips., outputs: {grip: Grip, boxed: Boxed<Grip>, plan: Plan, move: Move}}
      b: {functionality: Looks., inputs: {grip: a.grip, boxed: a.boxed, plan: a.plan, move: a.move}}
"""
OWN_MODE = "  Mode: {message: mode_msgs/msg/Mode, "
FILES = (
    "src/arm_msgs/CMakeLists.txt",
    "src/arm_msgs/msg/Grip.msg",
    "src/arm_msgs/package.xml",
    "src/bot_msgs/CMakeLists.txt",
    "src/bot_msgs/action/Move.action",
    "src/bot_msgs/msg/BoxedGrip.msg",
    "src/bot_msgs/package.xml",
    "src/bot_msgs/srv/Plan.srv",
    "src/mode_msgs/CMakeLists.txt",
    "src/mode_msgs/msg/Mode.msg",
    "src/mode_msgs/package.xml",
)


def generate(folder: Path, text: str, **options: str) -> Mapping[str, str]:
    """Return the files of a project's packages, by path."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text, "utf-8")
    project = check_project(folder)
    assert not project.has_errors, [str(each) for each in project.findings]
    result = write_workspace(
        project, OutputOptions(), "ros_interfaces", folder / "ws", WorkspaceRequest(options=options)
    )
    assert result.is_complete, result.findings
    return {path: data.decode() for path, data in contents(folder / "ws").items() if not path.startswith(".")}


@pytest.fixture(params=["jazzy", "noetic"])
def distro(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture
def made(distro: str, tmp_path: Path) -> Mapping[str, str]:
    text = PROJECT.replace("DISTRO", distro).replace("  Mode: {", OWN_MODE)
    return generate(tmp_path, text)


def test_files(made: Mapping[str, str]) -> None:
    assert tuple(made) == FILES


def test_a_message(made: Mapping[str, str], distro: str) -> None:
    assert made["src/arm_msgs/msg/Grip.msg"].splitlines() == [
        "# Made by archgen from the type Grip of the architecture.",
        "# How * / wide",
        "# and where.",
        "float32 WIDEST=0.2  # m",
        "string NAME=it is so" if distro == "noetic" else 'string NAME="it is so"',
        "std_msgs/Header stamp",
        "float64 width  # [m] between the fingers",
        "float64[7] joints",
        "mode_msgs/Mode mode",
        "geometry_msgs/Pose[] poses",
        "time at" if distro == "noetic" else "builtin_interfaces/Time at",
    ]


def _definitions(made: Mapping[str, str]) -> dict[str, str]:
    """Return the texts of interfaces by their full names."""
    return {
        f"{package}/{kind}/{name.partition('.')[0]}": text
        for path, text in made.items()
        if len(parts := path.split("/")) == 4
        for _, package, kind, name in (parts,)
    }


def test_archgen_reads_back_what_it_knows(made: Mapping[str, str], distro: str, tmp_path: Path) -> None:
    known = check_project(tmp_path).architecture.interfaces.definitions
    for name, text in _definitions(made).items():
        read = parse_interface_definition(text, name, "x", ros1=distro == "noetic")
        assert read.diagnostics == ()
        for parts, known_parts in zip(read.interface.parts, known[name].parts, strict=True):
            assert [(each.name, each.type, each.array) for each in parts] == [
                (each.name, each.type, each.array) for each in known_parts
            ]
            assert [each.comment for each in parts if each.name == "width"] in ([], ["[m] between the fingers"])


def test_ros_reads_it(made: Mapping[str, str], distro: str) -> None:
    definitions = _definitions(made)
    cases = [
        [distro == "noetic", *each] for each in definitions.items() if distro == "jazzy" or "/action/" not in each[0]
    ]
    read = ask_ros_parsers(cases)
    assert None not in read, list(zip(cases, read, strict=True))


def test_packages_say_what_they_need(made: Mapping[str, str], distro: str) -> None:
    package = ET.fromstring(made["src/bot_msgs/package.xml"])  # noqa: S314 - just made
    assert package.get("format") == ("2" if distro == "noetic" else "3")
    own_action_package = "actionlib_msgs" if distro == "noetic" else "action_msgs"
    times = [] if distro == "noetic" else ["builtin_interfaces"]
    assert [each.text for each in package.findall("depend")] == [
        "arm_msgs",
        *times,
        "geometry_msgs",
        "mode_msgs",
        "std_msgs",
        own_action_package,
    ]
    assert package.findtext("version") == "1.2.3"
    assert package.findtext("description") == "Interfaces of Bot & Co <x>, made by archgen from its architecture."
    maintainer = package.find("maintainer")
    assert maintainer is not None
    assert (maintainer.text, maintainer.get("email")) == ("The lab", "ann@lab.example")


def test_catkin_reads_the_packages(made: Mapping[str, str]) -> None:
    catkin_package = pytest.importorskip("catkin_pkg.package")
    for path, text in made.items():
        if path.endswith("package.xml"):
            warnings: list[str] = []
            package = catkin_package.parse_package_string(text, warnings=warnings)
            assert warnings == []
            assert package.name == path.split("/")[1]


def test_an_option_takes_the_other_generation(tmp_path: Path) -> None:
    made = generate(tmp_path, PROJECT.replace("DISTRO", "jazzy").replace("  Mode: {", OWN_MODE), ros="1", license="MIT")
    assert "<license>MIT</license>" in made["src/bot_msgs/package.xml"]
    assert "time at" in made["src/arm_msgs/msg/Grip.msg"].splitlines()
    assert "catkin_package" in made["src/bot_msgs/CMakeLists.txt"]


@given(COMMENTS, COMMENTS, COMMENTS)
@settings(max_examples=count_examples(40))
def test_whatever_comments_say_the_fields_stay(
    tmp_path_factory: pytest.TempPathFactory, comment: str, remark: str, unit: str
) -> None:
    fields = {"a": {"type": "string", "comment": remark, "unit": unit}, "b": "int8"}
    data = {
        "archgen": 1,
        "ros": {"distro": "jazzy"},
        "types": {"T": {"comment": comment, "fields": fields}},
        "groups": {"g": {"components": {"c": {"functionality": "x", "outputs": {"o": "T"}}}}},
    }
    made = generate(tmp_path_factory.mktemp("any"), write_yaml(data))
    ((name, text),) = _definitions(made).items()
    read = parse_interface_definition(text, name, "x", ros1=False)
    assert read.diagnostics == ()
    assert [(each.name, each.type) for each in read.interface.parts[0]] == [("a", "string"), ("b", "int8")]
