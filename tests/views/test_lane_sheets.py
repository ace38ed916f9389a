"""Sequences with lanes: what happens at once shares a row, ways meet, nothing is told twice or left out."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.model.step_connections import ConnectedStep
from archgen.model.use_case_steps import Step, StepEnd
from archgen.views.drawing_set import make_drawings
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import SequenceChart, Sheet
from archgen.views.sequences.lane_sheets import MOST_LIFELINES, _order_lanes, _wrap, draw_lane_sheets, place_steps
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.judged_projects import judge_ramcip


def make_steps(text: str) -> list[ConnectedStep]:
    """Read steps: `a>b P>c`; who has a capital letter is a person."""
    steps = []
    for at, step in enumerate(text.split(), 1):
        source, target = (StepEnd("actor" if name.isupper() else "component", name) for name in step.split(">"))
        steps.append(ConnectedStep(at, Step(source, target), (), needs_connection=False))
    return steps


@pytest.mark.parametrize(
    ("steps", "rows", "done"),
    [
        ("a>b b>c c>d", [0, 1, 2], 3),
        ("a>b x>y b>c", [0, 0, 1], 2),  # who has had no part yet begins a way of its own
        ("a>b x>y y>b b>c", [0, 0, 1, 2], 3),  # two ways meet
        ("a>b a>c c>d", [0, 1, 2], 3),  # a component does one thing after the other
        ("P>a P>b a>c b>c c>d", [0, 0, 1, 1, 2], 3),  # a person may do two things at once
        ("a>P P>b", [0, 1], 2),  # but answers what was asked
        ("a>a a>b", [0, 1], 2),
    ],
)
def test_rows(steps: str, rows: list[int], done: int) -> None:
    made = make_steps(steps)
    placed = place_steps(made, [Fraction(1)] * len(made))
    assert [each.row for each in placed] == rows
    assert max(each.done or 0 for each in placed) == done <= len(made)


def test_a_way_of_unknown_length_makes_the_end_unknown() -> None:
    placed = place_steps(make_steps("a>b x>b b>c"), [None, Fraction(1), Fraction(1)])
    assert [each.done for each in placed] == [None, 1, None]


@cache
def look_up() -> Lookup:
    architecture = judge_ramcip().architecture
    return replace(make_lookup(architecture), timing=analyse_with_chains(architecture))


def test_no_component_sends_twice_in_a_row_and_rows_are_no_longer_than_the_sum() -> None:
    for name, steps in look_up().steps.by_use_case.items():
        placed = place_steps(steps, [Fraction(1)] * len(steps))
        for row in range(len(steps)):
            sources = [each.step.step.source for each in placed if each.row == row]
            senders = [source.participant for source in sources if source.kind != "actor"]
            assert len(senders) == len(set(senders)), name
        assert max(each.done or 0 for each in placed) <= len(steps)


def test_lanes_lie_so_that_steps_go_sideways_least() -> None:
    assert _order_lanes([("a", "c"), ("c", "b"), ("b", "d")]) in (["a", "c", "b", "d"], ["d", "b", "c", "a"])
    many = [(str(at), str(at + 1)) for at in (0, 4, 2, 6, 1, 5, 3, 7)]
    order = _order_lanes(many)
    assert sum(abs(order.index(one) - order.index(other)) for one, other in many) < 16


def test_more_than_eight_lifelines_share_lanes() -> None:
    lookup = look_up()
    drawings = make_drawings(lookup, None, "functional")
    for name, steps in lookup.steps.by_use_case.items():
        count = len({end.participant for each in steps for end in (each.step.source, each.step.target)})
        drawing = drawings[f"sequences/{name}"]
        assert isinstance(drawing, SequenceChart if count <= MOST_LIFELINES else Sheet)
        assert (f"sequences/{name}_upright" in drawings) is (count > MOST_LIFELINES)


def test_all_words_and_times_stand_on_cards_and_in_the_list() -> None:
    lookup = look_up()
    wide, upright = draw_lane_sheets(lookup, "UC-4")
    words = [text.text for text in wide.texts]
    assert {"a dull sound,", "then a cry", "ask whether she wants", "help"} <= set(words)
    assert words.count("Dialogue Manager") == 2
    assert list(_wrap("Please leave the stick. Shall I pick it up?", (21, 21, 15))) == [
        "Please leave the",
        "stick. Shall I pick",
        "it up?",
    ]
    assert {"ACCREA", "FORTH-ICS", "The resident", "The daughter"} <= set(words)
    numbers = [int(text.text) for text in upright.texts if text.text.isdecimal()]
    assert sorted(numbers) == list(range(1, 17))
    assert all(text.size >= 8 for sheet in (wide, upright) for text in sheet.texts)
    assert max(text.x for text in upright.texts) <= 530
    # No card lies on another one: 16 steps, and two that a way ends at.
    cards = [(bar.x, bar.y) for bar in wide.bars if bar.height == 46]
    assert len(cards) == len(set(cards)) == 18
    # Eight tenths of its size fit into a page in a window of 1440 pixels.
    assert max(bar.x + bar.width for bar in wide.bars) * 4 / 3 * 0.8 <= 1075
    # What it took stands beside the lanes, not on them.
    assert max(bar.x + bar.width for bar in wide.bars if bar.behind) < next(
        text.x for text in wide.texts if text.text == "at the latest"
    )
    assert not any("one row" in note for note in upright.notes)


def test_what_all_steps_take_is_never_above_their_bound() -> None:
    lookup = look_up()
    assert lookup.timing is not None
    for name, times in lookup.timing.use_cases.items():
        for sheet in draw_lane_sheets(lookup, name)[:1]:
            shown = [text.text for text in sheet.texts if text.x > max(bar.x for bar in sheet.bars if bar.behind)]
            assert times.total.value is not None
            figures = [
                float(word.split()[0]) * (1 if word.endswith(" s") else 0.001)
                for word in shown
                if word.endswith("s") and word[0].isdigit()
            ]
            assert figures
            assert max(figures) < float(times.total.value) / 1e9 + 0.1


def test_hostile_words_and_no_times(tmp_path: Path) -> None:
    names = [f"c{at}" for at in range(10)]
    lines = ["archgen: 1", "types: {T: std_msgs/msg/Empty}", "groups:", "  g:", "    components:"]
    lines += [f"      {name}: {{inputs: {{i: {names[at - 1]}.o}}, outputs: {{o: T}}}}" for at, name in enumerate(names)]
    lines += ["use_cases:", "  UC:", "    steps:"]
    lines += [f"      - {{from: g.{one}, to: g.{other}, say: '<b>{'w' * 300}'}}" for one, other in pairwise(names)]
    (tmp_path / "robot.yaml").write_text("\n".join(lines) + "\n", "utf-8")
    lookup = make_lookup(pipeline.check_project(tmp_path / "robot.yaml").architecture)
    sheets = draw_lane_sheets(lookup, "UC")
    assert len(sheets) == 2
    for sheet in sheets:
        assert all(len(text.text) < 45 for text in sheet.texts)
        assert not any("after it began" in text.text for text in sheet.texts)
