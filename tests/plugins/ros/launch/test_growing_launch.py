"""Launch files whose lists and actions double in every line end soon, with what is not followed told at its place."""

from __future__ import annotations

import time
import tracemalloc
from pathlib import Path

import pytest

from tests.plugins.ros.launch.test_launch_import import messages_of, nodes_of, read_python

LAST = 'return LaunchDescription([Node(package="p", executable="e", name="n")])'


@pytest.mark.parametrize(
    "line", ["s = [*s, *s]", "s = (*s, *s)", "s = {*s, *s}", "s += s", "s.extend(s)", "s = list(map(str, [*s, *s]))"]
)
def test_a_list_that_doubles_in_every_line_is_not_followed_for_ever(line: str, tmp_path: Path) -> None:
    tracemalloc.start()
    imported = read_python(tmp_path, "\n".join(["s = ['a', 'b']", *[line] * 60, LAST]))
    peak_bytes = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert list(nodes_of(imported)) == ["n"]
    assert peak_bytes < 100e6


@pytest.mark.parametrize("line", ["s += s", "s.extend(s)"])
def test_what_is_not_followed_is_told(line: str, tmp_path: Path) -> None:
    messages = messages_of(read_python(tmp_path, "\n".join(["s = ['a', 'b']", *[line] * 20, LAST])))
    assert any("the list is longer than 5,000, which archgen does not follow" in each for each in messages)


@pytest.mark.parametrize("action", ["GroupAction([s, s])", "TimerAction(period=1.0, actions=[s, s])"])
def test_actions_that_stand_in_one_another_twice_are_walked_so_far(action: str, tmp_path: Path) -> None:
    body = ['s = Node(package="p", executable="e")', *[f"s = {action}"] * 60, "return LaunchDescription([s])"]
    start = time.process_time()
    messages = messages_of(read_python(tmp_path, "\n".join(body)))
    assert time.process_time() - start < 20
    assert sum("more than 100,000 actions are not followed" in each for each in messages) == 1
    assert len(messages) < 150_000
