"""What ships about interfaces, and what the project's own definitions change in it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
import yaml
from rosbags.typesys import Stores, get_typestore

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.stage_rules import READING_RULES
from archgen.findings.rule_pages import read_rule_page
from archgen.link.interface_sources import interface_name_of, load_interfaces
from archgen.model.known_interfaces import KNOWN_DISTROS, Interface, InterfaceField, InterfaceStatus
from tests.outside_tools import run_judge
from tests.property_sizes import try_some

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "archgen" / "link" / "ros_interfaces"


PATHS = "(a definition's path ends in its package, its kind and its name: `ramcip_msgs/msg/Grasp.msg`)"
NAMES = "(packages are written `like_this`, interfaces `LikeThis`, without underscores)"


def brief(diagnostic: Diagnostic) -> str:
    help_ = f" ({diagnostic.help})" if diagnostic.help else ""
    return f"{diagnostic.span} {diagnostic.message}{help_}"


def test_the_script_makes_the_data(tmp_path: Path) -> None:
    script = str(ROOT / "tools" / "make_ros_interfaces.py")
    run_judge(sys.executable, script, "-o", tmp_path)
    made = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert made == {file.name: file.read_bytes() for file in DATA.iterdir()}


@pytest.mark.parametrize(
    ("distro", "message", "answer"),
    [
        ("noetic", "sensor_msgs/msg/Image", "known"),
        ("noetic", "sensor_msgs/msg/Imgae", "wrong"),
        ("noetic", "control_msgs/action/FollowJointTrajectory", "known"),
        ("noetic", "control_msgs/msg/FollowJointTrajectoryActionGoal", "known"),
        ("noetic", "move_base_msgs/msg/MoveBaseFeedback", "known"),
        ("noetic", "nav2_msgs/action/NavigateToPose", "not held"),
        ("noetic", "dynamic_reconfigure/srv/Reconfigure", "not held"),
        ("humble", "nav2_msgs/action/DockRobot", "wrong"),
        ("jazzy", "nav2_msgs/action/DockRobot", "known"),
        ("jazzy", "sensor_msgs/msg/Image", "known"),
        ("jazzy", "sensor_msgs/msg/Imgae", "wrong"),
        ("jazzy", "std_srvs/srv/Trigger", "known"),
        ("jazzy", "builtin_interfaces/msg/Time", "known"),
        ("noetic", "builtin_interfaces/msg/Time", "not held"),
        ("kilted", "vision_msgs/msg/Detection3DArray", "known"),
        ("kilted", "vision_msgs/msg/Detections", "wrong"),
        ("lyrical", "sensor_msgs/msg/Image", "known"),
        ("lyrical", "nav2_msgs/action/NavigateToPose", "known"),
        ("lyrical", "controller_manager_msgs/srv/ListControllers", "not held"),
        ("lyrical", "vision_msgs/msg/Detections", "wrong"),
        ("lyrical", "sensor_msgs/msg/LazerScan", "wrong"),
        ("lyrical", "std_srvs/srv/Trigger", "known"),
        ("rolling", "hri_msgs/msg/Expression", "known"),
        ("rolling", "hri_msgs/msg/Expresion", "not held"),
        ("foxy", "sensor_msgs/msg/Image", "not held"),
        (None, "move_base_msgs/action/MoveBase", "known"),
        (None, "nav2_msgs/action/DockRobot", "known"),
        (None, "vision_msgs/msg/Detections", "not held"),
    ],
)
def test_answers(distro: str | None, message: str, answer: InterfaceStatus) -> None:
    interfaces, diagnostics = load_interfaces(distro)
    assert (interfaces.status_of(message), diagnostics) == (answer, ())
    assert interfaces.has_names is (distro != "foxy")


@pytest.mark.parametrize(
    ("message", "slip"),
    [
        ("std_msgs/msg/Boool", "std_msgs/msg/Bool"),
        ("geometry_msgs/msg/TwistStampd", "geometry_msgs/msg/TwistStamped"),
        ("sensor_msgs/msg/IMU", "sensor_msgs/msg/Imu"),
        ("nav_msgs/msg/odometry", "nav_msgs/msg/Odometry"),
        ("nav_msgs/msg/Odometrie", "nav_msgs/msg/Odometry"),
        ("nav_msgs/msg/GetPlan", "nav_msgs/srv/GetPlan"),
        ("nav_msgs/srv/Path", "nav_msgs/msg/Path"),
        ("nav2_msgs/msg/NavigateToPoseAction", "nav2_msgs/action/NavigateToPose"),
        ("nav_msg/msg/Odometry", "nav_msgs/msg/Odometry"),
        ("sdt_msgs/msg/String", "std_msgs/msg/String"),
        ("sensors_msgs/msg/Image", "sensor_msgs/msg/Image"),
        ("geometrymsgs/msg/Pose", "geometry_msgs/msg/Pose"),
        # Far from every name, or of packages that may well exist: nobody can tell.
        ("sensor_msgs/msg/Radar", None),
        ("nav_msgs/msg/GlobalCostmap", None),
        ("car_msgs/msg/Frame", None),
        ("uav_msgs/msg/Path", None),
        ("tensor_msgs/msg/Image", None),
        ("nav_msg/msg/Nothing", None),
        ("mavros_msgs/msg/Altitud", None),
        # Right in another distribution.
        ("std_msgs/msg/Time", None),
    ],
)
def test_slips_in_jazzy(message: str, slip: str | None) -> None:
    interfaces, _ = load_interfaces("jazzy")
    assert interfaces.find_slip(message) == slip
    assert (interfaces.status_of(message) == "wrong") is (slip is not None)


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_what_another_distribution_has_is_wrong_only_where_a_package_is_whole(distro: str) -> None:
    interfaces, _ = load_interfaces(distro)
    for name in interfaces.holding_distros:
        if name.partition("/")[0] not in interfaces.complete_packages:
            assert interfaces.status_of(name) != "wrong"


def test_a_name_that_another_distribution_has_says_in_which() -> None:
    interfaces, _ = load_interfaces("humble")
    assert interfaces.holding_distros["nav_msgs/msg/Trajectory"] == ("jazzy", "kilted", "lyrical", "rolling")


@pytest.mark.parametrize("distro", try_some(["noetic", "humble", "jazzy", "kilted", "lyrical"], 2))
def test_every_listed_name_is_known_and_only_lists_of_the_released_version_are_whole(distro: str) -> None:
    interfaces, _ = load_interfaces(distro)
    listed = yaml.safe_load((ROOT / "tools" / "ros_interfaces.yaml").read_text(encoding="utf-8"))
    whole = set[str]()
    for package, distros in listed.items():
        entry = distros.get(distro, {})
        for kind in ("msg", "srv", "action"):
            for name in entry.get(kind, ()):
                assert interfaces.status_of(f"{package}/{kind}/{name}") == "known"
        if entry and "seen" not in entry:
            whole.add(package)
    assert interfaces.complete_packages == whole


@pytest.mark.parametrize(
    ("distro", "store"), [("noetic", Stores.ROS1_NOETIC), ("jazzy", Stores.ROS2_JAZZY), ("humble", Stores.ROS2_HUMBLE)]
)
def test_every_core_message_has_its_fields(distro: str, store: Stores) -> None:
    interfaces, _ = load_interfaces(distro)
    for name, (_, fields) in get_typestore(store).fielddefs.items():
        if distro == "noetic" and name.startswith("builtin_interfaces/"):
            continue
        expected = [field for field, _ in fields if field != "structure_needs_at_least_one_member"]
        assert [field.name for field in interfaces.definitions[name].parts[0]] == expected


def test_fields_are_written_as_definitions_write_them() -> None:
    jazzy, noetic = load_interfaces("jazzy")[0].definitions, load_interfaces("noetic")[0].definitions
    assert jazzy["geometry_msgs/msg/PoseWithCovariance"].parts == (
        (InterfaceField("pose", "geometry_msgs/msg/Pose"), InterfaceField("covariance", "float64", "[36]")),
    )
    assert jazzy["shape_msgs/msg/SolidPrimitive"].parts[0][1] == InterfaceField("dimensions", "float64", "[<=3]")
    assert jazzy["std_msgs/msg/Empty"].parts == ((),)
    assert noetic["std_msgs/msg/Header"].parts == (
        (InterfaceField("seq", "uint32"), InterfaceField("stamp", "time"), InterfaceField("frame_id", "string")),
    )
    assert "std_msgs/msg/Nothing" not in jazzy
    assert len(jazzy) == len(list(jazzy)) > 150


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("msgs/demo_msgs/msg/Grasp.msg", "demo_msgs/msg/Grasp"),
        ("demo_msgs/action/Plan.action", "demo_msgs/action/Plan"),
        ("src/demo/demo_msgs/srv/Do.srv", "demo_msgs/srv/Do"),
        ("demo_msgs/msg/Grasp.srv", None),
        ("demo_msgs/Grasp.msg", None),
        ("msg/Grasp.msg", None),
        ("demo_msgs/msg/Grasp.msg.txt", None),
    ],
)
def test_paths_say_which_interface(file: str, name: str | None) -> None:
    assert interface_name_of(file) == name


def test_own_definitions_make_a_package_whole() -> None:
    interfaces, diagnostics = load_interfaces(
        "jazzy",
        [
            ("msgs/demo_msgs/msg/Grasp.msg", "geometry_msgs/Pose pose\nfloat64 width"),
            ("msgs/demo_msgs/action/Plan.action", "Grasp wish\n---\nGrasp[] grasps\n---\nfloat32 progress"),
        ],
        {"other_msgs/msg/Sound": ("uint8[] data", Span("packed.yaml", 9, 3, 9, 15))},
    )
    assert diagnostics == ()
    assert interfaces.project_packages == {"demo_msgs", "other_msgs"}
    assert [
        interfaces.status_of(name)
        for name in ("demo_msgs/msg/Grasp", "demo_msgs/msg/Grip", "other_msgs/msg/Sound", "nav2_msgs/msg/Costmap")
    ] == ["known", "wrong", "known", "known"]
    assert interfaces.definitions["demo_msgs/msg/Grasp"] == Interface(
        "demo_msgs/msg/Grasp", ((InterfaceField("pose", "geometry_msgs/msg/Pose"), InterfaceField("width", "float64")),)
    )
    assert interfaces.definitions["sensor_msgs/msg/Image"].parts[0][1] == InterfaceField("height", "uint32")
    assert next(iter(interfaces.definitions)) == "demo_msgs/msg/Grasp"


def test_own_definitions_add_to_a_package_that_is_held_in_part() -> None:
    interfaces, _ = load_interfaces("jazzy", [("sensor_msgs/msg/Smell.msg", "float32 strength")])
    answers = [interfaces.status_of(f"sensor_msgs/msg/{name}") for name in ("Smell", "Image", "Taste")]
    assert answers == ["known", "known", "not held"]


def test_the_rule_page_tells_the_truth() -> None:
    rule = READING_RULES[0]
    page = read_rule_page(rule)
    for text, count in ((page.bad, 1), (page.good, 0)):
        example = yaml.safe_load(text)
        place = Span("archgen.yaml", 1, 1, 1, 2)
        inline = {name: (text, place) for name, text in example["ros"]["definitions"].items()}
        assert len(load_interfaces(example["ros"]["distro"], (), inline)[1]) == count


def test_own_definitions_win() -> None:
    interfaces, _ = load_interfaces("noetic", [("std_msgs/msg/String.msg", "string text")])
    assert interfaces.definitions["std_msgs/msg/String"].parts == ((InterfaceField("text", "string"),),)
    assert interfaces.status_of("std_msgs/msg/Bool") == "known"


def test_the_distribution_chooses_the_grammar() -> None:
    definitions = [("demo_msgs/msg/Old.msg", "Header header\ntime stamp")]
    assert load_interfaces("noetic", definitions)[1] == ()
    assert [brief(diagnostic) for diagnostic in load_interfaces("jazzy", definitions)[1]] == [
        "demo_msgs/msg/Old.msg:1:1 there is no message `demo_msgs/msg/Header` (did you mean `std_msgs/Header`?)"
    ]


def test_what_is_wrong_with_own_definitions() -> None:
    _, diagnostics = load_interfaces(
        "jazzy",
        [
            ("msgs/Grasp.msg", "float64 x"),
            ("demo_msgs/msg/Grasp.msg", "float64 x\nGrisp other\nnav2_msgs/Costmop map\nsensor_msgs/New thing"),
            ("demo_msgs/msg/bad_name.msg", ""),
            ("again/demo_msgs/msg/Grasp.msg", "float64 x"),
        ],
        {
            "demo_msgs/Plan": ("", Span("a.yaml", 1, 1, 1, 2)),
            "demo_msgs/msg/Plan": ("float64 x\nfloat y", Span("a.yaml", 3, 1, 5, 2)),
        },
    )
    assert [brief(diagnostic) for diagnostic in diagnostics] == [
        f"msgs/Grasp.msg:1:1 `msgs/Grasp.msg` does not say which interface it defines {PATHS}",
        f"demo_msgs/msg/bad_name.msg:1:1 `demo_msgs/msg/bad_name` is no name of an interface in ROS 2 {NAMES}",
        "again/demo_msgs/msg/Grasp.msg:1:1 `demo_msgs/msg/Grasp` is defined twice",
        "a.yaml:1:1 `demo_msgs/Plan` is no name of an interface (it is written `package/msg/Name` (or srv, action))",
        "a.yaml:3:1 line 2 of the definition: there is no type `float` in ROS (did you mean `float32`?)",
        "demo_msgs/msg/Grasp.msg:2:1 there is no message `demo_msgs/msg/Grisp` (did you mean `demo_msgs/Grasp`?)",
        "demo_msgs/msg/Grasp.msg:3:1 there is no message `nav2_msgs/msg/Costmop` (did you mean `nav2_msgs/Costmap`?)",
    ]
    assert diagnostics[2].labels[0].span == Span.of_file("demo_msgs/msg/Grasp.msg")


def test_a_message_that_holds_itself() -> None:
    _, diagnostics = load_interfaces(
        "jazzy",
        [
            ("demo_msgs/msg/Tree.msg", "float64 x\nBranch[] branches\nLeaf leaf"),
            ("demo_msgs/msg/Branch.msg", "Tree below\nBranch next"),
            ("demo_msgs/msg/Leaf.msg", "std_msgs/ColorRGBA colour"),
        ],
    )
    assert [f"{diagnostic.span} {diagnostic.message}" for diagnostic in diagnostics] == [
        "demo_msgs/msg/Tree.msg:2:1 `demo_msgs/msg/Tree` holds itself, through `demo_msgs/msg/Branch`",
        "demo_msgs/msg/Branch.msg:1:1 `demo_msgs/msg/Branch` holds itself, through `demo_msgs/msg/Tree`",
        "demo_msgs/msg/Branch.msg:2:1 `demo_msgs/msg/Branch` holds itself",
    ]


def test_a_slip_in_the_type_of_a_field_is_an_error_where_it_is_certain() -> None:
    text = "geometry_msgs/Piont a\ngeomtry_msgs/Point b\nfar_off_msgs/Strange c\nfar_off_msgs/Wrench d\ngeomtri_msgs/Point e"
    _, diagnostics = load_interfaces("humble", [("demo_msgs/msg/Thing.msg", text)])
    assert [f"{diagnostic.rule} {brief(diagnostic)}" for diagnostic in diagnostics] == [
        (
            "invalid-interface demo_msgs/msg/Thing.msg:1:1 there is no message `geometry_msgs/msg/Piont` (did you mean "
            "`geometry_msgs/Point`?)"
        ),
        (
            "invalid-interface demo_msgs/msg/Thing.msg:2:1 there is no message `geomtry_msgs/msg/Point` (did you mean "
            "`geometry_msgs/Point`?)"
        ),
        (
            "unchecked-message demo_msgs/msg/Thing.msg:5:1 archgen holds no message `geomtri_msgs/msg/Point` (did you mean "
            "`geometry_msgs/Point`?)"
        ),
    ]
    assert load_interfaces("foxy", [("demo_msgs/msg/Thing.msg", text)])[1] == ()


def test_a_definition_whose_name_is_none_defines_nothing() -> None:
    interfaces, found = load_interfaces("jazzy", [("msgs/own_msgs/msg/bad_name.msg", "int8 x\n")])
    assert [brief(d) for d in found] == [
        f"msgs/own_msgs/msg/bad_name.msg:1:1 `own_msgs/msg/bad_name` is no name of an interface in ROS 2 {NAMES}"
    ]
    assert interfaces.status_of("own_msgs/msg/bad_name") == "not held"
    assert interfaces.project_packages == frozenset()
    ros_1, found = load_interfaces("noetic", [("msgs/own_msgs/msg/bad_name.msg", "int8 x\n")])
    assert (ros_1.status_of("own_msgs/msg/bad_name"), found) == ("known", ())
