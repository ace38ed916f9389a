"""The version of an interface: which edits give it another one, and which leave it."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.model.partner_interfaces import find_interfaces_between
from archgen.views.agreement.interface_versions import hash_interface
from tests.agreeing import checked, view

ROBOT = """\
archgen: 1
ros:
  distro: jazzy
  definitions:
    m_msgs/msg/Stop: "uint8 RESUME=0\\nuint8 STOP=1\\nuint8 what\\nfloat32 after  # s\\nInner inner\\n"
    m_msgs/msg/Inner: "bool hard true\\n"
partners: {a: A, b: B, c: C}
groups:
  sense:
    owner: a
    components:
      eye:
        title: Eye
        functionality: Sees.
        outputs: {stop: {type: Stop, description: Stops at once.}, other: Stop}
  drive:
    owner: b
    components:
      base: {inputs: {stop: eye.stop}}
      more: {inputs: {other: eye.other}}
  look: {owner: c, components: {log: {inputs: {stop: {from: eye.stop, optional: true}}}}}
types: {Stop: {message: m_msgs/msg/Stop, size: 10 B}}
nodes:
  eye_node:
    implements: eye
    host: pc
    timing: {rate: 10 Hz, wcet: 5 ms}
    publishes: {stop: {topic: /stop, qos: {reliability: reliable}}, other: {topic: /other}}
  base_node: {implements: base, host: pc, timing: {wcet: 1 ms}, subscribes: {stop: {qos: {depth: 1}}}}
hosts: {pc: {cores: 2}}
"""


def versions(folder: Path, text: str) -> dict[str, str]:
    lookup = view(checked(folder, text))
    return {
        interface.topic_names[0]: hash_interface(lookup, interface)
        for interface in find_interfaces_between(lookup.architecture, "a", "b")
    }


@pytest.mark.parametrize(
    "edits",
    [
        [("title: Eye", "title: Oculus"), ("functionality: Sees.", "functionality: Sees a lot.")],
        [("eye:\n", "iris:\n"), ("eye.", "iris."), ("implements: eye", "implements: iris")],
        [("  eye_node:", "  renamed:")],
        [
            ("base: {inputs: {stop: eye.stop}}", "base: {inputs: {halt: eye.stop}}"),
            ("subscribes: {stop:", "subscribes: {halt:"),
        ],
        [("type: Stop,", "type: Halt,"), ("other: Stop", "other: Halt"), ("types: {Stop:", "types: {Halt:")],
        [("rate: 10 Hz, wcet: 5 ms", "period: 100 ms, wcet: 9 ms")],
        [("host: pc\n    timing", "timing")],
        [("optional: true", "optional: false")],
        [("Stops at once.", "Stops\n          at once.")],
        [("uint8 RESUME=0\\nuint8 STOP=1", "uint8 STOP=1\\nuint8 RESUME=0")],
        [("qos: {reliability: reliable}", "qos: default")],
        [("cores: 2", "cores: 1")],
        [("size: 10 B", "size: 0.01 kB")],
    ],
)
def test_titles_ids_order_and_hosts_are_no_part_of_a_version(tmp_path: Path, edits: list[tuple[str, str]]) -> None:
    text = ROBOT
    for old, new in edits:
        assert old in text
        text = text.replace(old, new)
    assert versions(tmp_path / "after", text) == versions(tmp_path / "before", ROBOT)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("topic: /stop", "topic: /halt"),
        ("RESUME=0\\nuint8 STOP=1", "RESUME=1\\nuint8 STOP=0"),
        ("uint8 what\\nfloat32 after", "float32 after\\nuint8 what"),
        ("  # s\\n", "  # ms\\n"),
        ("uint8 what", "uint16 what"),
        ("bool hard true", "bool hard false"),
        ("Stops at once.", "Resumes at once."),
        ("rate: 10 Hz", "rate: 5 Hz"),
        ("rate: 10 Hz,", "rate: 10 Hz, outputs: {stop: {conditional: true}},"),
        ("rate: 10 Hz,", "rate: 10 Hz, jitter: 1 ms,"),
        ("size: 10 B", "size: 20 B"),
        ("{reliability: reliable}", "{reliability: best_effort}"),
        (", qos: {reliability: reliable}", ""),
        ("{depth: 1}", "{depth: 2}"),
        ("message: m_msgs/msg/Stop", "message: m_msgs/msg/Inner"),
        ("base: {inputs: {stop: eye.stop}}", "base: {inputs: {stop: {from: eye.stop, freshness: 1 s}}}"),
    ],
)
def test_what_passes_and_what_is_promised_is_a_version(tmp_path: Path, old: str, new: str) -> None:
    assert old in ROBOT
    before = versions(tmp_path / "before", ROBOT)
    after = versions(tmp_path / "after", ROBOT.replace(old, new))
    assert before["/stop"] not in after.values()


def test_an_interface_has_its_own_version(tmp_path: Path) -> None:
    before = versions(tmp_path / "before", ROBOT)
    after = versions(tmp_path / "after", ROBOT.replace("topic: /stop", "topic: /halt"))
    assert before["/other"] == after["/other"]
    assert before["/other"] != before["/stop"]
