"""Callback groups of generated nodes of ROS 1: a lock for each, so that what excludes one another does, and the rest runs side by side."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.property_sizes import try_some
from tests.running import archgen_here

PROJECT = """\
archgen: 1
project: {id: rt, title: Robot}
ros: {distro: noetic}
groups:
  g:
    components:
      stop: {functionality: Stops., inputs: {image: cam.image}, timing: {rate: 20 Hz, wcet: 1 ms}}
      map: {functionality: Maps., inputs: {image: cam.image}, outputs: {ask: std_srvs/srv/Trigger}}
      log: {functionality: Logs., inputs: {image: cam.image}}
      cam: {functionality: Sees., outputs: {image: std_msgs/String}}
nodes:
  brain: {implements: [stop, map, log], GROUPS}
"""
WATCHED = """\
import sys, threading
from unittest.mock import MagicMock
for name in ("rospy", "std_msgs", "std_msgs.msg", "std_srvs", "std_srvs.srv"):
    sys.modules[name] = MagicMock()
from rt_g import brain_node

entered, leave = threading.Event(), threading.Event()


class Watched(MagicMock):
    def receive_stop_image(self, message):
        entered.set()
        leave.wait(60)


brain_node.Brain = lambda node: Watched()
node = brain_node.BrainNode()
threading.Thread(target=node.receive_stop_image, args=[None], daemon=True).start()
assert entered.wait(60)


def runs(method, *arguments):
    # What is not locked out ends at once; what is stays where it is, however long one looks.
    thread = threading.Thread(target=method, args=arguments, daemon=True)
    thread.start()
    thread.join(60 if expected[method.__name__] else 0.2)
    return not thread.is_alive()


expected = eval(sys.argv[1])
found = {name: runs(getattr(node, name), None) for name in expected}
leave.set()
print(found == expected, found)
"""
CALLED = ("on_timer", "receive_map_image", "serve_ask", "receive_log_image")


@pytest.mark.parametrize(
    ("groups", "side_by_side"),
    try_some(
        [
            ("callback_groups: {fast: [stop], slow: [map]}", (False, True, True, True)),
            ("callback_groups: {fast: [stop, map]}", (False, False, False, True)),
            ("callback_groups: {slow: [map]}", (False, True, True, False)),
            ("threads: 2", (False, False, False, False)),
            ("reentrant: true", (True, True, True, True)),
        ],
        2,
    ),
)
def test_a_lock_for_each_group(groups: str, side_by_side: tuple[bool, ...], tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT.replace("GROUPS", groups))
    archgen_here("generate", "ros1_python", "-o", tmp_path / "w", "--keep-going", cwd=tmp_path)
    package = tmp_path / "w" / "src" / "rt_g"
    expected = dict(zip(CALLED, side_by_side, strict=True))
    done = subprocess.run(  # noqa: S603 - what was generated here
        [sys.executable, "-c", WATCHED, repr(expected)],
        env={"PYTHONPATH": str(package / "src"), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout.startswith("True"), done.stdout + done.stderr
    assert ("of other `callback_groups`" in (package / "README.md").read_text()) == groups.startswith("callback")
