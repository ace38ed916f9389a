"""The version of an interface: which edits give it another one, and which leave it."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.model.partner_interfaces import find_interfaces_between
from archgen.views.agreement.output_promises import hash_interface
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


EARLIER = """\
archgen: 1
project: {id: signed, title: Signed}
ros:
  distro: jazzy
  definitions: {m_msgs/msg/Stop: "# Why it stops.\\nstd_msgs/Header header  # when\\nuint8 why  # a number\\n"}
partners: {a: A, b: B}
groups:
  sense:
    owner: a
    components:
      guard: {outputs: {safety: {type: Stop, description: Stops at once.}}}
      eye: {outputs: {rows: {type: Rows, promise: {rate: 5 Hz, max_age: 1 s}}}}
      old: {outputs: {odd: Rows}}
      plain: {outputs: {calm: Stop}}
  drive:
    owner: b
    components:
      base: {inputs: {safety: guard.safety, rows: {from: eye.rows, freshness: 2 s}, odd: old.odd, calm: plain.calm}}
types: {Stop: m_msgs/msg/Stop, Rows: {message: std_msgs/msg/Float64, size: 8 B}}
hosts: {pc: {cores: 2}}
nodes:
  guard:
    implements: guard
    host: pc
    timing: {rate: 10 Hz, outputs: {safety: {conditional: true, max_gap: 1 s}}}
    publishes: {safety: {topic: /safety, qos: {reliability: reliable, durability: transient_local, depth: 1}}}
    remaps: {/safety: /safety_raw}
    parameters: {qos_overrides: {/safety_raw: {publisher: {durability: volatile}}}}
  eye: {implements: eye, host: pc, start: {environment: {ROS_DOMAIN_ID: "42"}}, timing: {rate: 5 Hz}, publishes: {rows: {topic: rows}}}
  old: {implements: old, status: existing, host: pc, parameters: {use_sim_time: true}}
  plain: {implements: plain, host: pc, publishes: {calm: {topic: /calm, qos: {depth: 3}}}}
  base: {implements: base, host: pc, subscribes: {safety: {qos: {depth: 1}}}}
"""
EARLIER_VERSIONS = {
    "sense.guard.safety": "bc5d93",
    "sense.eye.rows": "5d44ef",
    "sense.old.odd": "d788cc",
    "sense.plain.calm": "247c08",
}
"""What the release before the launch had a say wrote into agreements: these digits were signed, and never change."""


def test_what_was_signed_reads_the_same_for_ever(tmp_path: Path) -> None:
    lookup = view(checked(tmp_path, EARLIER))
    interfaces = find_interfaces_between(lookup.architecture, "a", "b")
    assert {each.key: hash_interface(lookup, each, rules=1) for each in interfaces} == EARLIER_VERSIONS


def test_only_what_the_launch_changes_has_other_digits_now(tmp_path: Path) -> None:
    lookup = view(checked(tmp_path, EARLIER))
    now = {each.key: hash_interface(lookup, each) for each in find_interfaces_between(lookup.architecture, "a", "b")}
    # `plain` alone has no remap, no override, no domain and no simulated time.
    assert [key for key, version in EARLIER_VERSIONS.items() if now[key] != version] == [
        "sense.guard.safety",
        "sense.eye.rows",
        "sense.old.odd",
    ]
