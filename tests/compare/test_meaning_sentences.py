"""What changes mean to readers of an output, from two short texts."""

from __future__ import annotations

import pytest

from archgen.compare.element_sentences import is_read_by_others
from tests.compare.conftest import Compared, Told

ROBOT = """\
partners: {vega: The Vega, orsa: The Orsa}
groups:
  eyes:
    owner: vega
    components:
      finder:
        timing: {rate: 10 Hz, wcet: 5 ms}
        outputs: {people: {type: People, description: Distances in metres}, rows: {type: Rows, description: Left first}}
      counter: {inputs: {rows: finder.rows}}
  legs:
    owner: orsa
    components:
      driver: {inputs: {people: finder.people}, outputs: {speed: Speed}}
      brake: {inputs: {people: finder.people}, outputs: {force: Force}}
types: {People: m_msgs/msg/People, Rows: nav_msgs/msg/Path, Speed: geometry_msgs/msg/Twist, Force: std_msgs/msg/Float64}
ros: {definitions: {m_msgs/msg/People: "m_msgs/Person[] all", m_msgs/msg/Person: "float32 x", m_msgs/msg/Crowd: "m_msgs/Person[] all\\nint8 count"}}
chains: {see: {through: [finder, driver], deadline: 200 ms, requirements: [R-1]}}
requirements: {R-1: Stops}
"""


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (
            "timing: {rate",
            "timing: {outputs: {people: {conditional: true}}, rate",
            "`eyes.finder.people` is sent only when there is something to say; read by `legs.brake.people` and `legs.driver.people` of The Orsa",
        ),
        (
            "timing: {rate",
            "timing: {outputs: {rows: {max_gap: 1 s}}, rate",
            "`eyes.finder.rows`: largest gap set to `1 s`; read by `eyes.counter.rows` of The Vega",
        ),
        (
            "in metres",
            "in millimetres",
            "`eyes.finder.people`: description `Distances in metres` → `Distances in millimetres`; read by `legs.brake.people` and `legs.driver.people` of The Orsa",
        ),
        (
            "float32 x",
            "float64 x",
            "message `m_msgs/msg/Person`: `x` is `float64` instead of `float32`; it is inside of `m_msgs/msg/Crowd` and `m_msgs/msg/People`, which `eyes.finder.people` carries",
        ),
        (
            "{People: m_msgs/msg/People",
            "{People: m_msgs/msg/Crowd",
            "type `People` now is `m_msgs/msg/Crowd` instead of `m_msgs/msg/People`; `eyes.finder.people` carries it; of its fields `count` is new",
        ),
        (
            "deadline: 200 ms",
            "deadline: 300 ms",
            "chain `see` now must end within `300 ms` instead of `200 ms`; a weaker promise to `R-1` than before",
        ),
        (
            "deadline: 200 ms, ",
            "",
            "chain `see`: deadline no longer given (it was `200 ms`); nothing is promised to `R-1` any more",
        ),
        (
            "deadline: 200 ms",
            "deadline: {always: 200 ms, 95 %: 100 ms}",
            "chain `see`: deadline 95 % set to `100 ms`",
        ),
        ("deadline: 200 ms", "deadline: 100 ms", "chain `see` now must end within `100 ms` instead of `200 ms`"),
        (
            "driver: {inputs: {people: finder.people}",
            "driver: {inputs: {}",
            "input `legs.driver.people` is removed; it read `eyes.finder.people`; `eyes.finder.people` of The Vega has no effect on `legs.driver` any more",
        ),
        (
            "counter: {inputs: {rows: finder.rows}}",
            "counter: {}",
            "input `eyes.counter.rows` is removed; `eyes.finder.rows` is no longer read by anybody",
        ),
    ],
)
def test_a_sentence_says_what_it_means_to_others(compared: Compared, old: str, new: str, text: str) -> None:
    assert old in ROBOT
    assert text in [change.text for change in compared(ROBOT, ROBOT.replace(old, new)).changes]


def test_an_output_that_is_sent_each_time_again(told: Told) -> None:
    before = ROBOT.replace("timing: {rate", "timing: {outputs: {people: {conditional: true, max_gap: 1 s}}, rate")
    readers = "read by `legs.brake.people` and `legs.driver.people` of The Orsa"
    assert [line.partition(": ")[2] for line in told(before, ROBOT)] == [
        f"`eyes.finder.people` is sent each time now, and not only when there is something to say; {readers}",
        f"`eyes.finder.people`: largest gap no longer promised (it was `1 s`); {readers}",
    ]


def test_who_is_another_reader(compared: Compared) -> None:
    versions = compared(ROBOT, ROBOT).versions
    assert is_read_by_others("eyes.finder.people", versions)
    assert not is_read_by_others("eyes.finder.rows", versions)
    assert not is_read_by_others("legs.driver.speed", versions)


def test_a_reader_never_read_what_only_has_another_name(compared: Compared) -> None:
    after = ROBOT.replace("people: {type: People", "persons: {type: People")
    after = after.replace(
        "driver: {inputs: {people: finder.people}", "driver: {inputs: {people: {from: finder.persons}}"
    )
    texts = [change.text for change in compared(ROBOT, after).changes]
    assert any("`eyes.finder.people` is called `persons` now" in text for text in texts)
    assert not any("no longer reads `eyes.finder.persons`" in text for text in texts)


def test_a_field_of_an_answer_is_named_with_its_part(told: Told) -> None:
    before = """\
groups: {g: {components: {a: {outputs: {serve: Ask}}, b: {inputs: {ask: a.serve}}}}}
types: {Ask: m_msgs/srv/Old}
ros: {definitions: {m_msgs/srv/Old: "int8 x\\n---\\nint8 x", m_msgs/srv/New: "int8 x\\n---\\nint16 x"}}
"""
    after = before.replace("Ask: m_msgs/srv/Old", "Ask: m_msgs/srv/New")
    (line,) = told(before, after)
    assert line.endswith("`g.a.serve` carries it; of its fields `x of part 2` is `int16` instead of `int8`")
