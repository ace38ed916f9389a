"""Packages of ROS become component types with parameters, and types with fields; what cannot be said is noted."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.importers.foreign_import import ForeignFileError, ForeignImport
from archgen.pipeline import check_project
from archgen.plugins.ros.ros_package import package_programs
from archgen.plugins.ros.ros_package.package_import import read_packages
from archgen.syntax.yaml_writer import write_yaml

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>lifter</name>
  <version>1.2.0</version>
  <description>Lifts   parcels.</description>
  <maintainer email="a@b.c">A</maintainer>
  <license>Apache-2.0</license>
  <url type="website">https://example.org/lifter</url>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>rclcpp</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
DECLARED = """\
lift_control:
  rate: {type: double, default_value: 10, description: How often., validation: {bounds<>: [1, 100.5]}}
  mode: {type: string, default_value: slow, read_only: true, validation: {one_of<>: [[slow, fast]]}}
  joints: {type: string_array, default_value: [], validation: {unique<>: null}}
  gains:
    p: {type: double, default_value: 0.5, validation: {gt<>: [0.0]}}
    __map_joints:
      i: {type: double}
"""
PARAMETERS = """\
/front/lift_control:
  ros__parameters: {rate: 20.0, extra: {deep: [1, 2]}}
watcher:
  ros__parameters: {on: true}
/**:
  ros__parameters: {use_sim_time: true}
"""
CMAKE = """\
project(lifter)
set(node_name watcher)
add_executable(${node_name} src/watcher.cpp)   # add_executable(no src/no.cpp)
add_executable(test_lifter t.cpp)
rclcpp_components_register_node(lift PLUGIN "lifter::LiftControl" EXECUTABLE lift_control)
"""
MESSAGE = """\
# How a lift went.
uint8 OK=0   # all well
uint8 FAILED=1

uint8 state 1
geometry_msgs/Pose[] poses   # where it was
string<=10 name "up"
"""
EXPECTED = {
    "watcher": {
        "node": {"package": "lifter", "executable": "watcher", "language": "cpp"},
        "parameters": {"on": True},
    },
    "lift_control": {
        "node": {
            "package": "lifter",
            "plugin": "lifter::LiftControl",
            "kind": "composable",
            "language": "cpp",
            "executable": "lift_control",
        },
        "parameters": {
            "rate": {"type": "float", "value": 10.0, "description": "How often.", "range": [1, 100.5]},
            "mode": {"type": "string", "value": "slow", "read_only": True, "choices": ["slow", "fast"]},
            "joints": {"type": "string[]", "value": []},
            "gains.p": {"type": "float", "value": 0.5},
            "extra.deep": [1, 2],
        },
        "open": ["gains"],
    },
}


def write_package(folder: Path, **files: str) -> Path:
    """Write a package; `__` in a name stands for a dot, `___` for a folder."""
    for name, text in {"package__xml": MANIFEST, **files}.items():
        path = folder / name.replace("___", "/").replace("__", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder


def read_all(tmp_path: Path) -> ForeignImport:
    """Read a package that holds everything."""
    return read_packages(
        [
            write_package(
                tmp_path / "lifter",
                CMakeLists__txt=CMAKE,
                config___lift__yaml=PARAMETERS,
                src___lift_parameters__yaml=DECLARED,
                msg___LiftResult__msg=MESSAGE,
                srv___Lift__srv="float64 height\n---\nLiftResult result\n",
            )
        ]
    )


def test_programs_and_parameters_become_component_types(tmp_path: Path) -> None:
    imported = read_all(tmp_path)
    (sections,) = imported.slices.values()
    found: dict[str, Any] = sections["component_types"]
    for component in found.values():
        assert component["version"] == "1.2.0"
        assert component["urls"] == {"website": "https://example.org/lifter"}
        assert component["hints"]["package"]["license"] == "Apache-2.0"
        assert component["hints"]["package"]["description"] == "Lifts parcels."
    common = {"version", "urls", "hints", "status"}
    assert {
        name: {key: value for key, value in component.items() if key not in common} for name, component in found.items()
    } == EXPECTED
    assert found["lift_control"]["hints"]["package"]["declared_in"] == "lifter/src/lift_parameters.yaml"
    assert imported.taken == {
        "generate_parameter_library": 1,
        "msg": 1,
        "package": 1,
        "parameter": 7,
        "plug-in": 1,
        "program": 1,
        "srv": 1,
    }


def test_messages_become_types_with_fields(tmp_path: Path) -> None:
    (sections,) = read_all(tmp_path).slices.values()
    assert sections["types"] == {
        "Lift result": {
            "message": "lifter/msg/LiftResult",
            "fields": {
                "state": {"type": "uint8", "default": 1},
                "poses": {"type": "geometry_msgs/msg/Pose[]", "comment": "where it was"},
                "name": {"type": "string<=10", "default": "up"},
            },
            "constants": {
                "OK": {"type": "uint8", "value": 0, "comment": "How a lift went. all well"},
                "FAILED": {"type": "uint8", "value": 1},
            },
        },
        "Lift": {
            "message": "lifter/srv/Lift",
            "request": {"height": "float64"},
            "response": {"result": "lifter/msg/LiftResult"},
        },
    }


def test_what_cannot_be_said_is_noted_with_its_place(tmp_path: Path) -> None:
    notes = [f"{note.fate}: {note.span.file}:{note.span.line}: {note.message}" for note in read_all(tmp_path).notes]
    assert notes == [
        "not taken: lifter/config/lift.yaml:6: what is for `/**` belongs to no single node",
        "not taken: lifter/src/lift_parameters.yaml:4: `joints`: `unique` cannot be said",
        "not taken: lifter/src/lift_parameters.yaml:6: `p`: `gt: [0.0]` cannot be said",
        "noted: lifter/src/lift_parameters.yaml:7: the parameters below `__map_joints` stand once for each name in a list: any are accepted",
        "not taken: lifter/package.xml:2: 2 dependencies on other packages have no counterpart",
    ]


def test_the_result_is_a_sound_project(tmp_path: Path) -> None:
    imported = read_all(tmp_path)
    project = tmp_path / "project"
    project.mkdir()
    (project / "archgen.yaml").write_text("archgen: 1\nproject: {id: lift}\nros: {distro: jazzy}\n")
    for name, sections in imported.slices.items():
        (project / name).write_text(write_yaml(sections))
    assert not check_project(project).has_errors


def test_empty_parts_of_services_are_parts(tmp_path: Path) -> None:
    folder = write_package(tmp_path / "lifter", action___Wait__action="---\n---\n", srv___Ping__srv="---\n")
    imported = read_packages([folder])
    assert imported.slices["lifter.yaml"]["types"] == {
        "Wait": {"message": "lifter/action/Wait", "request": {}, "response": {}, "feedback": {}},
        "Ping": {"message": "lifter/srv/Ping", "request": {}, "response": {}},
    }
    assert check_types(imported, tmp_path / "project") == []


def check_types(imported: ForeignImport, folder: Path) -> list[str]:
    """Return the errors of a project that is made of an import."""
    folder.mkdir()
    (folder / "archgen.yaml").write_text("archgen: 1\nproject: {id: lift}\nros: {distro: jazzy}\n")
    for name, sections in imported.slices.items():
        (folder / name).write_text(write_yaml(sections))
    checked = check_project(folder)
    return [finding.message for finding in checked.findings if checked.has_errors]


def test_messages_that_archgen_knows_are_only_named(tmp_path: Path) -> None:
    folder = write_package(
        tmp_path / "std_srvs",
        package__xml=MANIFEST.replace("lifter<", "std_srvs<"),
        srv___SetBool__srv="bool data\n---\nbool success\nstring message\n",
    )
    (sections,) = read_packages([folder]).slices.values()
    assert sections == {"types": {"Set bool": {"message": "std_srvs/srv/SetBool"}}}


def test_python_packages_and_older_manifests_are_read(tmp_path: Path) -> None:
    write_package(
        tmp_path / "ws" / "old",
        package__xml="<package><name>old</name><buildtool_depend>catkin</buildtool_depend></package>",
        msg___When__msg="time stamp\nHeader header\n",
        setup__py="import os\nos.system('touch trace')\nsetup(entry_points={'console_scripts': ['run = old.main:main', 'bad']})\n",
        config___driver__param__yaml="/**:\n  ros__parameters: {rate: 5}\n",
    )
    imported = read_packages([tmp_path / "ws"])
    sections = imported.slices["old.yaml"]
    assert sections["component_types"]["run"]["node"] == {"package": "old", "executable": "run", "language": "python"}
    assert sections["component_types"]["driver"]["parameters"] == {"rate": 5}
    assert sections["types"]["When"]["fields"] == {"stamp": "time", "header": "std_msgs/msg/Header"}
    assert [note.fate for note in imported.notes] == ["not taken", "noted", "not taken"]
    assert not Path("trace").exists()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<package><version>1</version></package>", "it is no package.xml"),
        ("<robot><name>x</name></robot>", "it is no package.xml"),
        ("<package><name>", "only the first part of a file is there"),
        ("<!DOCTYPE a [<!ENTITY x 'y'>]><package><name>&x;</name></package>", "it declares a document type"),
        ("", "it is empty, or no XML"),
    ],
)
def test_what_is_no_package_is_told(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ForeignFileError) as caught:
        read_packages([write_package(tmp_path / "p", package__xml=text)])
    assert caught.value.message.startswith(message)


def test_a_folder_without_packages_is_told(tmp_path: Path) -> None:
    with pytest.raises(ForeignFileError) as caught:
        read_packages([tmp_path])
    assert caught.value.message == "there is no package.xml in it"


def test_packages_in_packages_and_names_that_look_like_tests(tmp_path: Path) -> None:
    for folder in ("", "inner"):
        (tmp_path / folder / "msg").mkdir(parents=True)
        (tmp_path / folder / "msg" / f"Of{folder.title() or 'Outer'}.msg").write_text("bool flag\n")
        (tmp_path / folder / "package.xml").write_text(MANIFEST.replace("lifter", folder or "outer"))
    cmake = """set(name a)
    if(x)
    set(name b)
    endif()
    add_executable(newest m.cpp)
    set_target_properties(newest PROPERTIES FOLDER x OUTPUT_NAME latest_map)
    add_executable(map_test m.cpp)
    add_executable(gridTest m.cpp)
    add_executable(${name} m.cpp)
    """
    (tmp_path / "CMakeLists.txt").write_text(cmake)
    (tmp_path / "setup.py").write_text("setup(entry_points={'console_scripts': [\n'a = b.c:Main.run', name(), 'x']})\n")
    imported = read_packages([tmp_path])
    (sections,) = imported.slices.values()
    assert list(sections["types"]) == ["Of outer"]
    assert list(sections["component_types"]) == ["latest_map", "a"]
    assert [f"{note.kind}:{note.span.line}: {note.message}" for note in imported.notes if note.kind != "depend"] == [
        "add_executable:9: the name of a program is computed: `${name}`",
        "console_scripts:2: which programs there are is computed",
        "console_scripts:2: `x` is no entry point",
    ]


def test_long_build_files_take_time_in_proportion(tmp_path: Path) -> None:
    (tmp_path / "package.xml").write_text(MANIFEST)
    # What compares every variable with every other one, or counts lines from the beginning, takes minutes.
    lines = (f"set(v{number} a)\n\nadd_executable(${{w{number}}} x)\n" for number in range(22_000))
    (tmp_path / "CMakeLists.txt").write_text("".join(lines))
    notes = [note for note in read_packages([tmp_path]).notes if note.kind == "add_executable"]
    assert (len(notes), notes[-1].span.line) == (22_000, 66_000)


@pytest.mark.parametrize(
    ("tools", "is_read"),
    [
        (
            '<buildtool_depend condition="$ROS_VERSION == 1">catkin</buildtool_depend><buildtool_depend condition="$ROS_VERSION == 2">ament_cmake</buildtool_depend>',
            True,
        ),
        ("<buildtool_depend>catkin</buildtool_depend>", False),
        ("<buildtool_depend>ament_cmake</buildtool_depend>", True),
    ],
)
def test_messages_of_packages_for_both_are_those_of_ros_2(tools: str, is_read: bool, tmp_path: Path) -> None:  # noqa: FBT001 - a case
    (tmp_path / "msg").mkdir()
    # Defaults are of ROS 2 only.
    (tmp_path / "msg" / "Rate.msg").write_text("float64 rate 5.0\n")
    manifest = MANIFEST.replace("<buildtool_depend>ament_cmake</buildtool_depend>", tools)
    manifest = manifest.replace("<build_type>ament_cmake</build_type>", "")
    (tmp_path / "package.xml").write_text(manifest)
    imported = read_packages([tmp_path])
    assert ([note.kind for note in imported.notes if note.kind != "depend"] == []) == is_read


def test_packages_lie_as_deep_as_they_like_and_too_many_files_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path.joinpath("src", *"abcdefgh")
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>deep</name></package>")
    assert [path.parent.name for path in package_programs.find_manifests((tmp_path / "src",))] == ["h"]
    monkeypatch.setattr(package_programs, "_MAX_PARTS", 9)
    assert package_programs.find_manifests((tmp_path / "src",))
    (folder / "one_more").touch()
    with pytest.raises(ForeignFileError, match="more than 9 files and folders") as refused:
        package_programs.find_manifests((tmp_path / "src",))
    assert refused.value.help_line == "give the folders of the packages instead"
