"""What readers may count on in figures: what is read, which limit counts, what follows."""

from __future__ import annotations

from archgen.compare.asked_limits import combine_stricter, judge_limits, list_reliers, read_limits
from archgen.compare.matched_ids import MatchedIds
from archgen.model.quantity import Quantity, parse_quantity
from archgen.timing.run_analysis import analyse_architecture
from tests.compare.conftest import Checked

PROJECT = """\
project: {id: p, title: P}
types: {Rows: std_msgs/msg/Int32}
hosts: {pc: {cores: 1}}
groups:
  sense:
    components:
      head:
        components: {lens: {outputs: {rows: {type: Rows, promise: {rate: 10 Hz, max_gap: 130 ms}}}}}
        outputs: {rows: {from: lens.rows, promise: {max_age: 150 ms}}}
      base: {inputs: {rows: {from: head.rows, freshness: 100 ms}}}
nodes:
  lens: {implements: head.lens, host: pc, publishes: {rows: {qos: {deadline: 90 ms}}}, timing: {rate: 10 Hz, wcet: 5 ms}}
  base: {implements: base, host: pc, timing: {behaviour: event, wcet: 5 ms}}
"""
LEAF, SHELL, READER = "sense.head.lens.rows", "sense.head.rows", "sense.base.rows"


def quantity(text: str) -> Quantity:
    """Read a duration or a rate."""
    found = parse_quantity(text, "frequency" if text.endswith("Hz") else "duration")
    assert found is not None
    return found


def test_limits_of_leaves_composed_components_nodes_and_readers_are_judged(checked: Checked) -> None:
    architecture = checked(PROJECT)
    limits = read_limits(architecture, MatchedIds())
    assert {key: str(limit) for key, limit in limits.items()} == {
        (LEAF, "rate"): "10 Hz",
        (LEAF, "max_gap"): "130 ms",
        (LEAF, "qos.deadline"): "90 ms",
        # What is passed on promises what is promised inside, and more.
        (SHELL, "rate"): "10 Hz",
        (SHELL, "max_gap"): "130 ms",
        (SHELL, "max_age"): "150 ms",
        (READER, "freshness"): "100 ms",
    }
    judged = judge_limits(architecture, analyse_architecture(architecture), MatchedIds(), limits)
    assert {(*key,): each.state for key, each in judged.items()} == {
        (LEAF, "rate", ""): "kept",
        (LEAF, "max_gap", ""): "kept",
        (LEAF, "qos.deadline", ""): "broken",
        (SHELL, "rate", ""): "kept",
        (SHELL, "max_gap", ""): "kept",
        (SHELL, "max_age", READER): "kept",
        (READER, "freshness", ""): "kept",
    }
    assert set(list_reliers(architecture, MatchedIds())) == {(SHELL, READER), (LEAF, READER)}


def test_the_stricter_limit_counts() -> None:
    before = {("o", "rate"): quantity("10 Hz"), ("o", "max_gap"): quantity("100 ms"), ("p", "max_age"): quantity("1 s")}
    after = {("o", "rate"): quantity("5 Hz"), ("o", "max_gap"): quantity("50 ms"), ("q", "max_age"): quantity("2 s")}
    assert {key: str(limit) for key, limit in combine_stricter(before, after).items()} == {
        ("o", "rate"): "10 Hz",
        ("o", "max_gap"): "50 ms",
        ("p", "max_age"): "1 s",
        ("q", "max_age"): "2 s",
    }


def test_a_written_gap_is_judged_as_it_is_written_now() -> None:
    # That it is longer, or gone, is a weaker promise in so many words.
    before, after = {("o", "timing.max_gap"): quantity("1 s")}, {("o", "timing.max_gap"): quantity("2 s")}
    assert combine_stricter(before, after) == after
    assert combine_stricter(before, {}) == {}
