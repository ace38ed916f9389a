"""What is reported once is not reported again under another name, and stubs are no mistakes."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import check_project
from tests.judged_projects import check_text


def _rules(text: str) -> list[str]:
    return [f"{d.span.line} {d.rule}" for d in check_text(text) if d.severity is not Severity.NOTE]


def test_a_slip_in_a_reference_is_reported_once() -> None:
    text = """\
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      screen: {inputs: {image: camera.imgae}}
nodes:
  camera: {implements: camrea}
  screen: {implements: screen}
"""
    assert _rules(text) == ["5 unknown-reference", "7 unknown-reference"]


def test_an_ambiguous_reference_is_reported_once() -> None:
    text = """\
groups:
  left: {components: {camera: {outputs: {image: sensor_msgs/msg/Image}}}}
  right: {components: {camera: {outputs: {image: sensor_msgs/msg/Image}}}}
  other: {components: {screen: {inputs: {image: camera.image}}}}
nodes: {l: left.camera, r: right.camera, s: screen}
"""
    assert _rules(text) == ["4 ambiguous-reference"]


def test_a_slip_in_a_port_of_a_shared_component_is_reported_once() -> None:
    text = """\
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      screen: {inputs: {image: camera.image}}
nodes:
  driver: {implements: camera, publishes: {imgae: /image}}
  helper: {implements: camera, publishes: {}}
  screen: {implements: screen}
"""
    assert _rules(text) == ["7 unknown-reference"]


def test_a_slip_in_a_requirement_is_reported_once() -> None:
    text = """\
requirements: {R-10: The user sees}
groups: {sensing: {components: {camera: {title: Camera, requirements: [R-1O]}}}}
nodes: {camera: camera}
"""
    assert _rules(text) == ["2 unknown-requirement"]


def test_a_file_that_cannot_be_read_hides_no_finding_and_makes_none(tmp_path: Path) -> None:
    files = {
        "archgen.yaml": "archgen: 1\nsources: ['*.yaml']\nrequirements: {R-1: The user sees}\n",
        "a.yaml": "groups:\n  a: {components: {camera: {outputs: {image: sensor_msgs/msg/Image}, inputs: {light: }}}}\n",
        "b.yaml": "groups:\n  b: {components: {screen: {inputs: {image: camera.image}}}\nnodes: {camera: a.camera}\n",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    found = [
        f"{d.span.file}:{d.span.line} {d.rule}"
        for d in check_project(tmp_path).findings
        if d.severity is not Severity.NOTE
    ]
    assert found == ["a.yaml:2 unjustified-component", "a.yaml:2 unfed-input", "b.yaml:2 syntax-error"]


def test_what_could_not_be_read_is_not_missed() -> None:
    text = """\
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image, depth: sensor_msgs/msg/Image}}
      screen:
        inputs:
          image: {form: camera.image}
      display:
        input: {image: camera.image}
      panel:
        inputs: [camera.image]
      recorder: {inputs: {nothing: }}
nodes:
  camera: {implement: camera}
  screen: {implements: [screen, display, recorder]}
  panel: panel
"""
    assert _rules(text) == [
        "7 unknown-key",
        "9 unknown-key",
        "11 wrong-value",
        "12 unfed-input",
        "14 unknown-key",
    ]


def test_a_message_that_is_none_is_told_once() -> None:
    text = """\
groups: {g: {components: {c: {outputs: {o: {type: Image, external: Out}, p: {type: Plan, external: Out}}}}}}
nodes: {n: g.c}
types:
  Image: sensor_msgs.msg.Image
  Plan: {message: std_msgs/msg/Plan, status: plannd}
ros: {distro: noetic}
"""
    assert _rules(text) == ["4 wrong-value", "5 wrong-value"]


def test_a_project_of_stubs_has_no_errors_and_says_only_what_is_open() -> None:
    text = "groups: {sensing: {components: {camera: Camera, lidar: Laser}}, speech: Speech}\n"
    found = check_text(text)
    assert {d.severity for d in found} == {Severity.NOTE, Severity.WARNING}
    assert {d.rule for d in found} == {"missing-detail", "unmapped-component"}


_ROBOT = """\
partners: {certh: CERTH}
requirements:
  R-1: Sees
groups:
  sensing:
    owner: certh
    components:
      camera: {requirements: [R-1], outputs: {image: sensor_msgs/msg/Image}}
      screen: {requirements: [R-1], inputs: {image: camera.image}}
nodes:
  camera: {implements: camera, publishes: {image: {topic: /image, qos: sensor_data}}}
  screen: {implements: screen, subscribes: {image: {topic: /image, qos: sensor_data}}}
views: {eyes: {show: screen}}
policies: {no: {forbid: {from: screen, to: camera}}}
"""


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("groups:", "grups:", ["4 unknown-key"]),  # a whole section that is not read
        ("partners:", "parters:", ["1 unknown-key"]),
        ("implements: camera", "implements: sensing", ["11 unknown-reference"]),
        ("      camera:", "      Camera:", ["8 wrong-value"]),
        ("  R-1: Sees", "  R 1: Sees", ["3 wrong-value"]),
        ("{image: {topic", "{imag: {topic", ["11 unknown-reference"]),  # not the topic's reader as well
        ("camera.image}", "camera.imag}", ["9 unknown-reference"]),
        ("qos: sensor_data}}}\nviews", "qos: sensordata}}}\nviews", ["12 wrong-value"]),
        ("R-1: Sees", "R-1: {title: Sees}, x", ["3 syntax-error"]),
    ],
)
def test_one_slip_is_told_once(before: str, after: str, told: list[str]) -> None:
    assert before in _ROBOT
    assert _rules(_ROBOT) == []
    assert _rules(_ROBOT.replace(before, after, 1)) == told


def test_a_project_of_stubs_has_no_errors() -> None:
    text = """\
groups:
  a:
  b: Second
  c: {components: {x: , y: Y, z: {inputs: {i: , j: x, k: b}, outputs: {o: }}}}
nodes: {n1: , n2: x, n3: [x, y]}
types: {T1: , T2: std_msgs/Bool}
hosts: {h: }
containers: {k: }
links: {l: }
chains: {c1: , c2: [x, z]}
requirements: {R-1: }
use_cases: {U-1: }
partners: {p: }
"""
    assert [d for d in check_text(text) if d.severity is Severity.ERROR] == []
