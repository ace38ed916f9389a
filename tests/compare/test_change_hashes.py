"""The hash that an acceptance carries: of what is written, and of nothing that follows from it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from archgen.compare.agreements import hash_change, hash_fallen_limit, hash_values
from archgen.compare.comparison import Comparison
from tests.compare.conftest import Compared

ROBOT = """\
partners: {a: A, b: B}
groups:
  see:
    owner: a
    components: {eye: {outputs: {rows: Rows}}}
  act: {owner: b, components: {base: {inputs: {rows: eye.rows}}}}
types: {Rows: {fields: {pace: float32}}}
nodes: {eye: {implements: eye, timing: {rate: 10 Hz, wcet: 5 ms}}}
"""


def hash_of(comparison: Comparison, element: str) -> str:
    """Give the hash of the only change of an element."""
    (change,) = (change for change in comparison.changes if change.element_id == element)
    return hash_change(change, comparison.versions)


def test_a_hash_is_that_of_canonical_json() -> None:
    assert hash_values(["a", None, {"y": 1, "x": 2}]) == hash_values(["a", None, {"x": 2, "y": 1}])
    assert len(hash_values([])) == 6


@pytest.mark.parametrize(
    ("element", "first", "second"),
    [
        (
            "robot_msgs/msg/Rows",
            ("pace: float32", "pace: float32, b: float32"),
            ("pace: float32", "speed: float32"),
        ),
        ("see.eye.rows", ("rows: Rows", "rows: Bytes"), ("rows: Rows", "rows: Words")),
        (
            "see.new",
            ("rows: Rows}}}\n", "rows: Rows}}, new: {outputs: {x: Rows}}}\n"),
            ("rows: Rows}}}\n", "rows: Rows}}, new: {outputs: {x: Other}}}\n"),
        ),
    ],
)
def test_another_change_of_the_same_key_has_another_hash(
    compared: Compared, element: str, first: tuple[str, str], second: tuple[str, str]
) -> None:
    one, same, other = (hash_of(compared(ROBOT, ROBOT.replace(*edit)), element) for edit in (first, first, second))
    assert (one == same, one == other) == (True, False)


def test_what_is_derived_makes_no_other_hash(compared: Compared) -> None:
    alone = compared(ROBOT, ROBOT.replace("rate: 10 Hz", "rate: 5 Hz"))
    busy = ROBOT + "hosts: {pc: {cores: 1}}\n"
    beside = compared(busy, busy.replace("rate: 10 Hz", "rate: 5 Hz"))
    assert hash_of(alone, "see.eye") == hash_of(beside, "see.eye")


def test_the_hash_of_a_fallen_promise_is_that_of_its_limit_and_causes(compared: Compared) -> None:
    comparison = compared(ROBOT, ROBOT.replace("rate: 10 Hz", "rate: 5 Hz"))
    (change,) = comparison.changes
    hashes = {
        hash_fallen_limit("see.eye.rows", key, limit, causes, comparison.versions)
        for key, limit, causes in (
            ("max_gap", "130 ms", [change]),
            ("max_gap", "140 ms", [change]),
            ("max_age", "130 ms", [change]),
            ("max_gap", "130 ms", [replace(change, after="4 Hz")]),
            ("max_gap", "130 ms", [change, change]),
        )
    }
    assert len(hashes) == 5
    assert hash_change(change, comparison.versions) not in hashes
