"""Launch files in XML, YAML and Python become nodes that exist; what only running them would tell is noted with its line."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import pytest

from archgen.importers.foreign_import import ForeignFileError, ForeignImport
from archgen.plugins.ros.launch.launch_import import read_launch
from tests.property_sizes import try_some

PYTHON_HEAD = """\
import os
import launch
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import IfCondition, UnlessCondition
from launch.event_handlers import OnProcessExit
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import ComposableNode, ParameterValue
from launch_ros.substitutions import FindPackageShare
"""


def write_files(folder: Path, **texts: str) -> Path:
    """Write files, `__` in a name for a dot and `___` for a folder; return the first one."""
    paths = []
    for name, text in texts.items():
        path = folder / name.replace("___", "/").replace("__", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(textwrap.dedent(text), encoding="utf-8")
        paths.append(path)
    return paths[0]


def read_python(folder: Path, body: str, **texts: str) -> ForeignImport:
    """Read a launch file in Python whose function has this body."""
    lines = textwrap.indent(textwrap.dedent(body), "    ")
    text = f"{PYTHON_HEAD}\ndef generate_launch_description():\n{lines}\n"
    return read_launch([write_files(folder, launch___robot__launch__py=text, **texts)])


def nodes_of(imported: ForeignImport) -> dict[str, Any]:
    """Return the nodes of all slices, without what the import remembers of the file."""
    nodes: dict[str, Any] = {}
    for sections in imported.slices.values():
        for node_id, node in sections.get("nodes", {}).items():
            nodes[node_id] = {key: value for key, value in node.items() if key not in {"hints", "status"}}
    return nodes


def messages_of(imported: ForeignImport) -> list[str]:
    """Return the notes with their lines."""
    return [f"{note.fate}: {note.kind}:{note.span.line}: {note.message}" for note in imported.notes]


XML = """\
<launch>
  <arg name="ns" default="robot1" description="Its namespace"/>
  <arg name="rviz" default="false"/>
  <group>
    <push-ros-namespace namespace="$(var ns)"/>
    <set_remap from="/tf" to="tf"/>
    <node pkg="nav" exec="planner" name="planner" args="--fast 'two words'" respawn="true" respawn_delay="2.0">
      <param name="rate" value="10.5"/>
      <param name="tree"><param name="deep" value="text"/></param>
      <param name="word" value="12" type="str"/>
      <remap from="map" to="/map"/>
      <env name="LEVEL" value="3"/>
    </node>
    <lifecycle_node pkg="nav" exec="server" name="server" namespace="inner"/>
    <node_container pkg="rclcpp_components" exec="component_container_mt" name="box" namespace="">
      <composable_node pkg="image" plugin="image::Filter" name="filter"/>
    </node_container>
  </group>
  <load_composable_node target="/robot1/box">
    <composable_node pkg="image" plugin="image::Edge" name="edge"/>
  </load_composable_node>
  <node pkg="rviz2" exec="rviz2" name="rviz" if="$(var rviz)"/>
  <executable cmd="stage 'my world'"/>
</launch>
"""
YAML = """\
launch:
- arg: {name: ns, default: robot1, description: Its namespace}
- arg: {name: rviz, default: "false"}
- group:
  - push_ros_namespace: {namespace: $(var ns)}
  - set_remap: {from: /tf, to: tf}
  - node:
      pkg: nav
      exec: planner
      name: planner
      args: --fast 'two words'
      respawn: true
      respawn_delay: 2.0
      param:
      - {name: rate, value: 10.5}
      - name: tree
        param: [{name: deep, value: text}]
      - {name: word, value: "12", type: str}
      remap: [{from: map, to: /map}]
      env: [{name: LEVEL, value: "3"}]
  - lifecycle_node: {pkg: nav, exec: server, name: server, namespace: inner}
  - node_container:
      pkg: rclcpp_components
      exec: component_container_mt
      name: box
      namespace: ""
      composable_node: [{pkg: image, plugin: "image::Filter", name: filter}]
- load_composable_node:
    target: /robot1/box
    composable_node: [{pkg: image, plugin: "image::Edge", name: edge}]
- node: {pkg: rviz2, exec: rviz2, name: rviz, if: $(var rviz)}
- executable: {cmd: stage 'my world'}
"""
PYTHON = """\
ns = LaunchConfiguration("ns")
ld = LaunchDescription()
ld.add_action(DeclareLaunchArgument("ns", default_value="robot1", description="Its namespace"))
ld.add_action(DeclareLaunchArgument("rviz", default_value="false"))
inner = [
    PushRosNamespace(ns),
    SetRemap("/tf", "tf"),
    Node(
        package="nav", executable="planner", name="planner", arguments=["--fast", "two words"], respawn=True, respawn_delay=2.0,
        parameters=[{"rate": 10.5, "tree": {"deep": "text"}, "word": "12"}],
        remappings=[("map", "/map")], additional_env={"LEVEL": "3"},
    ),
    LifecycleNode(package="nav", executable="server", name="server", namespace="inner"),
]
container = ComposableNodeContainer(
    package="rclcpp_components", executable="component_container_mt", name="box", namespace="",
    composable_node_descriptions=[ComposableNode(package="image", plugin="image::Filter", name="filter")],
)
ld.add_action(GroupAction(inner + [container]))
ld.add_action(LoadComposableNodes(
    target_container="/robot1/box",
    composable_node_descriptions=[ComposableNode(package="image", plugin="image::Edge", name="edge")],
))
ld.add_action(Node(package="rviz2", executable="rviz2", name="rviz", condition=IfCondition(LaunchConfiguration("rviz"))))
ld.add_action(ExecuteProcess(cmd=["stage", "my world"]))
return ld
"""
EXPECTED = {
    "planner": {
        "namespace": "/robot1",
        "package": "nav",
        "executable": "planner",
        "arguments": ["--fast", "two words"],
        "remaps": {"/tf": "tf", "map": "/map"},
        "parameters": {"rate": 10.5, "tree": {"deep": "text"}, "word": "12"},
        "start": {"respawn": True, "respawn_delay": "2 s", "environment": {"LEVEL": "3"}},
    },
    "server": {
        "kind": "lifecycle",
        "namespace": "/robot1/inner",
        "package": "nav",
        "executable": "server",
        "remaps": {"/tf": "tf"},
    },
    "filter": {
        "kind": "composable",
        "namespace": "/robot1",
        "package": "image",
        "plugin": "image::Filter",
        "container": "box",
        "remaps": {"/tf": "tf"},
    },
    "edge": {"kind": "composable", "package": "image", "plugin": "image::Edge", "container": "box"},
    "rviz": {"package": "rviz2", "executable": "rviz2"},
    "stage": {"kind": "program", "command": ["stage", "my world"]},
}


@pytest.mark.parametrize("form", ["xml", "yaml", "py"])
def test_three_forms_say_the_same(form: str, tmp_path: Path) -> None:
    if form == "py":
        imported = read_python(tmp_path, PYTHON)
    else:
        path = tmp_path / f"robot.launch.{form}"
        path.write_text(XML if form == "xml" else YAML)
        imported = read_launch([path])
    assert nodes_of(imported) == EXPECTED
    assert messages_of(imported) == []
    (sections,) = imported.slices.values()
    assert list(imported.slices) == ["robot_launch.yaml"]
    assert sections["containers"]["box"]["namespace"] == "/robot1"
    assert sections["containers"]["box"]["executable"] == "component_container_mt"
    rviz, planner = sections["nodes"]["rviz"], sections["nodes"]["planner"]
    assert rviz["status"] == "existing"
    assert rviz["hints"]["launch"]["conditions"] == ["if $(var rviz)"]
    assert rviz["hints"]["launch"]["by_default"] == "off"
    assert imported.comments["robot_launch.yaml"]["nodes", "rviz"] == "off by default: only if $(var rviz)"
    assert planner["hints"]["launch"]["file"].endswith(f"robot.launch.{form}")


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("'a' + 'b'", "ab"),
        ("['a', os.sep, 'b'][1].replace(os.sep, 'n') + os.pathsep.replace(':', 'x')", "nx"),
        ("f'a{1 + 1}b'", "a2b"),
        ("'a{}b'.format(3)", "a3b"),
        ("'a%sb' % 4", "a4b"),
        ("'_'.join(['a', 'b'])", "a_b"),
        ("['a', LaunchConfiguration('x')]", "a5"),
        ("['n', LaunchConfiguration('x'), '_', LaunchConfiguration('y', default='z')]", "n5_z"),
        ("'yes' if 1 < 2 else 'no'", "yes"),
        ("{'k': 'v'}['k']", "v"),
        ("'abc'[1:]", "bc"),
        ("os.path.join('a', 'b', 'c.x').replace('/', '_').replace('.', '_')", "a_b_c_x"),
        ("os.environ.get('ROBOT', 'r2')", "r2"),
        ("os.getenv('ROBOT', default='r2')", "r2"),
        ("os.getenv(key='ROBOT', default='r2')", "r2"),
        ("PythonExpression([\"'big' if \", LaunchConfiguration('x'), \" > 3 else 'small'\"])", "big"),
        ("[n for n in ['a', 'b', 'c'] if n != 'a'][0]", "b"),
        ("(lambda name: name + '_node')('x')", "x_node"),
        ("str(Path('a') / 'b').replace('/', '_')", "a_b"),
        ("['n', PythonExpression([\"1 + int('\", LaunchConfiguration('x'), \"') + int(2.7)\"])]", "n8"),
        ("['n', PythonExpression([\"int(' 12345678901234567 ')\"])]", "n12345678901234567"),
        ("['n_', EqualsSubstitution(LaunchConfiguration('x'), '5')]", "n_true"),
        ("PythonExpression([\"'A\", LaunchConfiguration('x'), \"'.lower()\"])", "a5"),
        ("PythonExpression([f\"{ {'5': 'five'} }['\", LaunchConfiguration('x'), \"']\"])", "five"),
        ("PythonExpression([\"'in' if '\", LaunchConfiguration('x'), \"' in ['4', '5'] else 'out'\"])", "in"),
        ("PythonExpression(\"'a' if '' else 'b' if '$(find-pkg-share p)' == 3 or True else 'c'\")", "b"),
        ("str(Path('a', 'b/c', 'd')).replace('/', '_')", "a_b_c_d"),
        ("Path('a', 'b').__str__().replace('/', '_')", "a_b"),
    ],
)
def test_texts_are_put_together_as_python_does(expression: str, expected: str, tmp_path: Path) -> None:
    body = f"""
    from pathlib import Path
    name = {expression}
    return LaunchDescription([
        DeclareLaunchArgument("x", default_value="5"),
        OpaqueFunction(function=lambda context: [Node(package="p", executable="e", name=name)]),
    ])
    """
    imported = read_python(tmp_path, textwrap.dedent(body))
    assert messages_of(imported) == []
    assert nodes_of(imported)[expected]["package"] == "p"


def test_a_container_that_is_started_as_a_node_is_one(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([
        Node(package="rclcpp_components", executable="component_container_isolated", name="box"),
        LoadComposableNodes(target_container="box", composable_node_descriptions=[ComposableNode(package="p", plugin="p::E", name="n")]),
    ])
    """
    imported = read_python(tmp_path, body)
    assert imported.slices["robot_launch.yaml"]["containers"]["box"]["executable"] == "component_container_isolated"
    assert nodes_of(imported)["n"]["container"] == "box"


def test_values_keep_their_types(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([
        DeclareLaunchArgument("sim", default_value="true"),
        Node(package="p", executable="e", name="n", parameters=[{
            "text": "true", "flag": LaunchConfiguration("sim"), "words": ["a", "b"], "numbers": [1, 2.5],
            "forced": ParameterValue(LaunchConfiguration("sim"), value_type=str),
            "robot_description": Command(["xacro ", PathJoinSubstitution([FindPackageShare("d"), "a.xacro"]), " x:=1"]),
        }]),
    ])
    """
    (node,) = nodes_of(read_python(tmp_path, body)).values()
    assert node["parameters"] == {
        "text": "true",
        "flag": True,
        "words": ["a", "b"],
        "numbers": [1, 2.5],
        "forced": "true",
    }
    assert node["parameter_commands"] == {"robot_description": ["xacro", "$(find-pkg-share d)/a.xacro", "x:=1"]}


def test_arguments_are_kept_beside_what_is_filled_in(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([
        DeclareLaunchArgument("sim", default_value="true"),
        Node(package="p", executable="e", name="n", parameters=[{"use_sim_time": LaunchConfiguration("sim")}]),
    ])
    """
    imported = read_python(tmp_path, body)
    hint = imported.slices["robot_launch.yaml"]["nodes"]["n"]["hints"]["launch"]
    assert hint["arguments"] == {"sim": "true"}
    assert hint["written"] == {"parameters.use_sim_time": "$(var sim)"}


def test_statements_are_followed(tmp_path: Path) -> None:
    body = """
    nodes = []
    for number, name in enumerate(["left", "right"]):
        nodes.append(make_node(name, number=number))
    extra = []
    if len(nodes) == 2:
        extra += [make_node("both")]
    options = {"package": "p", "executable": "x"}
    extra.extend([Node(name="from_dict", **options)])
    return LaunchDescription([*nodes, *extra])

def make_node(name, number=9):
    '''A helper.'''
    return Node(package="p", executable="e", name=f"{name}_{number}")
"""
    lines = body.strip("\n")
    text = f"{PYTHON_HEAD}\ndef generate_launch_description():\n{lines}\n"
    imported = read_launch([write_files(tmp_path, robot__launch__py=text)])
    assert list(nodes_of(imported)) == ["left_0", "right_1", "both_9", "from_dict"]
    assert messages_of(imported) == []


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            'return LaunchDescription([Node(package="p", executable="e", name=pick_name())])',
            "not taken: Node:14: its name is computed: `pick_name()`",
        ),
        (
            'return LaunchDescription([Node(package="p", executable="e", name="n", parameters=[{"a": load("x")}])])',
            'not taken: Node:14: the parameter `a` is computed: `load("x")`',
        ),
        (
            'return LaunchDescription([Node(package="p", executable="e", name="n", parameters=[{"a": THERE}])])',
            "not taken: Node:14: the parameter `a` is computed: `THERE`",
        ),
        (
            'return LaunchDescription([Node(package="p", executable="e", name=os.path)])',
            "not taken: Node:14: its name is computed: `os.path`",
        ),
        ("return LaunchDescription(find_all())", "not taken: find_all:14: what it gives is computed: `find_all()`"),
        (
            "return LaunchDescription([IncludeLaunchDescription(PythonLaunchDescriptionSource([FindPackageShare('far'), '/a.launch.py']))])",
            "not taken: IncludeLaunchDescription:14: `$(find-pkg-share far)/a.launch.py` is not read: it does not lie in the folders that were given",
        ),
        (
            'return LaunchDescription([launch.actions.EmitEvent(event=x), Node(package="p", executable="e", name="n")])',
            "not taken: EmitEvent:14: it has no counterpart in the language",
        ),
        (
            "return LaunchDescription([TimerAction(period=3.0, actions=[Node(package='p', executable='e', name='n')])])",
            "noted: TimerAction:14: what is in it starts after 3.0 s",
        ),
    ],
)
def test_what_is_computed_is_noted_with_its_line(body: str, expected: str, tmp_path: Path) -> None:
    assert expected in messages_of(read_python(tmp_path, body))


def test_modules_beside_the_file_are_read(tmp_path: Path) -> None:
    helper = """
    import os
    from launch_ros.actions import Node
    PACKAGE = "helped"
    def make(name, **more):
        return Node(package=PACKAGE, executable=find_program(), name=name)
    """
    body = """
    import helper
    from helper import make as make_node, PACKAGE
    return LaunchDescription([helper.make("a"), make_node("b"), Node(package=PACKAGE, executable="e", name="c")])
    """
    imported = read_python(tmp_path, body, launch___helper__py=helper)
    assert {name: node["package"] for name, node in nodes_of(imported).items()} == dict.fromkeys("abc", "helped")
    assert [str(note.span) for note in imported.notes] == ["helper.py:6:1"]


def test_modules_are_looked_for_where_the_file_says(tmp_path: Path) -> None:
    body = """
    import sys
    sys.path.append(os.path.join(get_package_share_directory("bot"), "tools"))
    import helper
    return LaunchDescription([Node(package=helper.PACKAGE, executable="e", name="n")])
    """
    manifest = "<package><name>bot</name></package>"
    imported = read_python(tmp_path, body, tools___helper__py="PACKAGE = 'helped'\n", package__xml=manifest)
    assert nodes_of(imported)["n"]["package"] == "helped"


def test_two_ways_of_one_name_are_both_taken(tmp_path: Path) -> None:
    body = """
    if os.environ["DISTRO"] < "e":
        driver = Node(package="p", node_executable="old", node_name="driver_old")
    else:
        driver = Node(package="p", executable="new", name="driver_new")
    return LaunchDescription([driver])
    """
    assert list(nodes_of(read_python(tmp_path, body))) == ["driver_old", "driver_new"]


def test_both_ways_of_an_unknown_condition_are_read(tmp_path: Path) -> None:
    body = """
    ld = LaunchDescription()
    if is_big():
        driver = Node(package="p", executable="big", name="big")
        ld.add_action(driver)
    else:
        ld.add_action(Node(package="p", executable="small", name="small"))
    return ld
    """
    imported = read_python(tmp_path, body)
    assert list(nodes_of(imported)) == ["big", "small"]
    hints = [node["hints"]["launch"] for node in imported.slices["robot_launch.yaml"]["nodes"].values()]
    assert [hint["conditions"] for hint in hints] == [["if <is_big()>"], ["unless <is_big()>"]]


def test_functions_that_run_at_the_launch_see_the_defaults(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([DeclareLaunchArgument("kind", default_value="a"), OpaqueFunction(function=setup)])

def setup(context, *args, **kwargs):
    kind = LaunchConfiguration("kind").perform(context)
    if kind == "a":
        return [Node(package="p", executable=kind + "_driver", name="driver")]
    return [Node(package="p", executable="other", name="driver")]
"""
    text = f"{PYTHON_HEAD}\ndef generate_launch_description():\n{body.strip(chr(10))}\n"
    imported = read_launch([write_files(tmp_path, robot__launch__py=text)])
    assert nodes_of(imported)["driver"]["executable"] == "a_driver"
    assert 'noted: if:18: `kind == "a"` holds by the defaults: the other way is not read' in messages_of(imported)


def test_includes_and_parameter_files_of_the_package_are_read(tmp_path: Path) -> None:
    package = "<package format='3'><name>bot</name></package>"
    inner = '<launch><arg name="n" default="x"/><node pkg="p" exec="e" name="$(var n)"/></launch>'
    parameters = "/**:\n  ros__parameters: {rate: 5, deep: {a: 1}}\nmain:\n  ros__parameters: {rate: 7}\n"
    body = """
    share = get_package_share_directory("bot")
    return LaunchDescription([
        IncludeLaunchDescription(
            AnyLaunchDescriptionSource(os.path.join(share, "launch", "inner.launch.xml")), launch_arguments={"n": "given"}.items()
        ),
        Node(package="p", executable="e", name="main",
             parameters=[os.path.join(os.path.dirname(__file__), "..", "config", "main.yaml"), {"own": 1}]),
    ])
    """
    imported = read_python(
        tmp_path, body, package__xml=package, launch___inner__launch__xml=inner, config___main__yaml=parameters
    )
    nodes = nodes_of(imported)
    assert list(nodes) == ["given", "main"]
    assert nodes["main"]["parameters"] == {"rate": 7, "deep": {"a": 1}, "own": 1}
    assert nodes["main"]["parameter_files"] == ["$(find-pkg-share bot)/config/main.yaml"]
    assert messages_of(imported) == []


def test_a_node_without_a_name_is_called_as_its_program_calls_itself(tmp_path: Path) -> None:
    parameters = (
        "depthimage_to_laserscan:\n  ros__parameters: {scan_height: 3}\n"
        "depthimage_to_laserscan_node:\n  ros__parameters: {scan_height: 4}\n"
    )
    body = """
    files = [os.path.join(os.path.dirname(__file__), "..", "config", "scan.yaml")]
    return LaunchDescription([
        Node(package="depthimage_to_laserscan", executable="depthimage_to_laserscan_node", parameters=files),
        Node(package="teleop_twist_joy", executable="teleop_node", namespace="pad"),
        Node(package="nobody_knows", executable="unknown_node"),
        ComposableNodeContainer(package="rclcpp_components", executable="component_container", name="box",
            composable_node_descriptions=[ComposableNode(package="image_proc", plugin="image_proc::RectifyNode")]),
    ])
    """
    package = "<package format='3'><name>bot</name></package>"
    nodes = nodes_of(read_python(tmp_path, body, package__xml=package, config___scan__yaml=parameters))
    assert {node_id: node.get("name") for node_id, node in nodes.items()} == {
        "depthimage_to_laserscan_node": "depthimage_to_laserscan",
        "teleop_node": "teleop_twist_joy_node",
        "unknown_node": None,
        "rectify_node": "RectifyNode",
    }
    assert nodes["depthimage_to_laserscan_node"]["parameters"] == {"scan_height": 3}


def test_of_two_ways_to_start_a_node_the_default_is_taken(tmp_path: Path) -> None:
    body = """
    composed = LaunchConfiguration("composed")
    return LaunchDescription([
        DeclareLaunchArgument("composed", default_value="True"),
        Node(package="p", executable="e", name="n", condition=UnlessCondition(composed)),
        LoadComposableNodes(target_container="far", condition=IfCondition(composed), composable_node_descriptions=[
            ComposableNode(package="p", plugin="p::E", name="n")]),
    ])
    """
    imported = read_python(tmp_path, body)
    assert nodes_of(imported)["n"]["plugin"] == "p::E"
    hint = imported.slices["robot_launch.yaml"]["nodes"]["n"]["hints"]["launch"]
    assert hint["other_ways"] == [{"package": "p", "executable": "e", "conditions": ["unless $(var composed)"]}]
    assert messages_of(imported) == [
        "noted: Node:18: another action starts `/n`, too: this one (only unless $(var composed)) is kept as a hint",
        "noted: ComposableNode:20: the container `/far` is started elsewhere: only its name is known",
    ]


ROS_1 = """\
<launch>
  <arg name="side" default="left"/>
  <param name="/use_sim_time" value="true"/>
  <param name="camera/gain" value="2"/>
  <param name="/nobody/x" value="1"/>
  <machine name="base" address="10.0.0.2"/>
  <group ns="$(arg side)">
    <remap from="image" to="/image"/>
    <remap from="~map" to="map"/>
    <node pkg="cam" type="driver.py" name="camera" machine="base" args="-v" respawn="true">
      <param name="rate" value="30"/>
      <rosparam>{size: [640, 480], mode: {auto: true}}</rosparam>
      <rosparam command="load" file="$(find bot)/config/cam.yaml"/>
    </node>
    <node pkg="nodelet" type="nodelet" name="manager" args="manager"/>
    <node pkg="nodelet" type="nodelet" name="filter" args="load image/filter manager"/>
  </group>
  <node pkg="rviz" type="rviz" name="rviz" unless="$(eval arg('side') == 'left')"/>
  <test pkg="t" type="t" test-name="t"/>
</launch>
"""


def test_files_of_ros_1_are_read(tmp_path: Path) -> None:
    launch_file = write_files(
        tmp_path,
        launch___bot__launch=ROS_1,
        package__xml="<package><name>bot</name></package>",
        config___cam__yaml="exposure: 0.5\nmode: {flash: no}\n",
    )
    imported = read_launch([launch_file])
    (sections,) = imported.slices.values()
    nodes = nodes_of(imported)
    assert sections["ros"] == {"parameters": {"use_sim_time": True}}
    assert sections["hosts"] == {"base": {"title": "base", "description": "Address: 10.0.0.2"}}
    assert nodes["camera"] == {
        "namespace": "/left",
        "package": "cam",
        "executable": "driver.py",
        "host": "base",
        "arguments": ["-v"],
        "remaps": {"image": "/image", "~/map": "map"},
        "parameters": {
            "rate": 30,
            "size": [640, 480],
            "mode": {"auto": True, "flash": False},
            "exposure": 0.5,
        },
        "start": {"respawn": True},
    }
    assert nodes["filter"]["plugin"] == "image/filter"
    assert (nodes["filter"]["kind"], nodes["filter"]["container"]) == ("nodelet", "manager")
    assert sections["nodes"]["rviz"]["hints"]["launch"]["by_default"] == "off"
    assert messages_of(imported) == [
        "not taken: test:19: a test is no part of the robot",
        "not taken: param:4: `/camera/gain` stands on the parameter server and below no node of the files",
        "not taken: param:5: `/nobody/x` stands on the parameter server and below no node of the files",
    ]


def test_a_folder_stands_for_the_files_that_nobody_includes(tmp_path: Path) -> None:
    write_files(
        tmp_path,
        a__launch__xml='<launch><include file="$(dirname)/b.launch.xml"/></launch>',
        b__launch__xml='<launch><node pkg="p" exec="e" name="inner"/></launch>',
        c__launch__xml='<launch><node pkg="p" exec="e" name="other"/></launch>',
    )
    imported = read_launch([tmp_path])
    assert list(imported.slices) == ["a_launch.yaml", "c_launch.yaml"]
    assert list(nodes_of(imported)) == ["inner", "other"]


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.launch.py", b"def f(:\n", "invalid syntax"),
        ("a.launch.py", b"x = 1\n", "it has no function `generate_launch_description`"),
        ("a.launch.py", b"x = '\0'", "source code string cannot contain null bytes"),
        ("a.launch.py", b"\xff\xfe", "it is no UTF-8"),
        ("a.launch.py", b"x = " + b"(" * 5000, "too many nested parentheses"),
        ("a.launch.py", b"x = " + b"-" * 100_000 + b"1", "its expressions nest deeper than Python reads"),
        ("a.launch.py", b"x = 1\n" * 300_000, "it has more than 1,000,000 characters"),
        ("a.launch.py", b"#" * 17_000_000, "it is larger than"),
        ("a.launch.xml", b"<launch><node></launch>", "this is not XML as it should be"),
        ("a.launch.xml", b"<robot/>", "its outermost element is `robot`, and not `launch`"),
        ("a.launch.xml", b"<!DOCTYPE x [<!ENTITY a 'b'>]><launch>&a;</launch>", "it declares a document type"),
        ("a.launch.yaml", b"launch: [", "the text ends where a value should stand"),
        ("a.launch.yaml", b"nodes: {}", "it has no list `launch`"),
    ],
)
def test_what_cannot_be_read_is_told(name: str, data: bytes, message: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(data)
    with pytest.raises(ForeignFileError) as caught:
        read_launch([tmp_path / name])
    assert caught.value.message.startswith(message)
    assert caught.value.help_line


@pytest.mark.parametrize(
    "body",
    try_some(
        [
            "x = []\nx.append(x)\nx.append(x)\nreturn LaunchDescription([Node(package='p', executable='e', name=x)] + x)",
            "x = 'ab'\nfor i in range(1000):\n    x = x + x\nreturn LaunchDescription([Node(package='p', executable='e', name=x)])",
            "x = LaunchConfiguration('a')\nfor i in range(60):\n    x = [x, x]\nreturn LaunchDescription([Node(package='p', executable='e', name=x)])",
            "x = LaunchConfiguration('a')\nfor i in range(60):\n    x = f'{x}{x}'\nreturn LaunchDescription([Node(package='p', executable='e', name=x)])",
            "def f(n):\n    return f(n + 1)\nreturn LaunchDescription([f(0)])",
            "while True:\n    pass\nreturn LaunchDescription([])",
            "return LaunchDescription([Node(package='p', executable='e', name=str(i)) for i in range(1000) for j in range(1000)])",
            "for a in range(1000):\n    for b in range(1000):\n        for c in range(1000):\n            x = 1\nreturn LaunchDescription([])",
            "return LaunchDescription([Node(package='p', executable='e', name=10 ** 10 ** 10)])",
            "return LaunchDescription([" + "[" * 90 + "]" * 90 + "])",
            "x = "
            + " + ".join(["'a'"] * 800)
            + "\nreturn LaunchDescription([Node(package='p', executable='e', name=x)])",
            "open('trace', 'w').write('x')\n__import__('os').system('touch trace')\nreturn LaunchDescription([])",
        ],
        3,
    ),
)
def test_hostile_python_ends_and_runs_nothing(body: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    read_python(tmp_path, body)
    assert not (tmp_path / "trace").exists()


@pytest.mark.parametrize("name", ["Imported", "Method", "dict_method", "list_method", "LAUNCH_DESCRIPTION"])
def test_functions_that_nobody_knows_are_no_methods_of_the_reader(name: str, tmp_path: Path) -> None:
    imported = read_python(tmp_path, f"from mine import {name}\nreturn LaunchDescription([{name}('x')])")
    assert messages_of(imported) == [f"not taken: {name}:15: what it gives is computed: `{name}('x')`"]


def test_a_slice_inside_of_a_tuple_is_quoted(tmp_path: Path) -> None:
    body = "x = [1, 2][0:1, 0]\nreturn LaunchDescription([Node(package='p', executable='e', name='n', arguments=[x])])"
    assert nodes_of(read_python(tmp_path, body))["n"]["package"] == "p"


def test_files_that_include_themselves_end(tmp_path: Path) -> None:
    path = write_files(tmp_path, a__launch__xml='<launch><include file="$(dirname)/a.launch.xml"/></launch>')
    assert [note.message for note in read_launch([path]).notes] == [f"`{path}` is not read: it includes itself"]


def test_nothing_outside_of_the_folder_is_read(tmp_path: Path) -> None:
    (tmp_path / "secret.launch.xml").write_text('<launch><node pkg="p" exec="e" name="secret"/></launch>')
    inner = tmp_path / "inner"
    path = write_files(inner, a__launch__xml='<launch><include file="$(dirname)/../secret.launch.xml"/></launch>')
    assert nodes_of(read_launch([path])) == {}
    (inner / "b.launch.xml").symlink_to(tmp_path / "secret.launch.xml")
    path.write_text('<launch><include file="$(dirname)/b.launch.xml"/></launch>')
    assert nodes_of(read_launch([path])) == {}


@pytest.mark.parametrize(
    "text",
    [
        *(
            "$(var )",
            "$(arg )",
            "$(env )",
            "$(find-pkg-share )",
            "$(find )",
            "$(optenv )",
            "$(not )",
            "$(and )",
            "$(or )",
        ),
        *(
            "$(equals )",
            "$(equals a)",
            "$(not-equals a)",
            "$(equals a b c)",
            "$(eval )",
            "$(command )",
            "$()",
            "$(typed )",
        ),
        *("$(typed a)", "$(path )", "$(text_of )", "$(share )", "$(join )"),
    ],
)
@pytest.mark.parametrize("ending", ["launch", "launch.xml"])
def test_a_substitution_without_its_words_is_left_out_with_its_line(tmp_path: Path, text: str, ending: str) -> None:
    lines = f'<launch>\n<node pkg="a" type="b" exec="b" name="one" if="{text}"/>\n<node pkg="a" type="b" exec="b" name="two" output="{text}" ns="{text}"/>\n'
    file = tmp_path / f"robot.{ending}"
    file.write_text(f'{lines}<node pkg="a" type="b" exec="b" name="three"/>\n</launch>\n', encoding="utf-8")
    imported = read_launch([file])
    assert "three" in nodes_of(imported)
    assert any(note.span.line in {2, 3} for note in imported.notes), messages_of(imported)


def test_what_a_file_lacks_only_where_it_runs_alone_is_not_told(tmp_path: Path) -> None:
    inner = '<launch><arg name="part"/><include file="$(dirname)/$(var part).launch.xml"/><node pkg="p" exec="a" name="a" args="$(eval x)"/></launch>'
    outer = '<launch><include file="$(dirname)/inner.launch.xml"><arg name="part" value="other"/></include></launch>'
    node = '<launch><node pkg="p" exec="b" name="b"/></launch>'
    write_files(tmp_path, outer__launch__xml=outer, inner__launch__xml=inner, other__launch__xml=node)
    alone = messages_of(read_launch([tmp_path / "inner.launch.xml"]))
    assert [each.split(":")[1] for each in alone] == [" arg", " include", " node"]
    whole = read_launch([tmp_path])
    assert (list(nodes_of(whole)), messages_of(whole)) == (["b", "a"], alone[2:])


def test_a_computed_word_keeps_its_place_and_constants_of_math_are_known(tmp_path: Path) -> None:
    """R21: an option without its value would be another command line."""
    body = """
import math
from launch.actions import ExecuteProcess
return LaunchDescription([
    ExecuteProcess(cmd=["tilt", "--pitch", str(math.pi / 2), "--at", find_place()]),
    ExecuteProcess(cmd=[find_tool(), "--pitch"]),
    Node(package="p", executable="e", name="n", arguments=["--yaw", str(-math.tau), "--map", find_map(), "--end"]),
    Node(package="p", executable="e", name="m", arguments=find_words()),
])
"""
    text = f"{PYTHON_HEAD}\ndef generate_launch_description():\n{textwrap.indent(body, '    ')}\n"
    imported = read_launch([write_files(tmp_path, robot__launch__py=text)], {})
    nodes = nodes_of(imported)
    assert nodes["tilt"]["command"] == ["tilt", "--pitch", "1.5707963267948966", "--at", "$(computed find_place())"]
    assert nodes["n"]["arguments"] == ["--yaw", "-6.283185307179586", "--map", "$(computed find_map())", "--end"]
    assert "arguments" not in nodes["m"]
    assert [each.message.split("`")[1] for each in imported.notes] == [
        *("find_place()", "find_tool()", "find_map()", "find_words()")
    ]


def test_the_priority_and_cores_of_a_process_are_those_of_its_node(tmp_path: Path) -> None:
    """Also as launch files by archgen say them; in front of a container and what is none of both is told."""
    prefixes = {
        "plain": "chrt -f 40",
        "made": "sudo -u bot -- /opt/ws/lib/r/run_scheduled chrt -f 60 taskset -c 2,4-5 --",
        "one": "taskset -c 3",
        "gdb": "chrt -f 7 gdb --args",
    }
    nodes = "\n".join(
        f'<node pkg="p" exec="{name}" name="{name}" launch-prefix="{prefix}"/>' for name, prefix in prefixes.items()
    )
    box = '<node_container pkg="rclcpp_components" exec="component_container" name="box" namespace="" launch-prefix="chrt -f 5"/>'
    (tmp_path / "r.launch.xml").write_text(f"<launch>\n{nodes}\n{box}\n</launch>\n", encoding="utf-8")
    imported = read_launch([tmp_path / "r.launch.xml"])
    (sections,) = imported.slices.values()
    assert {name: node.get("timing") for name, node in sections["nodes"].items()} == {
        "plain": {"priority": 40},
        "made": {"priority": 60, "cores": [2, 4, 5]},
        "one": {"core": 3},
        "gdb": {"priority": 7},
    }
    told = [each for each in messages_of(imported) if "what runs it" in each]
    assert told == [
        "not taken: node:5: what runs it is left out: `gdb --args`",
        "not taken: node_container:6: what runs it is left out: `chrt -f 5`",
    ]
