"""What actions of launch files set for others: in the order, and as far, as ROS has it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.plugins.ros.launch import launch_files
from archgen.plugins.ros.launch.launch_import import read_launch
from tests.plugins.ros.launch.test_launch_import import messages_of, nodes_of, read_python, write_files

INNER = '<launch><arg name="a" default="inner"/></launch>'


@pytest.mark.parametrize(
    ("actions", "expected"),
    [
        # What does not run sets nothing.
        ('<include file="$(dirname)/inner.launch.xml" if="false"><arg name="a" value="far"/></include>', "default"),
        ('<include file="$(dirname)/inner.launch.xml"><arg name="a" value="far"/></include>', "far"),
        ('<group scoped="false" if="false"><let name="a" value="far"/></group>', "default"),
        ('<group scoped="false"><let name="a" value="far"/></group>', "far"),
        ('<let name="a" value="far" if="$(var open)"/>', None),
        ('<let name="a" value="default" if="$(var open)"/>', "default"),
    ],
)
def test_arguments_behind_what_sets_them(actions: str, expected: str | None, tmp_path: Path) -> None:
    text = f"""<launch><arg name="open"/><arg name="a" default="default"/>{actions}
        <node pkg="p" exec="e" name="n"><param name="a" value="$(var a)"/></node></launch>"""
    imported = read_launch([write_files(tmp_path, a__launch__xml=text, inner__launch__xml=INNER)])
    assert nodes_of(imported)["n"].get("parameters") == (None if expected is None else {"a": expected})
    assert (
        "not taken: node:1: the parameter `a` is computed: `either way of `if $(var open)``" in messages_of(imported)
    ) == (expected is None)


@pytest.mark.parametrize(
    ("group", "expected"),
    [
        ("<group>", {"a": "1", "b": "2"}),
        ('<group forwarding="false">', {"a": "$(var a)", "b": "$(var b)"}),
        ('<group forwarding="false"><keep name="a" value="kept $(var a)"/>', {"a": "kept 1", "b": "$(var b)"}),
    ],
)
def test_groups_hand_arguments_on(group: str, expected: dict[str, str], tmp_path: Path) -> None:
    text = f"""<launch><arg name="a" default="1"/><arg name="b" default="2"/>{group}
        <node pkg="p" exec="e" name="n"><param name="a" type="str" value="$(var a)"/><param name="b" type="str" value="$(var b)"/></node>
        </group></launch>"""
    assert nodes_of(read_launch([write_files(tmp_path, a__launch__xml=text)]))["n"]["parameters"] == expected


def test_the_order_of_parameters_for_all_nodes_counts(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([
        SetParameter("rate", 1), SetParametersFromFile(os.path.join(os.path.dirname(__file__), "all.yaml")), SetUseSimTime(True),
        Node(package="p", executable="e", name="n"),
    ])
    """
    values = "/**:\n  ros__parameters: {rate: 5}\n"
    imported = read_python(tmp_path, body, launch___all__yaml=values)
    assert nodes_of(imported)["n"]["parameters"] == {"rate": 5, "use_sim_time": True}


def test_containers_are_found_as_ros_finds_them(tmp_path: Path) -> None:
    body = """
    box = ComposableNodeContainer(package="rclcpp_components", executable="component_container", name="box", namespace="in")
    return LaunchDescription([GroupAction([
        PushRosNamespace("r"), box,
        LoadComposableNodes(target_container=box, composable_node_descriptions=[
            ComposableNode(package="p", plugin="p::A", name="a")]),
        LoadComposableNodes(target_container="r/in/box", composable_node_descriptions=[
            ComposableNode(package="p", plugin="p::B", name="b")]),
    ])])
    """
    imported = read_python(tmp_path, body)
    assert {name: node["container"] for name, node in nodes_of(imported).items()} == {"a": "box", "b": "box"}
    assert messages_of(imported) == []


def test_programs_of_one_name_are_all_taken(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([
        ExecuteProcess(cmd=["one"], name="tool", respawn=True), ExecuteProcess(cmd=["two"], name="tool"),
        Node(package="p", executable="e", name="tool"),
    ])
    """
    imported = read_python(tmp_path, body)
    nodes = nodes_of(imported)
    assert [node.get("command") for node in nodes.values()] == [["one"], ["two"], None]
    assert next(iter(nodes.values()))["start"] == {"respawn": True}
    assert messages_of(imported) == []


def test_names_of_ros_1_are_nearest_first(tmp_path: Path) -> None:
    text = """<launch>
      <param name="~tint" value="3"/>
      <param name="/c/robot_description" command="xacro x.urdf"/>
      <remap from="a" to="outer"/>
      <remap from="/d" to="//x//y/"/>
      <group ns="g">
        <remap from="a" to="inner"/>
        <node pkg="p" type="e" name="c" ns="/">
          <param name="costmap/width" value="5"/>
          <rosparam>{costmap: {height: 3}}</rosparam>
          <remap from="a" to="own"/>
        </node>
        <node pkg="p" type="e" name="d"/>
      </group>
    </launch>"""
    imported = read_launch([write_files(tmp_path, a__launch=text)])
    nodes: dict[str, Any] = nodes_of(imported)
    assert nodes["c"]["remaps"] == {"a": "own", "/d": "/x/y"}
    assert nodes["d"]["remaps"] == {"/d": "/x/y", "a": "inner"}
    assert nodes["c"]["parameters"] == {"tint": 3, "costmap": {"width": 5, "height": 3}}
    assert nodes["c"]["parameter_commands"] == {"robot_description": ["xacro", "x.urdf"]}
    assert messages_of(imported) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('<param name="/n/x" value="1" if="true"/>{}', {"x": 1}),
        ('<param name="/n/x" value="1" if="false"/>{}', None),
        ('<group if="false"><param name="/n/x" value="1"/></group>{}', None),
        ('<group if="false"><param name="/use_sim_time" value="true"/></group>{}', None),
        ('<group if="false"><param name="/n/x" value="1"/>{}</group>', {"x": 1}),
        ('<group if="$(arg open)"><param name="/n/x" value="1"/>{}</group>', {"x": 1}),
        ('<param name="/n/x" value="1" if="$(arg open)"/>{}', None),
        ('<param name="/n/own" command="cat a"/>{}', None),
    ],
)
def test_parameters_of_the_server_count_under_their_conditions(
    text: str, expected: dict[str, int] | None, tmp_path: Path
) -> None:
    node = '<node pkg="p" type="e" name="n"><param name="own" value="2"/></node>'
    whole = f'<launch><arg name="open"/>{text.format(node)}</launch>'
    imported = read_launch([write_files(tmp_path, a__launch=whole)])
    (sections,) = imported.slices.values()
    assert "ros" not in sections
    assert sections["nodes"]["n"]["parameters"] == {**(expected or {}), "own": 2}
    assert "parameter_commands" not in sections["nodes"]["n"]
    left_out = [note.message for note in imported.notes if note.fate == "not taken"]
    assert left_out == (
        ["what counts only if $(var open) is left out"] if text.startswith('<param name="/n/x" value="1" if="$') else []
    )


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('parameters=[{"a": {"b": load(), "c": 1}}]', "not taken: Node:15: the parameter `a.b` is computed: `load()`"),
        (
            'parameters=[{load(): 1, "a": {"c": 1}}]',
            'not taken: Node:15: a parameter file is computed: `{load(): 1, "a": {"c": 1}}`',
        ),
        (
            'additional_env={"A": load()}, parameters=[{"a": {"c": 1}}]',
            "not taken: Node:15: a variable of its environment is computed: `load()`",
        ),
        ('cwd=load(), parameters=[{"a": {"c": 1}}]', "not taken: Node:15: its folder is computed: `load()`"),
        ('parameters=[{"a": {"c": 1}}], **load()', "not taken: call:15: arguments of it are computed"),
    ],
)
def test_nothing_is_dropped_silently(body: str, expected: str, tmp_path: Path) -> None:
    imported = read_python(
        tmp_path, f'nodes = []\nreturn LaunchDescription([Node(package="p", executable="e", name="n", {body})])'
    )
    assert messages_of(imported) == [expected]
    if "file" not in expected:
        assert nodes_of(imported)["n"]["parameters"] == {"a": {"c": 1}}


def test_places_are_counted_in_characters_of_the_right_file(tmp_path: Path) -> None:
    helper = "VALUE = 1\n\f\nSPEED = compute()\n"
    body = 'from helper import SPEED\nreturn LaunchDescription([LogInfo(msg="äöü"), Node(package="p", executable="e", parameters=[{"a": SPEED}])])'
    imported = read_python(tmp_path, body, launch___helper__py=helper)
    assert [(str(note.span), note.message) for note in imported.notes] == [
        ("helper.py:3:1", "the parameter `a` is computed: `compute()`")
    ]
    imported = read_python(
        tmp_path, 'return LaunchDescription([LogInfo(msg="äöü"), unset("x"), launch.actions.EmitEvent()])'
    )
    assert [note.span.column for note in imported.notes] == [1, 63]


def test_what_modules_give_is_told_at_their_lines(tmp_path: Path) -> None:
    helper = "\n" * 30 + "measure = lambda: compute()\ndef pick(value):\n    return value\nnodes = compute()\n"
    body = """
    import helper
    node = Node(package="p", executable="e", parameters=[{"a": helper.measure(), "b": helper.pick()}])
    return LaunchDescription([node, helper.nodes])
    """
    imported = read_python(tmp_path, body, launch___helper__py=helper)
    assert [f"{note.span}: {note.message}" for note in imported.notes] == [
        "helper.py:31:1: the parameter `a` is computed: `compute()`",
        "helper.py:32:1: the parameter `b` is computed: `value`",
        "helper.py:34:1: what it gives is computed: `compute()`",
    ]


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        ("'/', ns, 'arm'", "/arm"),
        ("ns, 'arm'", "arm"),
        ("'a/', ns, 'b', 'c'", "a/b/c"),
        ("'a', '/b', 'c'", "/b/c"),
        ("FindPackageShare('x').find('bot'), 'a'", "$(find-pkg-share bot)/a"),
    ],
)
def test_paths_are_joined_as_python_joins_them(parts: str, expected: str, tmp_path: Path) -> None:
    body = f"""
    ns = LaunchConfiguration("ns")
    return LaunchDescription([DeclareLaunchArgument("ns", default_value=""),
        Node(package="p", executable="e", name="n", arguments=[PathJoinSubstitution([{parts}])])])
    """
    assert nodes_of(read_python(tmp_path, body))["n"]["arguments"] == [expected]


@pytest.mark.parametrize(
    "text",
    [
        '<launch><param name="a" value="1"/></launch>',
        '<launch><group><param name="a" value="1"/></group></launch>',
        "<launch><param_value/><entries/><conditions/><entity/><let/></launch>",
        "<launch><node_values/><unknown/><node/><entity/><param exec='x'/></launch>",
    ],
)
def test_any_element_is_read_or_noted(text: str, tmp_path: Path) -> None:
    imported = read_launch([write_files(tmp_path, a__launch__xml=text)])
    assert len(messages_of(imported)) >= 1


def test_of_packages_of_one_name_the_own_one_counts(tmp_path: Path) -> None:
    for folder in ("a", "b", "c"):
        write_files(
            tmp_path / folder,
            package__xml="<package><name>bot</name></package>",
            launch___a__launch__xml='<launch><include file="$(find-pkg-share bot)/launch/b.launch.xml"/></launch>',
            launch___b__launch__xml=f'<launch><node pkg="p" exec="{folder}" name="n"/></launch>',
        )
    assert nodes_of(read_launch([tmp_path / "b" / "launch" / "a.launch.xml"]))["n"]["executable"] == "b"


def test_packages_lie_as_deep_as_they_like_and_folders_not_looked_through_are_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path.joinpath(*"abcdefghij", "drivers")
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>drivers</name></package>")
    (package / "launch" / "inner.launch.xml").write_text('<launch><node pkg="p" exec="x" name="inner"/></launch>')
    outer = '<launch><include file="$(find-pkg-share drivers)/launch/inner.launch.xml"/></launch>'
    (tmp_path / "outer.launch.xml").write_text(outer)
    files = [tmp_path / "outer.launch.xml", tmp_path]
    assert list(nodes_of(read_launch(files))) == ["inner"]
    assert read_launch(files).notes == ()
    monkeypatch.setattr(launch_files, "_MAX_FOLDERS", 5)
    messages = [(note.message, note.fate) for note in read_launch(files).notes]
    words = "only the first 5 folders in it were looked through: packages that lie in others are not found"
    assert messages[-1] == (words, "noted")


def test_arguments_come_before_the_rules_of_groups_and_those_before_the_nodes_own(tmp_path: Path) -> None:
    """The order of the command line, of which ROS 2 takes the first rule for a name."""
    body = """
    return LaunchDescription([
        SetRemap("a", "outer"),
        SetRemap("b", "outer"),
        Node(package="p", executable="e", name="n", remappings=[("a", "own"), ("b", "own"), ("c", "own"), ("d", "own")],
            arguments=["--ros-args", "-r", "a:=argued", "-r", "c:=argued", "-r", "c:=second", "-r", "__node:=m", "-r", "__node:=k"]),
    ])
    """
    (node,) = nodes_of(read_python(tmp_path, body)).values()
    assert node["remaps"] == {"a": "argued", "c": "argued", "b": "outer", "d": "own"}
    assert node.get("name", "m") == "m"


def test_of_two_spellings_of_one_name_the_first_rule_is_taken(tmp_path: Path) -> None:
    body = """
    return LaunchDescription([
        Node(package="p", executable="e", name="n", namespace="a", remappings=[("x", "y"), ("/a/x", "z"), ("/x", "w")]),
    ])
    """
    imported = read_python(tmp_path, body)
    (node,) = nodes_of(imported).values()
    assert node["remaps"] == {"x": "y", "/x": "w"}
    assert ["the remap from `/a/x` says nothing" in each for each in messages_of(imported)] == [True]
