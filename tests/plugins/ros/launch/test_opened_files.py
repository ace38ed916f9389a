"""Files that launch files in Python open themselves, MoveIt's configurations and xacro: read without running anything."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from archgen.plugins.ros.launch import launch_parameter_values
from archgen.plugins.ros.launch.launch_import import read_launch
from tests.plugins.ros.launch.test_launch_import import PYTHON_HEAD, messages_of, nodes_of, read_python, write_files

MANIFEST = "<package><name>{}</name></package>"
NODE = 'Node(package="p", executable="e", name="n", parameters=[values])'
VALUES = "rate: 5\ndeep: {flag: yes, words: [a, b]}\n"


@pytest.mark.parametrize(
    "statements",
    [
        "values = yaml.safe_load(open(path))",
        "with open(path, 'r') as file:\n    values = yaml.safe_load(file)",
        "with open(path) as file:\n    values = yaml.load(file.read(), Loader=yaml.FullLoader)",
        "values = load(path)",
        "values = {}\nif os.path.exists(path):\n    values = load(path)",
        "values = load(os.path.dirname(path) + '/all.yaml')['/**']['ros__parameters']",
        "values = load(path)['other'] if False else load(Path(path))",
    ],
)
def test_yaml_that_is_opened_is_read(statements: str, tmp_path: Path) -> None:
    body = f"""
import yaml
from pathlib import Path
def load(path):
    try:
        with open(path) as file:
            return yaml.safe_load(file)
    except OSError:
        return None
path = os.path.join(get_package_share_directory("bot"), "config", "main.yaml")
{statements}
return LaunchDescription([{NODE}])
"""
    wrapped = "/**:\n  ros__parameters:\n" + textwrap.indent(VALUES, "    ")
    files = {"config___main__yaml": VALUES, "config___all__yaml": wrapped, "package__xml": MANIFEST.format("bot")}
    imported = read_python(tmp_path, body, **files)
    assert nodes_of(imported)["n"]["parameters"] == {"rate": 5, "deep": {"flag": True, "words": ["a", "b"]}}
    assert messages_of(imported) == []


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ("'$(find-pkg-share bot)/../secret.yaml'", "does not lie in the folders that were given"),
        ("'/etc/passwd'", "does not lie in the folders that were given"),
        ("get_package_share_directory('far') + '/a.yaml'", "does not lie in the folders that were given"),
        ("get_package_share_directory('bot') + '/list.yaml'", "is no mapping in YAML, or"),
    ],
)
def test_what_lies_elsewhere_or_is_none_is_not_read(place: str, message: str, tmp_path: Path) -> None:
    (tmp_path / "secret.yaml").write_text("word: secret\n")
    body = f"import yaml\nvalues = {{'a': yaml.safe_load(open({place})), 'b': 1}}\nreturn LaunchDescription([{NODE}])"
    imported = read_python(tmp_path / "inner", body, package__xml=MANIFEST.format("bot"), list__yaml="- 1\n")
    assert nodes_of(imported)["n"]["parameters"] == {"b": 1}
    first, second = messages_of(imported)
    assert first.startswith("not taken: open:15: `")
    assert message in first
    assert second.startswith("not taken: Node:15: the parameter `a` is computed: `")


@pytest.mark.parametrize(
    ("expression", "words"),
    [
        ("xacro.process_file(path, mappings={'side': 'left'}).toxml()", ["side:=left"]),
        ("document(path, {'side': LaunchConfiguration('side')})", ["side:=right"]),
        ("document(path, None)", []),
    ],
)
def test_what_xacro_makes_is_a_command(expression: str, words: list[str], tmp_path: Path) -> None:
    body = f"""
import xacro
def document(path, mappings):
    made = xacro.parse(open(path))
    xacro.process_doc(made, mappings=mappings)
    return made.toxml()
path = os.path.join(get_package_share_directory("bot"), "bot.xacro")
values = {{"robot_description": {expression}}}
return LaunchDescription([DeclareLaunchArgument("side", default_value="right"), {NODE}])
"""
    imported = read_python(tmp_path, body)
    command = ["xacro", "$(find-pkg-share bot)/bot.xacro", *words]
    assert nodes_of(imported)["n"]["parameter_commands"] == {"robot_description": command}


MOVEIT_FILES = {
    "package__xml": MANIFEST.format("arm_moveit_config"),
    "config___kinematics__yaml": "arm: {kinematics_solver: kdl}\n",
    "config___joint_limits__yaml": "joint_limits: {j1: {max_velocity: 1.5}}\n",
    "config___pilz_cartesian_limits__yaml": "cartesian_limits: {max_trans_vel: 1.0}\n",
    "config___moveit_controllers__yaml": "moveit_simple_controller_manager: {controller_names: [arm]}\n",
    "config___ompl_planning__yaml": "planner_configs: {RRT: {range: 0.0}}\n",
    "config___pilz_industrial_motion_planner_planning__yaml": "capabilities: x\n",
    "config___arm__urdf__xacro": "<robot/>",
    "config___arm__srdf": "<robot/>",
}


def test_what_moveit_puts_together_is_read(tmp_path: Path) -> None:
    body = """
    from moveit_configs_utils import MoveItConfigsBuilder
    config = (
        MoveItConfigsBuilder("arm")
        .robot_description(mappings={"side": LaunchConfiguration("side")})
        .planning_pipelines(pipelines=["ompl", "pilz_industrial_motion_planner"])
        .planning_scene_monitor(publish_robot_description=True)
        .to_moveit_configs()
    )
    return LaunchDescription([
        DeclareLaunchArgument("side", default_value="left"),
        Node(package="moveit_ros_move_group", executable="move_group", parameters=[config.to_dict(), {"own": 1}]),
        Node(package="rviz2", executable="rviz2", parameters=[config.robot_description_kinematics, config.joint_limits]),
    ])
    """
    imported = read_python(tmp_path, body, **MOVEIT_FILES)
    assert messages_of(imported) == []
    nodes = nodes_of(imported)
    assert nodes["move_group"]["parameter_commands"] == {
        "robot_description": ["xacro", "$(find-pkg-share arm_moveit_config)/config/arm.urdf.xacro", "side:=left"],
        "robot_description_semantic": ["xacro", "$(find-pkg-share arm_moveit_config)/config/arm.srdf"],
    }
    assert nodes["move_group"]["parameters"] == {
        "robot_description_kinematics": {"arm": {"kinematics_solver": "kdl"}},
        "planning_pipelines": ["ompl", "pilz_industrial_motion_planner"],
        "default_planning_pipeline": "ompl",
        "ompl": {"planner_configs": {"RRT": {"range": 0.0}}},
        "pilz_industrial_motion_planner": {"capabilities": "x"},
        "moveit_manage_controllers": True,
        "moveit_simple_controller_manager": {"controller_names": ["arm"]},
        "publish_planning_scene": True,
        "publish_geometry_updates": True,
        "publish_state_updates": True,
        "publish_transforms_updates": True,
        "publish_robot_description": True,
        "robot_description_planning": {
            "joint_limits": {"j1": {"max_velocity": 1.5}},
            "cartesian_limits": {"max_trans_vel": 1.0},
        },
        "own": 1,
    }
    assert list(nodes["rviz2"]["parameters"]) == ["robot_description_kinematics", "robot_description_planning"]


def test_what_moveit_itself_would_add_is_not_invented(tmp_path: Path) -> None:
    files = {name: text for name, text in MOVEIT_FILES.items() if "controllers" not in name and "srdf" not in name}
    files["config___ompl_planning__yaml"] = "request_adapters: x\n"
    body = """
    from moveit_configs_utils import MoveItConfigsBuilder
    config = MoveItConfigsBuilder("arm").to_moveit_configs()
    return LaunchDescription([Node(package="p", executable="e", name="n", parameters=[config.to_dict()])])
    """
    imported = read_python(tmp_path, body, **files)
    parameters = nodes_of(imported)["n"]["parameters"]
    assert "planning_pipelines" not in parameters
    assert parameters["ompl"] == {"request_adapters": "x"}
    computed = [note.message for note in imported.notes]
    assert computed == [
        "the parameter `robot_description_semantic` is computed: `its SRDF`",
        "the parameter `planning_pipelines` is computed: `the pipelines that MoveIt's own files add`",
        "the parameter `ompl.planner_configs` is computed: `ompl_defaults.yaml of moveit_configs_utils`",
        "the parameter `moveit_simple_controller_manager` is computed: `its file is not known`",
    ]


def test_elements_inside_of_nodes_of_ros_1_have_conditions(tmp_path: Path) -> None:
    text = """<launch>
      <arg name="on" default="true"/>
      <arg name="open"/>
      <include file="$(dirname)/inner.launch"><arg name="a" value="1" if="$(arg on)"/><arg name="b" value="2" unless="$(arg on)"/></include>
      <node pkg="p" type="e" name="n">
        <param name="a" value="1" if="$(arg on)"/>
        <param name="b" value="2" unless="$(arg on)"/>
        <rosparam param="c" if="$(arg open)">3</rosparam>
        <remap from="a" to="b" unless="$(arg on)"/>
        <env name="A" value="b" if="false"/>
      </node>
    </launch>"""
    inner = """<launch><arg name="a" default="0"/><arg name="b" default="0"/>
      <node pkg="p" type="e" name="m"><param name="a" value="$(arg a)"/><param name="b" value="$(arg b)"/></node></launch>"""
    imported = read_launch([write_files(tmp_path, a__launch=text, inner__launch=inner)])
    assert nodes_of(imported) == {
        "m": {"package": "p", "executable": "e", "parameters": {"a": 1, "b": 0}},
        "n": {"package": "p", "executable": "e", "parameters": {"a": 1}},
    }
    assert messages_of(imported)[1:] == ["not taken: node:5: what counts only if $(var open) is left out"]


@pytest.mark.parametrize(
    ("source", "given", "expected", "computed"),
    [
        ("path", {}, {"topic": "<ns>/scan", "deep": {"rate": 5.0, "on": False}, "words": ["<ns>", "b"]}, []),
        (
            "RewrittenYaml(source_file=path, param_rewrites={'rate': LaunchConfiguration('rate'), 'on': 'true'}, convert_types=True)",
            {"rate": "7.5"},
            {"topic": "<ns>/scan", "deep": {"rate": 7.5, "on": True}, "words": ["<ns>", "b"]},
            [],
        ),
        (
            "RewrittenYaml(path, {'rate': ask()})",
            {},
            {"topic": "<ns>/scan", "deep": {"on": False}, "words": ["<ns>", "b"]},
            ["deep.rate"],
        ),
        (
            "RewrittenYaml(ReplaceString(path, {'<ns>': ('/', LaunchConfiguration('ns'))}), {'rate': '6'})",
            {},
            {"topic": "/r1/scan", "deep": {"rate": 6, "on": False}, "words": ["/r1", "b"]},
            [],
        ),
        (
            "ReplaceString(source_file=path, replacements={'<ns>': 'x'}, condition=IfCondition(LaunchConfiguration('sure')))",
            {"sure": "false"},
            {"topic": "<ns>/scan", "deep": {"rate": 5.0, "on": False}, "words": ["<ns>", "b"]},
            [],
        ),
        (
            "ReplaceString(source_file=path, replacements={'<ns>': 'x'}, condition=IfCondition(LaunchConfiguration('sure')))",
            {},
            {"deep": {"rate": 5.0, "on": False}},
            ["topic", "words"],
        ),
    ],
)
def test_what_is_written_over_files_counts(
    source: str, given: dict[str, str], expected: dict[str, object], computed: list[str], tmp_path: Path
) -> None:
    body = f"""
from nav2_common.launch import ReplaceString, RewrittenYaml
path = os.path.join(get_package_share_directory("bot"), "config", "main.yaml")
return LaunchDescription([
    DeclareLaunchArgument("ns", default_value="r1"), DeclareLaunchArgument("sure"), DeclareLaunchArgument("rate", default_value="1.5"),
    Node(package="p", executable="e", name="n", parameters=[{source}]),
])
"""
    values = "n:\n  ros__parameters: {topic: <ns>/scan, deep: {rate: 5.0, on: false}, words: [<ns>, b]}\n"
    lines = textwrap.indent(body, "    ")
    text = f"{PYTHON_HEAD}\ndef generate_launch_description():\n{lines}\n"
    files = {"package__xml": MANIFEST.format("bot"), "config___main__yaml": values}
    imported = read_launch([write_files(tmp_path, launch___robot__launch__py=text, **files)], given)
    assert nodes_of(imported)["n"]["parameters"] == expected
    names = [note.message.split("`")[1] for note in imported.notes if note.message.startswith("the parameter ")]
    assert names == computed


def test_what_is_written_over_a_file_goes_through_an_include(tmp_path: Path) -> None:
    """R7: as Nav2 does it: a file with rewrites is handed on as an argument, and more is written over it there."""
    outer = """
from nav2_common.launch import RewrittenYaml
path = os.path.join(get_package_share_directory("bot"), "config", "main.yaml")
written = RewrittenYaml(source_file=path, root_key="", param_rewrites={"rate": LaunchConfiguration("rate")}, convert_types=True)
return LaunchDescription([
    DeclareLaunchArgument("rate", default_value="7.5"),
    IncludeLaunchDescription(PythonLaunchDescriptionSource(os.path.join(get_package_share_directory("bot"), "launch", "inner.launch.py")),
                             launch_arguments={"params_file": written, "rate": "1.0"}.items()),
])
"""
    inner = """
from nav2_common.launch import RewrittenYaml
written = RewrittenYaml(source_file=LaunchConfiguration("params_file"), param_rewrites={"on": "true"}, convert_types=True)
return LaunchDescription([
    DeclareLaunchArgument("params_file", default_value="none"),
    Node(package="p", executable="e", name="n", parameters=[written]),
    Node(package="p", executable="e", name="m", parameters=[LaunchConfiguration("params_file")]),
])
"""
    outer_text, inner_text = (
        f"{PYTHON_HEAD}\ndef generate_launch_description():\n{textwrap.indent(each, '    ')}\n"
        for each in (outer, inner)
    )
    files = {
        "package__xml": MANIFEST.format("bot"),
        "config___main__yaml": "/**:\n  ros__parameters: {deep: {rate: 5.0, on: false}}\n",
        "launch___inner__launch__py": inner_text,
    }
    nodes = nodes_of(read_launch([write_files(tmp_path, launch___robot__launch__py=outer_text, **files)], {}))
    assert {name: (each["parameters"], each["parameter_files"]) for name, each in nodes.items()} == {
        "n": ({"deep": {"rate": 7.5, "on": True}}, ["$(find-pkg-share bot)/config/main.yaml"]),
        "m": ({"deep": {"rate": 7.5, "on": False}}, ["$(find-pkg-share bot)/config/main.yaml"]),
    }


def test_a_file_that_is_for_other_nodes_is_told(tmp_path: Path) -> None:
    """R8: a name that is misspelt in a parameter file costs days, and ROS says nothing of it."""
    xml = """<launch><node pkg="p" exec="e" name="lidar_driver"><param from="$(find-pkg-share bot)/config/main.yaml"/></node>
    <node pkg="p" exec="e" name="good"><param from="$(find-pkg-share bot)/config/good.yaml"/></node>
    <node pkg="p" exec="nameless"><param from="$(find-pkg-share bot)/config/main.yaml"/></node></launch>"""
    files = {
        "package__xml": MANIFEST.format("bot"),
        "config___main__yaml": "lidar_drivr:\n  ros__parameters: {rate: 1}\n/a/b:\n  ros__parameters: {rate: 1}\n",
        "config___good__yaml": "/**/good:\n  ros__parameters: {rate: 1}\n",
    }
    imported = read_launch([write_files(tmp_path, launch___robot__launch__xml=xml, **files)], {})
    assert [note.message.replace(f"{tmp_path.name}/", "") for note in imported.notes] == [
        "`config/main.yaml` says nothing to `/lidar_driver`, but to `/lidar_drivr`, `/a/b`",
        "`config/main.yaml` says nothing to nameless, whose own name the launch file does not say, but to `/lidar_drivr`, `/a/b`",
    ]


def test_files_that_are_opened_in_a_loop_take_bounded_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launch_parameter_values, "MAX_OPENED_BYTES", 10 * len(VALUES))
    body = f"""
    import yaml
    path = os.path.join(get_package_share_directory("bot"), "config", "main.yaml")
    read = []
    for number in range(100):
        values = yaml.safe_load(open(path))
        read.append(values)
    return LaunchDescription([{NODE}])
    """
    imported = read_python(tmp_path, body, package__xml=MANIFEST.format("bot"), config___main__yaml=VALUES)
    assert [message[:30] for message in messages_of(imported)][:1] == ["not taken: open:19: `$(find-pk"]
    assert "parameters" not in nodes_of(imported)["n"]
