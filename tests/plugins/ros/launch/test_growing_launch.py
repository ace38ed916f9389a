"""Launch files whose lists and actions double in every line end soon, with what is not followed told at its place; long ones are read."""

from __future__ import annotations

import cProfile
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import cast

import pytest

from archgen.plugins.ros.launch import scope_run
from archgen.plugins.ros.launch.launch_import import read_launch, run_launch_files
from tests.plugins.ros.launch.test_launch_import import messages_of, nodes_of, read_python
from tests.property_sizes import try_some

LAST = 'return LaunchDescription([Node(package="p", executable="e", name="n")])'
EXCESS = "steps that archgen follows: what comes later is not read whole"


@pytest.mark.parametrize(
    "line",
    [
        "s = [*s, *s]",
        "s = (*s, *s)",
        "s = {*s, *s}",
        "s += s",
        pytest.param("s.extend(s)", marks=pytest.mark.slow),
        "s = list(map(str, [*s, *s]))",
    ],
)
def test_a_list_that_doubles_in_every_line_is_not_followed_for_ever(line: str, tmp_path: Path) -> None:
    tracemalloc.start()
    imported = read_python(tmp_path, "\n".join(["s = ['a', 'b']", *[line] * 60, LAST]))
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert list(nodes_of(imported)) == ["n"]
    assert peak_bytes < 150e6


@pytest.mark.parametrize(
    "line",
    try_some(
        [
            *("s += s", "s.extend(s)", "s = GroupAction([s, s])", "s = TimerAction(period=1.0, actions=[s, s])"),
            "while True: s.append(Node(package='p', executable='e'))",
        ],
        2,
    ),
)
def test_what_is_not_followed_is_told_once_and_what_was_read_stays(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scope_run, "_MAX_STEPS", 200_000)
    body = ['s = [Node(package="p", executable="e")]', *[line] * 60, "return LaunchDescription(s)"]
    imported = read_python(tmp_path, "\n".join(body))
    assert sum(EXCESS in each for each in messages_of(imported)) == 1
    assert len(imported.notes) < 200
    assert "Node" in imported.taken


def _write_nodes(count: int) -> str:
    nodes = "".join(
        f'<node pkg="p" exec="e{number}" name="n{number}"><param name="rate" value="1.5"/><remap from="a" to="/b{number}"/></node>'
        for number in range(count)
    )
    return f"<launch>{nodes}</launch>"


def _write_loop(count: int) -> str:
    return (
        "from launch import LaunchDescription\nfrom launch_ros.actions import *\n"
        "def generate_launch_description():\n    made = LaunchDescription()\n"
        f"    for number in range({count}):\n"
        "        container = ComposableNodeContainer(package='p', executable='e', name=f'c{number}', namespace='')\n"
        "        made.add_action(container)\n"
        "        made.add_action(LoadComposableNodes(target_container=container, composable_node_descriptions=["
        "ComposableNode(package='p', plugin='q', name=f'n{number}')]))\n"
        "    return made\n"
    )


@pytest.mark.slow
@pytest.mark.parametrize(("write", "name"), [(_write_nodes, "x.launch.xml"), (_write_loop, "x.launch.py")])
def test_steps_and_calls_grow_with_the_nodes_and_no_faster(
    write: Callable[[int], str], name: str, tmp_path: Path
) -> None:
    steps, calls = [], []
    for count in (1000, 2000):
        (tmp_path / name).write_text(write(count))
        profile = cProfile.Profile()
        profile.enable()
        launched = run_launch_files([tmp_path / name])
        profile.disable()
        profile.create_stats()
        stats = cast("dict[object, tuple[int, int]]", profile.stats)
        calls.append(sum(each[1] for each in stats.values()))
        steps.append(launched.run.budget.steps - launched.run.budget.left)
    assert steps[1] < 2.02 * steps[0]
    assert calls[1] < 2.02 * calls[0]


@pytest.mark.slow
def test_fifty_thousand_nodes_are_read(tmp_path: Path) -> None:
    (tmp_path / "x.launch.xml").write_text(_write_nodes(50_000))
    imported = read_launch([tmp_path / "x.launch.xml"])
    assert len(nodes_of(imported)) == 50_000
    assert not imported.notes
