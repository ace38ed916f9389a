"""Sequences as they are laid out: nothing overlaps, every step has its arrow, heads stand above their lines."""

from __future__ import annotations

import re

import pytest

from archgen.emit.graphviz.graph_drawing import draw_picture
from archgen.emit.graphviz.sequence_layout import lay_out_sequence
from archgen.views.picture_shapes import Lifeline, SequenceChart, SequenceMessage
from tests.emit.graphviz.overlaps import overlapping_parts

LIFELINES = (
    Lifeline("The resident", "actor"),
    Lifeline("Speech Recognition", colour=1, ref="component:g.speech"),
    Lifeline("Dialogue", "composed", colour=2),
    Lifeline("gone", "unknown"),
)
MESSAGES = (
    SequenceMessage(1, 0, 1, "asks for a glass of water and something to read", "Voice\n5 ms", "physical"),
    SequenceMessage(2, 1, 2, "passes on the words", "Words", ref="type:Words"),
    SequenceMessage(3, 2, 2, "thinks", style="inner"),
    SequenceMessage(4, 2, 1, "asks back", style="service"),
    SequenceMessage(5, 2, 0, "a long way back", style="action"),
    SequenceMessage(6, 2, 3, "", "no connection", "broken"),
    SequenceMessage(7, 3, 3, "at the edge", style="inner"),
)


def chart(
    messages: tuple[SequenceMessage, ...] = MESSAGES, lifelines: tuple[Lifeline, ...] = LIFELINES
) -> SequenceChart:
    return SequenceChart(
        "sequences/UC-1",
        "Water",
        lifelines,
        messages,
        legend=("step:data", "external"),
        notes=("A note.",),
        alt="Steps.",
    )


def test_steps_stand_below_one_another_and_nothing_overlaps() -> None:
    scene = lay_out_sequence(chart(), lambda _: None)
    assert list(overlapping_parts(scene)) == []
    heads = {part.name: part.x for part in scene.parts if re.fullmatch("h[0-9]", part.name)}
    assert list(heads.values()) == sorted(heads.values())
    arrows = [line for line in scene.lines if line.arrow.startswith("m")]
    tops = [max(y for _, y in line.points) for line in arrows]
    assert tops == sorted(tops, reverse=True)
    # Each arrow begins and ends at its lifelines.
    for line, message in zip(arrows, MESSAGES, strict=True):
        xs = [x for x, _ in line.points]
        ends = {heads[f"h{message.tail}"], heads[f"h{message.head}"]}
        assert all(min(abs(x - end) for x in xs) < 0.1 for end in ends), message.number


def test_a_long_sequence_has_its_heads_below_too() -> None:
    many = tuple(SequenceMessage(number, 0, 1, "again") for number in range(1, 41))
    few, long = (lay_out_sequence(chart(each, LIFELINES[:2]), lambda _: None) for each in (many[:3], many))
    assert [part.name for part in few.parts if part.name.startswith("b")] == []
    assert [part.name for part in long.parts if part.name.startswith("b")] == ["b0", "b1"]
    assert list(overlapping_parts(long)) == []


def test_fifteen_lifelines_and_forty_steps_stay_apart() -> None:
    lifelines = tuple(Lifeline(f"Component number {at}", colour=at) for at in range(15))
    messages = tuple(
        SequenceMessage(
            number, number * 7 % 15, number * 4 % 15, f"says {'something long ' * (number % 5)}", "Type\n1 ms"
        )
        for number in range(1, 41)
    )
    assert list(overlapping_parts(lay_out_sequence(chart(messages, lifelines), lambda _: None))) == []


def test_the_svg_has_links_words_for_all_and_no_markup_of_others() -> None:
    hostile = SequenceMessage(1, 0, 1, '<script>alert(1)</script> & "x" ]]>', "<b>", tooltip="</title><script>")
    picture = draw_picture(
        chart((hostile, *MESSAGES[1:])), {"component:g.speech": "c.html", "type:Words": "javascript:x"}, ("svg",)
    )
    svg = (picture.svg or b"").decode()
    assert "<title>Water</title>" in svg
    assert "<desc>Steps.</desc>" in svg
    assert 'xlink:href="c.html"' in svg
    assert "<script" not in svg
    assert "javascript" not in svg


@pytest.mark.parametrize("count", [0, 1])
def test_almost_nothing_is_a_picture_too(count: int) -> None:
    assert draw_picture(chart((), LIFELINES[:count]), {}, ("svg",)).svg
