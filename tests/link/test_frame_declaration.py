"""Frames as they are declared: of the project and of components, who writes them, and who else names them."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.architecture import Architecture

Linked = Callable[[str], tuple[Architecture, tuple[Diagnostic, ...]]]

ROBOT = """
groups:
  driving:
    components:
      drive: {outputs: {odometry: {type: Odometry, frame: odom}, twist: Robot pose}}
      localisation: {inputs: {odometry: {from: drive.odometry, frame: odom}}, frames: {odom: {parent: map, rate: 20 Hz}}}
  arm: {components: {drive: }}
frames:
  map: {title: The building}
  base_link: {parent: odom, by: driving.drive}
  laser: {parent: base_link, static: true}
  camera/optical.left: laser
types: {Robot pose: {message: geometry_msgs/msg/PoseStamped, frame: map}}
"""


def test_frames_of_the_project_come_first_and_a_component_writes_its_own(linked: Linked) -> None:
    architecture, found = linked(ROBOT)
    assert found == ()
    facts = {name: (frame.title, frame.parent, frame.by) for name, frame in architecture.frames.items()}
    assert facts == {
        "map": ("The building", None, None),
        "base_link": ("base_link", "odom", "driving.drive"),
        "laser": ("laser", "base_link", None),
        "camera/optical.left": ("camera/optical.left", "laser", None),
        "odom": ("odom", "map", "driving.localisation"),
    }
    frames = architecture.frames
    assert [str(frames["odom"].rate), frames["odom"].topic, frames["laser"].topic] == ["20 Hz", "/tf", "/tf_static"]
    assert (frames["odom"].component, frames["base_link"].component) == ("driving.localisation", None)
    assert (frames["base_link"].at.line, frames["base_link"].parent_at.column) == (10, 23)


def test_a_port_has_its_own_frame_or_that_of_its_type(linked: Linked) -> None:
    architecture, _ = linked(ROBOT)
    ports = {port.id: architecture.frame_of(port) for port in architecture.list_ports()}
    assert ports == {
        "driving.drive.odometry": "odom",
        "driving.drive.twist": "map",
        "driving.localisation.odometry": "odom",
    }


@pytest.mark.parametrize(
    ("holder", "by", "writer"),
    [
        ("g.a", "", ("component", "g.a")),
        ("g.a", "by: a", ("component", "g.a")),
        ("g.a", "by: b", ("component", "g.b")),
        ("h.c", "by: b", ("component", "h.b")),
        ("g.a", "by: h.b", ("component", "h.b")),
        ("", "by: a", ("component", "g.a")),
        ("", "by: publisher", ("node", "publisher")),
        ("", "", ("component", None)),
    ],
)
def test_who_writes_a_frame(linked: Linked, holder: str, by: str, writer: tuple[str, str | None]) -> None:
    """One's own group goes before others, and a component before the node of its name."""
    frames = f"frames: {{x: {{parent: root, {by}}}}}"
    components = {
        each: f"{{title: T, {frames}}}" if each == holder else "{title: T}" for each in ("g.a", "g.b", "h.b", "h.c")
    }
    architecture, found = linked(f"""
groups:
  g: {{components: {{a: {components["g.a"]}, b: {components["g.b"]}}}}}
  h: {{components: {{b: {components["h.b"]}, c: {components["h.c"]}}}}}
nodes: {{a: {{implements: g.a}}, publisher: {{package: p}}}}
{frames if not holder else ""}
""")
    assert found == ()
    frame = architecture.frames["x"]
    assert (frame.by_kind, frame.by) == writer


def test_what_cannot_be_read_leaves_the_frame(linked: Linked) -> None:
    architecture, found = linked(
        "frames: {a: {parent: b, by: nobody, rate: 0 Hz}, c: {parent: a, static: true, rate: 1 Hz}}"
    )
    assert [diagnostic.rule for diagnostic in found] == ["unknown-reference", "wrong-value", "wrong-value"]
    frames = architecture.frames
    assert (frames["a"].by, frames["a"].by_written, frames["a"].rate) == (None, True, None)
    assert (frames["c"].static, frames["c"].rate) == (True, None)
