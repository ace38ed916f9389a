"""What category a loss has, and ways round the gate that are none: one table, each row a robot and what is replaced in it."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.property_sizes import try_some

ROBOT = """\
project: {id: robot}
review: {breaking: {promise: warning}}
partners: {vega: Vega, kite: Kite, orsa: Orsa}
ros:
  distro: jazzy
  definitions:
    m_msgs/msg/Persons: |
      float32 offset  # m, +x to the left, steps of 1.0
      uint8 count
    m_msgs/msg/Rows: float32 left
types:
  Persons: {message: m_msgs/msg/Persons, size: 10 kB, comment: "at most 20 persons, in metres"}
  Rows: m_msgs/msg/Rows
groups:
  sense:
    owner: vega
    components:
      eye:
        functionality: Finds persons and rows, in metres from the robot.
        timing: {behaviour: periodic, rate: 10 Hz, jitter: 1 ms}
        outputs:
          persons: {type: Persons, description: Persons in the frame base_link}
          rows: {type: Rows, description: "Rows, offsets in metres"}
  drive:
    owner: kite
    components:
      guard: {inputs: {persons: eye.persons}}
  nav:
    owner: orsa
    components:
      plan: {inputs: {rows: eye.rows}}
nodes:
  eye: {implements: eye, publishes: {persons: {topic: /persons}, rows: {topic: /rows}}}
  guard: {implements: guard}
  plan: {implements: plan}
"""
NO_NODES = ROBOT[: ROBOT.index("nodes:")]
ROWS = '          rows: {type: Rows, description: "Rows, offsets in metres"}\n'
LINE = """\
      row_eye:
        timing: {behaviour: periodic, rate: 10 Hz, jitter: 1 ms}
        outputs: {rows: {type: Rows, description: "Rows, offsets in metres"}}
  drive:
"""
SPLIT = [
    (ROWS, ""),
    ("  drive:\n", LINE),
    (", rows: {topic: /rows}}}", "}}\n  row_eye: {implements: row_eye, publishes: {rows: {topic: /rows}}}"),
]
FOLLOWED = ("rows: eye.rows", "rows: row_eye.rows")
TIMED, ROWS_TIMED = "behaviour: periodic, rate: 10 Hz", "      row_eye:\n        timing: {"
ROWS_READ = "`nav.plan.rows` of Orsa reads it"
BOTH_READ = "`drive.guard.persons` of Kite and `nav.plan.rows` of Orsa read them"
PROMISE = "promises for `sense.eye.persons` and `sense.eye.rows` "
SOURCE = "source orsa: renames what Orsa reads: `sense.eye.rows` is `sense.row_eye.rows` now; "
HEIR = SOURCE + "files follow in this change"
TAKEN = "wire orsa: takes `sense.eye.rows` from Orsa (`nav.plan.rows`); it is to read `sense.row_eye.rows` instead"


def everybody(why: str, category: str = "promise") -> list[str]:
    """Give one line for each of both readers."""
    return [f"{category} {partner}: {why}" for partner in ("kite", "orsa")]


SPLITS = {
    "a split on the same wire": ([*SPLIT, FOLLOWED], [HEIR]),
    "a split that the reader does not follow": (SPLIT, [f"{SOURCE}`nav.plan.rows` has to follow"]),
    "a split with a slower part": (
        [*SPLIT, FOLLOWED, (ROWS_TIMED + TIMED, ROWS_TIMED + "behaviour: periodic, rate: 3 Hz")],
        [f"promise orsa: promises for `sense.eye.rows` 3 Hz instead of 10 Hz; {ROWS_READ}", HEIR],
    ),
    "a split with a part that is sent on condition": (
        [*SPLIT, FOLLOWED, (ROWS_TIMED, ROWS_TIMED + "outputs: {rows: {conditional: true}}, ")],
        [
            f"promise orsa: promises for `sense.eye.rows` messages only on condition, no longer at each run; {ROWS_READ}",
            HEIR,
        ],
    ),
    "a split with a part that says something else": (
        [*SPLIT, FOLLOWED, ("offsets in metres", "offsets in feet")],
        [
            f"meaning orsa: says of `sense.eye.rows` `Rows, offsets in feet` instead of `Rows, offsets in metres`; {ROWS_READ}",
            HEIR,
        ],
    ),
    "a split that loses quality of service": (
        [*SPLIT, FOLLOWED, ("row_eye, publishes: {rows: {topic: /rows", "row_eye, publishes: {rows: {qos: sensor_data, topic: /rows")],
        [TAKEN],
    ),
    "a split with another topic": (
        [*SPLIT, FOLLOWED, ("row_eye, publishes: {rows: {topic: /rows", "row_eye, publishes: {rows: {topic: /lines")],
        [TAKEN],
    ),
    "a split with a part that is only planned": (
        [*SPLIT, FOLLOWED, ("{implements: row_eye", "{status: planned, implements: row_eye")],
        [TAKEN],
    ),
    "a split with another type": ([*SPLIT, FOLLOWED, ("{rows: {type: Rows", "{rows: {type: Lines")], [TAKEN]),
    "an output that moves to a topic which another one had": (
        [*SPLIT[::2], ("implements: row_eye, publishes: {rows: {topic: /rows}}", "implements: guard"), ("rows: eye.rows", "rows: eye.persons")],
        ["wire orsa: takes `sense.eye.rows` from Orsa (`nav.plan.rows`); it is to read `sense.eye.persons` instead"],
    ),
}  # fmt: skip
PROMISES = {
    "a lower rate": ([("10 Hz", "5 Hz")], everybody(f"{PROMISE}5 Hz instead of 10 Hz; {BOTH_READ}")),
    "a longer period": (
        [("rate: 10 Hz", "period: 200 ms")],
        everybody(f"{PROMISE}5 Hz instead of 10 Hz; {BOTH_READ}"),
    ),
    "a lower rate at the node": (
        [("timing: {" + TIMED + ", jitter: 1 ms}", "role: source"), ("eye: {impl", "eye: {timing: {" + TIMED.replace("10", "5") + "}, impl")],
        everybody(f"{PROMISE}5 Hz instead of 10 Hz; {BOTH_READ}"),
    ),
    "a rate that is no longer written": (
        [(TIMED, "behaviour: event")],
        everybody(f"{PROMISE}no rate any more (it was 10 Hz); {BOTH_READ}"),
    ),
    "a rate that is none": (
        [("behaviour: periodic", "behaviour: once")],
        everybody(f"{PROMISE}no steady rate any more, but messages when something makes it run; {BOTH_READ}"),
    ),
    "an output on condition": (
        [("jitter: 1 ms", "outputs: {rows: {conditional: true}}")],
        [f"promise orsa: promises for `sense.eye.rows` messages only on condition, no longer at each run; {ROWS_READ}"],
    ),
    "an output on condition at the node": (
        [("eye: {impl", "eye: {timing: {outputs: {rows: {conditional: true}}}, impl")],
        [f"promise orsa: promises for `sense.eye.rows` messages only on condition, no longer at each run; {ROWS_READ}"],
    ),
    "an output on condition while its component changes hands": (
        [("owner: vega", "owner: kite"), ("jitter: 1 ms", "outputs: {persons: {conditional: true}}")],
        ["promise kite: promises for `sense.eye.persons` messages only on condition, no longer at each run; `drive.guard.persons` of Kite reads it"],
    ),
    "a gap that leaves runs out": (
        [("jitter: 1 ms", "outputs: {rows: {max_gap: 10 s}}")],
        [f"promise orsa: promises for `sense.eye.rows` gaps of 10 s instead of 200 ms; {ROWS_READ}"],
    ),
    "fewer runs": ([("jitter: 1 ms", "throttle: 1 s")], everybody(f"{PROMISE}at most a message in 1000 ms; {BOTH_READ}")),
    "fewer arrivals": ([("jitter: 1 ms", "every: 3")], everybody(f"{PROMISE}a message for 3 arrivals instead of 1; {BOTH_READ}")),
    "a larger jitter": (
        [("jitter: 1 ms", "jitter: 90 ms")],
        everybody(f"{PROMISE}a jitter of 90 ms instead of 1 ms; {BOTH_READ}"),
    ),
    "larger messages": ([("10 kB", "1 MB")], ["promise kite: promises for `Persons` 1 MB instead of 10 kB; Kite uses it"]),
    "messages of no known size": (
        [("size: 10 kB, ", "")],
        ["promise kite: promises for `Persons` no size any more (it was 10 kB); Kite uses it"],
    ),
}  # fmt: skip
OFFSET = "meaning kite: says of `offset` in `m_msgs/msg/Persons` "
MEANINGS = {
    "a description": (
        [("Rows, offsets in metres", "Rows, offsets in millimetres")],
        [f"meaning orsa: says of `sense.eye.rows` `Rows, offsets in millimetres` instead of `Rows, offsets in metres`; {ROWS_READ}"],
    ),
    "a description that is gone": (
        [(', description: "Rows, offsets in metres"', "")],
        [f"meaning orsa: says of `sense.eye.rows` no longer `Rows, offsets in metres`; {ROWS_READ}"],
    ),
    "a unit in the text of the component": (
        [("in metres from", "in feet from")],
        everybody(
            "says of `sense.eye` `… and rows, in feet from the robot.` instead of `… and rows, in metres from the robot.`; "
            "`drive.guard.persons` of Kite and `nav.plan.rows` of Orsa read it",
            "meaning",
        ),
    ),
    "the comment of a type": (
        [("at most 20 persons, in metres", "at most 5 persons")],
        ["meaning kite: says of `Persons` `at most 5 persons` instead of `at most 20 persons, in metres`; Kite uses it"],
    ),
    "the unit of a field": (
        [("# m,", "# mm,")],
        [f"{OFFSET}`mm, +x to the left, steps of 1.0` instead of `m, +x to the left, steps of 1.0`; Kite uses it"],
    ),
    "the sign of a field": (
        [("+x", "-x")],
        [f"{OFFSET}`m, -x to the left, steps of 1.0` instead of `m, +x to the left, steps of 1.0`; Kite uses it"],
    ),
    "a decimal point": (
        [("1.0", "10")],
        [f"{OFFSET}`… left, steps of 10` instead of `… left, steps of 1.0`; Kite uses it"],
    ),
    "a comment that moves to another field": (
        [("  # m, +x to the left, steps of 1.0\n      uint8 count", "\n      uint8 count  # m, +x to the left, steps of 1.0")],
        [f"{OFFSET}no longer `m, +x to the left, steps of 1.0`; Kite uses it"],
    ),
    "a type with a unit in its name": (
        [("Rows: m_msgs", "Rows in mm: m_msgs"), ("type: Rows", "type: Rows in mm")],
        ["meaning orsa: calls `Rows in mm` what was `Rows`; Orsa uses it"],
    ),
}  # fmt: skip
NODES_BUILT = "asks for {} instead of jazzy, for which `guard` of Kite, `plan` of Orsa and `eye` of Vega are built"
WIRES = {
    "another distribution": (
        [("jazzy", "humble")],
        [f"wire {partner}: {NODES_BUILT.format('humble')}" for partner in ("kite", "orsa", "vega")],
    ),
    "no distribution": (
        [("  distro: jazzy\n", "")],
        [f"wire {partner}: {NODES_BUILT.format('no named distribution')}" for partner in ("kite", "orsa", "vega")],
    ),
    "a message of another name": (
        [("m_msgs/msg/Rows", "m_msgs/msg/Lines")],
        ["wire orsa: gives `m_msgs/msg/Lines` instead of `m_msgs/msg/Rows` (by another name it is another message to ROS) as `sense.eye.rows`; `nav.plan.rows` of Orsa reads it"],
    ),
    "a publisher that is only planned now": (
        [("eye: {impl", "eye: {status: planned, impl")],
        [
            "wire kite: takes the topic `/persons` from Kite (`guard`); nobody offers it under that name any more",
            "wire orsa: takes the topic `/rows` from Orsa (`plan`); nobody offers it under that name any more",
        ],
    ),
    "a planned publisher in the place of one that is there": (
        [("  eye: {impl", "  fresh: {status: planned, package: other, executable: one, impl")],
        [
            "wire kite: takes the topic `/persons` from Kite (`guard`); nobody offers it under that name any more",
            "wire orsa: takes the topic `/rows` from Orsa (`plan`); nobody offers it under that name any more",
        ],
    ),
    "topics that change places": (
        [("{persons: {topic: /persons}, rows: {topic: /rows}}", "{persons: {topic: /rows}, rows: {topic: /persons}}")],
        [
            "wire kite: takes the topic `/persons` from Kite (`guard`); it is `/rows` now",
            "wire orsa: takes the topic `/rows` from Orsa (`plan`); it is `/persons` now",
        ],
    ),
}  # fmt: skip
HARMLESS = {
    "punctuation and capitals": [("Rows, offsets in metres", "rows; offsets in  metres."), ("# m, +x", "# [m] +x")],
    "other words for what a component does": [("Finds persons and rows", "Looks for all persons and rows")],
    "a higher rate": [("10 Hz", "20 Hz")],
    "the same rate as a period": [("rate: 10 Hz", "period: 100 ms")],
    "the same rate at the node": [
        ("timing: {" + TIMED + ", jitter: 1 ms}", "role: source"),
        ("eye: {impl", "eye: {timing: {" + TIMED + ", jitter: 1 ms}, impl"),
    ],
    "a gap that a run may have": [("jitter: 1 ms", "jitter: 1 ms, outputs: {rows: {max_gap: 130 ms}}")],
    "a second publisher": [
        ("  guard: {", "  eye2: {implements: eye, timing: {rate: 1 Hz}, publishes: {rows: {topic: /rows}}}\n  guard: {")
    ],
    "smaller messages": [("10 kB", "9 kB")],
    "a first comment": [("uint8 count", "uint8 count  # at most 20")],
    "an output more": [(ROWS, ROWS + "          spare: {type: Rows, description: in mm}\n")],
    "a node of another name": [("  eye: {impl", "  camera_eye: {impl")],
}
TABLE = SPLITS | PROMISES | MEANINGS | WIRES | {name: (edits, []) for name, edits in HARMLESS.items()}


def losses(compared: Compared, before: str, edits: list[tuple[str, str]]) -> list[str]:
    """Edit a robot, and give who loses what: `category partner: why`."""
    after = before
    for old, new in edits:
        assert old in after, old
        after = after.replace(old, new)
    return [
        f"{each.category} {each.partner}: {each.reason}"
        for change in compared(before, after).changes
        for each in change.breaks
    ]


@pytest.mark.parametrize(("edits", "expected"), try_some(TABLE.values(), 25), ids=TABLE.keys())
def test_what_a_loss_is_called(compared: Compared, edits: list[tuple[str, str]], expected: list[str]) -> None:
    assert losses(compared, ROBOT, edits) == expected


def test_without_nodes_the_name_says_what_is_on_the_same_wire(compared: Compared) -> None:
    assert losses(compared, NO_NODES, [*SPLIT[:2], FOLLOWED]) == [HEIR]
    lines = [*SPLIT[:2], ("outputs: {rows:", "outputs: {lines:"), ("rows: eye.rows", "rows: row_eye.lines")]
    assert losses(compared, NO_NODES, lines) == [TAKEN.replace("row_eye.rows", "row_eye.lines")]
    physical = [("{type: Rows, d", "{type: Rows, medium: physical, external: Field, d")]
    assert losses(compared, NO_NODES, physical) == [
        "wire orsa: gives a physical quantity instead of a message as `sense.eye.rows`; `nav.plan.rows` of Orsa reads it"
    ]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (None, "mqtt", "data over MQTT instead of a message"),
        ("mqtt", "rest", "data over REST instead of data over MQTT"),
        ("mqtt", None, "a message instead of data over MQTT"),
        ("memory", "file", "data in a file instead of data in memory"),
        ("mqtt", "MQTT", ""),
        (None, "digital", ""),
        (None, "ros", ""),
    ],
)
def test_another_medium_is_another_wire(compared: Compared, old: str | None, new: str | None, said: str) -> None:
    rows = "{type: Rows, d"
    written = [rows if word is None else f"{{type: Rows, medium: {word}, d" for word in (old, new)]
    before = NO_NODES.replace(rows, written[0])
    assert losses(compared, before, [(written[0], written[1])]) == (
        [f"wire orsa: gives {said} as `sense.eye.rows`; `nav.plan.rows` of Orsa reads it"] if said else []
    )


def test_another_middleware_is_another_wire_of_what_says_nothing(compared: Compared) -> None:
    before = NO_NODES.replace("{type: Persons, d", "{type: Persons, medium: mqtt, d")
    edits = [("{id: robot}", "{id: robot, middleware: orocos}")]
    assert losses(compared, before, edits) == [
        "wire orsa: gives data over Orocos instead of a message as `sense.eye.rows`; `nav.plan.rows` of Orsa reads it"
    ]


def test_what_was_weak_before_is_no_weaker(compared: Compared) -> None:
    weak = ROBOT.replace("jitter: 1 ms", "outputs: {rows: {conditional: true, max_gap: 1 s}}")
    assert losses(compared, weak, [("outputs: {rows: {conditional: true, max_gap: 1 s}}", "jitter: 1 ms")]) == []
    assert losses(compared, weak, [("max_gap: 1 s", "max_gap: 500 ms")]) == []
    gone = f"promise orsa: promises for `sense.eye.rows` no longest gap any more (it was 1000 ms); {ROWS_READ}"
    assert losses(compared, weak, [(", max_gap: 1 s", "")]) == [gone]
    planned = ROBOT.replace("eye: {impl", "eye: {status: planned, impl")
    assert losses(compared, planned, [("status: planned, ", "")]) == []
    assert losses(compared, planned, [*SPLIT, FOLLOWED]) == [HEIR]
    undocumented = ROBOT.replace(', description: "Rows, offsets in metres"', "")
    assert losses(compared, undocumented, [("{type: Rows}", "{type: Rows, description: in mm}")]) == []
    plain = ROBOT.replace("  distro: jazzy\n", "")
    assert losses(compared, plain, [("ros:\n", "ros:\n  distro: jazzy\n")]) == []


UNGUARDED = ROBOT.replace("review: {breaking: {promise: warning}}", "review: {breaking: error}")


@pytest.mark.parametrize(
    "edit",
    [
        ("rate: 10 Hz", "rate: 5 Hz"),
        ("jitter: 1 ms", "jitter: 90 ms"),
        ("jitter: 1 ms", "throttle: 1 s"),
        ("jitter: 1 ms", "every: 3"),
        ("10 kB", "1 MB"),
    ],
)
def test_a_margin_is_guarded_where_promises_have_a_severity_of_their_own(
    compared: Compared, edit: tuple[str, str]
) -> None:
    """All that is asked is still kept: a policy that is one word does not say that less of it is a loss."""
    assert losses(compared, UNGUARDED, [edit]) == []
    assert losses(compared, UNGUARDED, [edit, ("breaking: error", "breaking: {promise: note}")]) != []


@pytest.mark.parametrize(("asked", "breaks"), [("50 ms", False), ("100 ms", True), ("199 ms", True), ("200 ms", False)])
def test_a_rate_below_what_a_subscription_asks_for_breaks_under_every_policy(
    compared: Compared, asked: str, breaks: object
) -> None:
    """From 10 Hz to 5 Hz: what was asked for more often than that was not kept before either."""
    asking = UNGUARDED.replace(
        "plan: {implements: plan}",
        f"plan: {{implements: plan, subscribes: {{rows: {{topic: /rows, qos: {{deadline: {asked}}}}}}}}}",
    )
    lost = f"promise orsa: promises for `sense.eye.rows` 5 Hz instead of 10 Hz; {ROWS_READ}"
    assert losses(compared, asking, [("rate: 10 Hz", "rate: 5 Hz")]) == ([lost] if breaks else [])


def test_what_a_subscription_asks_of_another_output_does_not_count(compared: Compared) -> None:
    asking = UNGUARDED
    for old, new in (
        ("guard: {inputs: {persons: eye.persons}}", "guard: {timing: {rate: 10 Hz}, outputs: {stop: Rows}}"),
        ("plan: {inputs: {rows: eye.rows}}", "plan: {inputs: {rows: eye.rows, stop: guard.stop}}"),
        ("plan: {implements: plan}", "plan: {implements: plan, subscribes: {stop: {qos: {deadline: 150 ms}}}}"),
    ):
        assert old in asking
        asking = asking.replace(old, new)
    lost = "promise orsa: promises for `drive.guard.stop` 5 Hz instead of 10 Hz; `nav.plan.stop` of Orsa reads it"
    assert losses(compared, asking, [("timing: {rate: 10 Hz}", "timing: {rate: 5 Hz}")]) == [lost]
    assert losses(compared, asking, [("periodic, rate: 10 Hz", "periodic, rate: 5 Hz")]) == []


def test_what_is_no_margin_breaks_under_every_policy(compared: Compared) -> None:
    for edit in (("jitter: 1 ms", "outputs: {rows: {conditional: true}}"), ("behaviour: periodic, rate: 10 Hz, ", "")):
        assert losses(compared, UNGUARDED, [edit]) != []


def test_nobody_is_broken_in_a_robot_of_one_partner(compared: Compared) -> None:
    own = ROBOT.replace("owner: kite", "owner: vega").replace("owner: orsa", "owner: vega")
    edits = [("jazzy", "humble"), ("10 Hz", "1 Hz"), ("in metres", "in feet"), ("10 kB", "1 MB"), ("# m,", "# mm,")]
    assert losses(compared, own, edits) == []


def test_another_distribution_breaks_from_two_partners_on(compared: Compared) -> None:
    without_plan = ROBOT.replace("  plan: {implements: plan}\n", "")
    reason = "asks for humble instead of jazzy, for which `guard` of Kite and `eye` of Vega are built"
    assert losses(compared, without_plan, [("jazzy", "humble")]) == [
        f"wire {name}: {reason}" for name in ("kite", "vega")
    ]


def test_a_frame_that_a_node_is_told_counts_as_meaning(compared: Compared) -> None:
    told = ROBOT.replace("eye: {impl", "eye: {parameters: {camera_frame: base_link, gain: 3}, impl")
    read = "`drive.guard.persons` of Kite and `nav.plan.rows` of Orsa read what it sends"
    assert losses(compared, told, [("base_link, gain", "map, gain")]) == everybody(
        f"sets `camera_frame` of `eye` to `map` instead of `base_link`; {read}", "meaning"
    )
    assert losses(compared, told, [("camera_frame: base_link, ", "")]) == everybody(
        f"sets `camera_frame` of `eye` to nothing instead of `base_link`; {read}", "meaning"
    )
    assert losses(compared, told, [("gain: 3", "gain: 4, other_frame: map")]) == []


def test_hostile_words_stay_inside_their_ticks(compared: Compared) -> None:
    evil = r"'` {} <b>[y](z) # ` {0}'"
    (line,) = losses(compared, ROBOT, [('"Rows, offsets in metres"', evil)])
    assert line == (
        "meaning orsa: says of `sense.eye.rows` `' {} <b>[y](z) # ' {0}` instead of `Rows, offsets in metres`; "
        f"{ROWS_READ}"
    )
