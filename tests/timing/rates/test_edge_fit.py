"""Where two rates meet: what is lost, read again, how they beat, how long a queue must be; in numbers."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.analysis import EdgeFit
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.task_sets import MS

Derived = Callable[[str], Architecture]
TEXT = """
groups:
  g:
    components:
      a: {outputs: {out: std_msgs/msg/Empty}}
      b: {inputs: {one: a.out}}
nodes:
  a: {implements: a, timing: {A, wcet: 1 ms, bcet: 1 ms}}
  b: {implements: b, timing: {B, wcet: 2 ms}MORE}
"""
QUEUE = ", subscribes: {one: {qos: {depth: %s}}}"


def edge(derived: Derived, a: str, b: str, more: str = "") -> EdgeFit:
    (found,) = analyse_architecture(
        derived(TEXT.replace("{A,", f"{{{a},").replace("{B,", f"{{{b},").replace("MORE", more))
    ).edges
    return found


@pytest.mark.parametrize(
    ("a", "b", "more", "loss", "again", "beat"),
    [
        # A reader with a clock takes the newest: of 30 a second 10 are used; of 10 each is read three times.
        ("rate: 30 Hz", "rate: 10 Hz", "", "2/3", "1", 0),
        ("rate: 10 Hz", "rate: 30 Hz", "", "0", "3", 0),
        # 30 against 25: one is left out in each 200 ms; 25 against 30 likewise one is read twice.
        ("rate: 30 Hz", "rate: 25 Hz", "", "1/6", "1", 200),
        ("rate: 25 Hz", "rate: 30 Hz", "", "0", "6/5", 200),
        # Nearest to 50 are two times 24: apart by 2 Hz.
        ("rate: 50 Hz", "rate: 24 Hz", "", "13/25", "1", 500),
        # Who asked for a queue takes all of it: 5 each 50 ms of the 10 that come; 11 hold all.
        ("rate: 200 Hz", "rate: 20 Hz", QUEUE % 5, "1/2", "1", 0),
        ("rate: 200 Hz", "rate: 20 Hz", QUEUE % 11, "0", "1", 0),
        # Each message fires; every third, or one in each 100 ms (the fourth) of those that come each 30 ms.
        ("rate: 30 Hz", "behaviour: event", "", "0", "1", 0),
        ("rate: 30 Hz", "behaviour: event, every: 3", "", "2/3", "1", 0),
        ("period: 30 ms", "behaviour: event, throttle: 100 ms", "", "3/4", "1", 0),
    ],
)
def test_what_becomes_of_samples(  # noqa: PLR0913, PLR0917 - a row of a table
    derived: Derived, a: str, b: str, more: str, loss: str, again: str, beat: int
) -> None:
    found = edge(derived, a, b, more)
    assert (found.loss.value, found.rereads.value) == (Fraction(loss), Fraction(again))
    assert found.beat.value == beat * MS


@pytest.mark.parametrize(
    ("a", "b", "queue"),
    [
        # In the 50 + 2 ms until a reader has been through once more, 11 can come at most at 200 Hz.
        ("rate: 200 Hz", "rate: 20 Hz", 11),
        ("rate: 200 Hz, jitter: 10 ms", "rate: 20 Hz", 13),
        # What is fired has its response: 2 ms; or 5 where three come 1 ms apart and a fourth at 3, up to 12 ms late each.
        ("rate: 200 Hz", "behaviour: event", 1),
        ("rate: 200 Hz, jitter: 10 ms", "behaviour: event", 4),
    ],
)
def test_how_long_a_queue_must_be(derived: Derived, a: str, b: str, queue: int) -> None:
    assert edge(derived, a, b).queue.value == queue


def test_nothing_is_said_of_rates_that_nobody_knows(derived: Derived) -> None:
    found = edge(derived, "jitter: 1 ms", "rate: 20 Hz")
    for figure in (found.loss, found.rereads, found.beat):
        assert (figure.value, figure.complete, figure.missing) == (None, False, ("a",))
