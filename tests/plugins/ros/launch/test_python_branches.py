"""Conditions in launch files in Python that only running them would tell: what differs behind them is not known."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.plugins.ros.launch.test_launch_import import messages_of, nodes_of, read_python

NODE = 'Node(package="p", executable="e", name="n", arguments=words, parameters=[values])'


@pytest.mark.parametrize(
    ("statements", "arguments", "values"),
    [
        ("if ask():\n    words.append('b')", ["a"], {"x": 1, "y": 2}),
        ("if ask():\n    words.append('b')\nelse:\n    words.append('b')", ["a", "b"], {"x": 1, "y": 2}),
        ("if ask():\n    values['x'] = 5", ["a"], {"y": 2}),
        ("if ask():\n    values.update(y=5)\nelse:\n    words.insert(0, 'b')", [], {"x": 1}),
        ("if ask():\n    words = ['b']\nelse:\n    words = ['a']", [], {"x": 1, "y": 2}),
        ("if ask():\n    words.append('b')\n    raise ValueError\nwords.append('c')", ["a", "c"], {"x": 1, "y": 2}),
        ("if ask():\n    words.append('b')\n    return LaunchDescription([])", ["a"], {"x": 1, "y": 2}),
        ("while len(words) < 3:\n    words.append(str(len(words)))", ["a", "1", "2"], {"x": 1, "y": 2}),
        ("try:\n    raise ValueError\nexcept ValueError:\n    words.append('b')", ["a", "b"], {"x": 1, "y": 2}),
        ("values.setdefault('x', 9)\nvalues['z'] = values.pop('y')", ["a"], {"x": 1, "z": 2}),
    ],
)
def test_only_what_both_ways_say_is_taken(
    statements: str, arguments: list[str], values: dict[str, int], tmp_path: Path
) -> None:
    body = f"words = ['a']\nvalues = {{'x': 1, 'y': 2}}\n{statements}\nreturn LaunchDescription([{NODE}])"
    imported = read_python(tmp_path, body)
    node = nodes_of(imported)["n"]
    assert node.get("arguments", []) == arguments
    assert node["parameters"] == values
    is_whole = (arguments, values) in [(["a", "b"], {"x": 1, "y": 2}), (["a"], {"x": 1, "z": 2})]
    computed = [message for message in messages_of(imported) if "computed: `either way of `if ask()``" in message]
    assert bool(computed) == (
        "ask" in statements and not is_whole and "return" not in statements and "raise" not in statements
    )


def test_what_follows_a_way_that_ends_counts_for_the_other_one(tmp_path: Path) -> None:
    body = """
    ld = LaunchDescription([Node(package="p", executable="first")])
    for side in ["left", "right"]:
        if skip(side):
            continue
        ld.add_action(Node(package="p", executable=side))
    if small():
        ld.add_action(Node(package="p", executable="small"))
        return ld
    ld.add_action(Node(package="p", executable="big"))
    return ld
    """
    imported = read_python(tmp_path, body)
    (sections,) = imported.slices.values()
    assert {name: node["hints"]["launch"].get("conditions") for name, node in sections["nodes"].items()} == {
        "first": None,
        "left": ["unless <skip(side)>"],
        "right": ["unless <skip(side)>"],
        "small": ["if <small()>"],
        "big": ["unless <small()>"],
    }


@pytest.mark.parametrize(
    "ways", [("break", "continue"), ("continue", "break"), ("break", "return ld"), ("raise X", "break")]
)
def test_nothing_follows_where_both_ways_end(ways: tuple[str, str], tmp_path: Path) -> None:
    body = f"""
    ld = LaunchDescription([])
    for side in ["left", "right"]:
        if skip(side):
            {ways[0]}
        else:
            {ways[1]}
        ld.add_action(Node(package="p", executable=side))
    ld.add_action(Node(package="p", executable="end"))
    return ld
    """
    assert list(nodes_of(read_python(tmp_path, body))) == ["end"]


def test_what_one_way_alone_makes_is_taken_with_its_condition(tmp_path: Path) -> None:
    body = """
    extra = None
    if ask():
        pass
    else:
        extra = Node(package="p", executable="e", name="n")
        more = [Node(package="p", executable="e", name="m")]
    return LaunchDescription([extra, *more])
    """
    imported = read_python(tmp_path, body)
    assert list(nodes_of(imported)) == ["n", "m"]
    assert imported.comments["robot_launch.yaml"]["nodes", "m"] == "only unless <ask()>"
