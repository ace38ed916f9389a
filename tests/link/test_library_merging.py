"""What a project has of its libraries: component types and types, as if a packed file held them."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.checking.checked_packing import pack_checked_project
from archgen.compare.compare_versions import compare_versions
from archgen.pipeline import CheckedProject, check_project
from archgen.products.compared_versions import make_comparison_input
from archgen.products.project_views import select_elements
from archgen.syntax.yaml_writer import write_yaml

PROJECT = """archgen: 1
project: {id: robot, title: Robot}
libraries: {common: lib, more: more}
types: {Pose: geometry_msgs/msg/PoseStamped}
groups:
  sensing:
    title: Sensing
    components:
      front: {is: common.laser}
      head: {is: common.head, inputs: {at: front.pose}}
      smooth: {is: "common.filter<Pose>", inputs: {raw: front.pose}}
      screen: {inputs: {state: head.state, pose: smooth.clean}}
"""
LIBRARY = """component_types:
  driver: {abstract: true, outputs: {pose: Pose, spots: Spots}}
  laser: {is: driver, parameters: {range: 30.0}}
  filter: {generic: [T], inputs: {raw: T}, outputs: {clean: T}}
  head:
    inputs: {at: Pose}
    outputs: {state: {from: inner.clean}}
    components:
      inner: {is: "filter<Spots>", inputs: {raw: eye.spots}}
      eye: {same_as: laser}
  unused: {outputs: {x: Never}}
types:
  Pose: {fields: {x: float64}}
  Spots: {fields: {all: "Spot[]"}}
  Spot: {fields: {x: float64}}
  Never: {fields: {x: float64}}
"""
MORE = "types: {Spot: {fields: {x: float64}}, Never: {fields: {y: bool}}}\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    for name, text in {"archgen.yaml": PROJECT, "lib/a.yaml": LIBRARY, "more/a.yaml": MORE}.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def list_errors(checked: CheckedProject) -> list[str]:
    return [f"{d.span} {d.rule}: {d.message}" for d in checked.findings if d.severity == "error"]


def test_only_what_is_used_is_in_the_model(robot: Path) -> None:
    architecture = check_project(robot).architecture
    assert list(architecture.component_types) == ["common.driver", "common.filter", "common.head", "common.laser"]
    assert architecture.component_types["common.head"].title == "Head"
    libraries = {each.name: each.library for each in architecture.types.values() if not each.generic}
    assert libraries == {"Pose": None, "Spot": "common", "Spots": "common"}
    assert architecture.types["Pose"].message == "geometry_msgs/msg/PoseStamped"
    assert architecture.interfaces.names >= {"lib_msgs/msg/Spots", "lib_msgs/msg/Spot"}
    assert architecture.outputs["sensing.head.inner.clean"].type == "Spots"


def test_a_packed_file_holds_what_is_used_and_means_the_same(robot: Path) -> None:
    folder = check_project(robot)
    packed_text = write_yaml(pack_checked_project(folder).data)
    file = robot / "packed.yaml"
    file.write_text(packed_text)
    packed = check_project(file)
    assert write_yaml(pack_checked_project(packed).data) == packed_text
    assert "unused" not in packed_text
    assert "Never" not in packed_text
    assert "path:" not in packed_text
    assert packed.architecture.component_types == folder.architecture.component_types
    assert list_errors(packed) == list_errors(folder) == []
    assert not compare_versions(make_comparison_input(folder), make_comparison_input(packed)).changes


def test_two_libraries_that_differ_in_a_type_that_is_used(robot: Path) -> None:
    (robot / "more" / "a.yaml").write_text(MORE.replace("x: float64", "x: float32"))
    assert list_errors(check_project(robot)) == [
        "more/a.yaml:1:9 conflicting-values: the libraries `common` and `more` say different things of the type `Spot`"
    ]
    # The project's own word settles it.
    (robot / "b.yaml").write_text("types: {Spot: geometry_msgs/msg/Point}\n")
    assert list_errors(check_project(robot)) == []


def test_a_value_that_two_files_of_a_library_write(robot: Path) -> None:
    (robot / "lib" / "b.yaml").write_text("component_types: {laser: {parameters: {range: {value: 5.0}}}}\n")
    (error,) = list_errors(check_project(robot))
    assert error.startswith("lib/b.yaml:1:55 conflicting-values: `value`")


@pytest.mark.parametrize(
    ("type_name", "message", "help_line"),
    [
        ("laser", "no component type named `laser`", "did you mean `common.laser`?"),
        ("common.lasr", "no component type named `common.lasr`", "did you mean `common.laser`?"),
        ("comon.laser", "no component type named `comon.laser`", "did you mean `common.laser`?"),
        ("common.driver", "there is no instance of the abstract component type `common.driver`", None),
        ("common.filter", "`common.filter` does not say for which type `common.filter<T>` stands", None),
        ("common.more.x", "`is` cannot be `common.more.x`", None),
    ],
)
def test_a_type_that_a_library_does_not_have(robot: Path, type_name: str, message: str, help_line: str | None) -> None:
    text = PROJECT.replace("is: common.laser}", f"is: {type_name}}}")
    (robot / "archgen.yaml").write_text(text)
    error = next(d for d in check_project(robot).findings if d.span.line == 9 and d.severity == "error")
    assert (error.rule, error.message) in {
        (rule, message) for rule in ("unknown-reference", "abstract-type", "unbound-generic", "wrong-value")
    }
    assert help_line is None or error.help == help_line


@pytest.mark.parametrize(
    ("name", "help_line"),
    [
        ("lamp", "the component types of a library see only one another: write it below `component_types` there"),
        ("more.lamp", "the component types of a library see only one another: write it below `component_types` there"),
        ("lasr", "did you mean `laser`?"),
    ],
)
def test_a_library_does_not_see_what_is_outside_of_it(robot: Path, name: str, help_line: str) -> None:
    (robot / "b.yaml").write_text("component_types: {lamp: {outputs: {light: std_msgs/msg/Bool}}}\n")
    (robot / "more" / "b.yaml").write_text("component_types: {lamp: {outputs: {light: std_msgs/msg/Bool}}}\n")
    (robot / "lib" / "a.yaml").write_text(LIBRARY.replace("eye: {same_as: laser}", f"eye: {{same_as: {name}}}"))
    errors = {f"{d.span} {d.message} | {d.help}" for d in check_project(robot).findings if d.severity == "error"}
    assert f"lib/a.yaml:10:22 no component type named `{name}` in the library `common` | {help_line}" in errors


def test_a_selector_finds_what_comes_from_a_library(robot: Path) -> None:
    names = select_elements(check_project(robot), "library:common")[0].components
    assert sorted(names) == [
        "sensing.front",
        "sensing.head",  # for its input, which nothing inside reads
        "sensing.head.eye",
        "sensing.head.inner",
        "sensing.smooth",
    ]


def test_the_messages_of_a_library_are_the_same_for_all_of_its_projects(robot: Path) -> None:
    generic = "  Envelope: {generic: [T], fields: {payload: T}}\n"
    (robot / "lib" / "a.yaml").write_text(LIBRARY + generic)
    own = "types: {Own: {fields: {x: bool}}}\ngroups: {g: {title: G, components: {a: {outputs: {a: Envelope<Own>, b: Envelope<Spot>}}}}}\n"
    (robot / "b.yaml").write_text(own)
    types = check_project(robot).architecture.types
    assert {name: types[name].message for name in ("Own", "Spot", "Envelope<Own>", "Envelope<Spot>")} == {
        "Own": "robot_msgs/msg/Own",
        "Spot": "lib_msgs/msg/Spot",
        # The library does not know what the project puts into it.
        "Envelope<Own>": "robot_msgs/msg/EnvelopeOwn",
        "Envelope<Spot>": "lib_msgs/msg/EnvelopeSpot",
    }
    (robot / "b.yaml").write_text("types: {Envelope<Pose>: geometry_msgs/msg/PoseWithCovarianceStamped}\n")
    assert check_project(robot).architecture.types["Envelope"].library == "common"
    (robot / "archgen.yaml").write_text(PROJECT.replace("common: lib,", "common: {path: lib, package: shared_msgs},"))
    assert check_project(robot).architecture.types["Spot"].message == "shared_msgs/msg/Spot"
