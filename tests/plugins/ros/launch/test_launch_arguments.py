"""Values of launch arguments on the command line: filled in as ROS does, refused where no file declares such a name."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.importers.foreign_import import ForeignFileError
from archgen.plugins.ros.launch.launch_import import read_launch
from tests.plugins.ros.launch.test_launch_import import PYTHON_HEAD, nodes_of

FILES = {
    "a.launch.xml": """<launch>
        <arg name="robot" default="r1"/>
        <arg name="kind"><choice value="big"/><choice value="small"/></arg>
        <node pkg="p" exec="$(var kind)" name="$(var robot)"/>
        <node pkg="p" exec="$(var undeclared)" name="n"/></launch>""",
    "a.launch.yaml": """launch:
- arg: {name: robot, default: r1}
- arg: {name: kind, choice: [{value: big}, {value: small}]}
- node: {pkg: p, exec: $(var kind), name: $(var robot)}
- node: {pkg: p, exec: $(var undeclared), name: "n"}
""",
    "a.launch.py": PYTHON_HEAD
    + """
def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("robot", default_value="r1"),
        DeclareLaunchArgument("kind", choices=["big", "small"]),
        OpaqueFunction(function=setup),
        Node(package="p", executable=LaunchConfiguration("undeclared"), name="n"),
    ])

def setup(context):
    return [Node(package="p", executable=LaunchConfiguration("kind").perform(context), name=LaunchConfiguration("robot"))]
""",
    "a.launch": """<launch>
        <arg name="robot" default="r1"/>
        <arg name="kind"/>
        <arg name="fixed" value="x"/>
        <include file="$(dirname)/b.launch"/>
        <node pkg="p" type="$(arg kind)" name="$(arg robot)"/></launch>""",
}
INNER = '<launch><arg name="inner" default="in"/><node pkg="p" type="$(arg inner)" name="inner"/></launch>'


def write_launch_file(folder: Path, name: str) -> Path:
    """Write one of the files, and what it includes."""
    (folder / name).write_text(FILES[name])
    (folder / "b.launch").write_text(INNER)
    return folder / name


@pytest.mark.parametrize("name", FILES)
def test_given_arguments_are_filled_in(name: str, tmp_path: Path) -> None:
    path = write_launch_file(tmp_path, name)
    imported = read_launch([path], {"robot": "r7", "kind": "big"})
    nodes = nodes_of(imported)
    assert nodes["r7"] == {"package": "p", "executable": "big"}
    (sections,) = imported.slices.values()
    assert sections["nodes"]["r7"]["hints"]["launch"]["arguments"] == {"robot": "r7", "kind": "big"}
    if name != "a.launch":
        # What a file asks for and does not declare can be given all the same.
        assert nodes_of(read_launch([path], {"undeclared": "e"}))["n"]["executable"] == "e"


@pytest.mark.parametrize(
    ("name", "given", "message", "line", "help_line"),
    [
        ("a.launch.xml", {"robt": "x"}, "no launch file that is read declares an argument `robt`", 1, "`robot`"),
        ("a.launch.py", {"zzzzzz": "x"}, "no launch file that is read declares an argument", 1, "declare kind, robot"),
        ("a.launch.xml", {"kind": "huge"}, "`huge` is none of the choices of the argument `kind`", 3, "big, small"),
        ("a.launch.yaml", {"kind": "huge"}, "`huge` is none of the choices of the argument `kind`", 3, "big, small"),
        ("a.launch.py", {"kind": "huge"}, "`huge` is none of the choices of the argument `kind`", 16, "big, small"),
        ("a.launch", {"fixed": "y"}, "the argument `fixed` has a fixed value here", 4, "leave out `fixed:=y`"),
        # ROS 1 hands arguments on to the file that is launched only.
        ("a.launch", {"inner": "y"}, "no launch file that is read declares an argument `inner`", 1, "kind, robot"),
        ("b.launch", {"x": "y"}, "no launch file that is read declares an argument `x`", 1, "they declare inner"),
    ],
)
def test_what_cannot_be_given_is_refused(  # noqa: PLR0913, PLR0917 - a case each
    name: str, given: dict[str, str], message: str, line: int, help_line: str, tmp_path: Path
) -> None:
    write_launch_file(tmp_path, name if name in FILES else "a.launch")
    with pytest.raises(ForeignFileError) as caught:
        read_launch([tmp_path / name], given)
    assert caught.value.message.startswith(message)
    assert caught.value.span.line == line
    assert help_line in caught.value.help_line


def test_the_first_note_about_a_variable_says_how_to_give_its_value(tmp_path: Path) -> None:
    node = '<node pkg="p" exec="e" name="n%d" namespace="$(env ROBOT_%s)"/>'
    (tmp_path / "a.launch.xml").write_text(
        f"<launch>\n{node % (1, 'A')}\n{node % (2, 'A')}\n{node % (3, 'B')}\n</launch>\n", encoding="utf-8"
    )
    told = {note.span.line: note.help_line for note in read_launch([tmp_path / "a.launch.xml"]).notes}
    assert told == {2: "say what it is: `--env ROBOT_A=VALUE`", 3: "", 4: "say what it is: `--env ROBOT_B=VALUE`"}
