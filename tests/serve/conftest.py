"""A small robot that is served."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen.products.output_options import OutputOptions
from archgen.serve.live_site import LiveSite
from archgen.serve.site_server import SiteServer

ROBOT = """\
archgen: 1
project: {id: robot, title: Robot}
partners: {p: {title: Partner}}
hosts: {pc: {title: Base, cores: 1}, box: {title: Box, cores: 1}}
report: {chapters: [docs/text.md, overview]}
groups:
  g:
    components:
      eye: {owner: p, functionality: Looks., outputs: {o: std_msgs/msg/Bool}}
      brake: {owner: p, functionality: Stops., inputs: {i: eye.o}}
nodes:
  eye: {implements: eye, host: pc, timing: {period: 100 ms, wcet: 5 ms, bcet: 5 ms, priority: 3}}
  brake: {implements: brake, host: pc, timing: {behaviour: event, wcet: 5 ms, bcet: 5 ms}}
chains:
  stop: {title: Stops in time, through: [g.eye, g.brake], deadline: 200 ms}
"""
PIXEL = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000001000000010806000000"
    "1f15c4890000000d49444154789c6360606060000000050001a5f645400000000049454e44ae426082"
)


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Write the robot's project, and return its folder."""
    root = tmp_path / "robot"
    (root / "docs").mkdir(parents=True)
    (root / "archgen.yaml").write_text(ROBOT)
    (root / "docs" / "text.md").write_text("# Words\n\nHello ![A dot](dot.png)\n")
    (root / "docs" / "dot.png").write_bytes(PIXEL)
    return root


@pytest.fixture
def live_site(robot: Path) -> Iterator[LiveSite]:
    """Start the live site of the robot."""
    live = LiveSite(robot, OutputOptions())
    live.start()
    yield live
    live.stop()


@pytest.fixture
def server(live_site: LiveSite) -> Iterator[SiteServer]:
    """Serve the robot at a free port."""
    started = SiteServer(live_site, "127.0.0.1", 0)
    thread = threading.Thread(target=started.serve_forever, kwargs={"poll_interval": 0.05})
    thread.start()
    yield started
    started.shutdown()
    started.server_close()
    thread.join(120)
