"""Charts as drawings: nothing meets, everything has its text, forms tell apart what colours tell apart."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest

from archgen.emit import graphviz
from archgen.emit.graphviz import chart_layout, palette
from archgen.emit.graphviz.placed_scene import Scene
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import BarSegment, Chart, ChartBar
from archgen.views.timing import chain_charts
from tests.emit.graphviz.overlaps import overlapping_parts
from tests.judged_projects import judge_ramcip
from tests.timings import timed

TEXT_WIDTH = 160 / 25.4 * 72
HOSTILE = '</svg><script>alert(1)</script> "\\N" & ' + "W" * 120


def bars(*found: ChartBar, **more: object) -> Chart:
    return Chart("chains/c", "A chain", "ms", found, **more)  # type: ignore[arg-type]


def scene(item: Chart) -> Scene:
    return chart_layout.lay_out_chart(item, lambda _: None)


STEP = ChartBar(
    "camera", (BarSegment(100.0, "sampling", "100 ms"), BarSegment(0.001, "response", "0.001 ms")), "+ 100.001 ms"
)
ODD = {
    "nothing is known": bars(
        ChartBar("a", (BarSegment(None, "response"), BarSegment(None, "link"))), legend=("unknown",)
    ),
    "all is zero": bars(ChartBar("a", (BarSegment(0.0, "response"),), "0 ms")),
    "no bars": bars(),
    "the limit is far": bars(STEP, limit=(10_000.0, "deadline 10 s")),
    "the limit is at the start": bars(STEP, limit=(0.5, "deadline 0.5 ms")),
    "no bar but a limit": bars(ChartBar("a", (BarSegment(None, "response"),)), limit=(500.0, "deadline 500 ms")),
    "large figures": bars(
        ChartBar("a", (BarSegment(1e15, "response", "1"),), "1000000000000 s"), limit=(2e15, "deadline")
    ),
    "small figures": bars(ChartBar("a", (BarSegment(1e-6, "response", "1"),), "0.000001 ms", mark=2e-6)),
    "hostile texts": bars(
        ChartBar(HOSTILE, (BarSegment(1.0, "response", HOSTILE, HOSTILE),), HOSTILE),
        limit=(1.0, HOSTILE),
        conclusion=HOSTILE,
        notes=(HOSTILE,),
        legend=("response", f"load: {HOSTILE}"),
    ),
}


@pytest.mark.parametrize("item", ODD.values(), ids=ODD)
def test_odd_charts_are_drawn_and_nothing_meets(item: Chart) -> None:
    assert list(overlapping_parts(scene(item))) == []
    picture = graphviz.draw_pictures([item], ["svg", "png", "pdf", "svg_outlines"], resolve_link=lambda _: None)[
        "chains/c"
    ]
    assert picture.warning is None
    assert b"<script" not in (picture.svg or b"")


def test_charts_of_the_example_fit_the_text_of_a_report_and_nothing_meets() -> None:
    architecture = judge_ramcip().architecture
    for item in chain_charts.make_timing_charts(make_lookup(architecture, timing_lookup=timed(architecture))):
        laid_out = scene(item)
        left, _, right, _ = laid_out.bounds()
        assert (item.id, list(overlapping_parts(laid_out))) == (item.id, [])
        assert right - left <= TEXT_WIDTH


def test_terms_are_told_apart_by_form_and_the_unknown_has_a_question_mark() -> None:
    kinds = [
        BarSegment(10.0, "sampling"),
        BarSegment(10.0, "response"),
        BarSegment(10.0, "link"),
        BarSegment(None, "response"),
    ]
    parts = {
        p.attributes["class"]: p.attributes for p in scene(bars(ChartBar("a", tuple(kinds)))).parts if p.kind == "box"
    }
    styles = {name: (look["style"], ":" in look["fillcolor"]) for name, look in parts.items()}
    assert styles == {
        '"bar sampling"': ('"filled,dotted"', False),
        '"bar response"': ('"filled"', False),
        '"bar link"': ('"striped"', True),
        '"bar unknown"': ('"striped,dashed"', True),
    }
    assert "<B>?</B>" in parts['"bar unknown"']["label"]


def test_a_label_that_does_not_fit_is_left_to_the_tooltip() -> None:
    long, short = BarSegment(99.0, "response", "fits", "told"), BarSegment(1.0, "response", "does not", "told too")
    inside = [p.attributes for p in scene(bars(ChartBar("a", (long, short)))).parts if p.kind == "box"]
    assert ["fits" in look["label"] for look in inside] == [True, False]
    assert [look["tooltip"] for look in inside] == ['"told"', '"told too"']


def test_bars_begin_where_the_scale_says() -> None:
    one, two = (
        ChartBar("a", (BarSegment(30.0, "response"),)),
        ChartBar("b", (BarSegment(10.0, "response"),), start=30.0),
    )
    first, second = (p.rectangle for p in scene(bars(one, two, limit=(40.0, "deadline"))).parts if p.kind == "box")
    assert second[0] == pytest.approx(first[2])
    (line,) = (p for p in scene(bars(one, two, limit=(40.0, "deadline"))).parts if p.name == "limit")
    assert line.x == pytest.approx(second[2])


def test_a_bar_of_hairs_ends_where_its_sum_does() -> None:
    hairs = tuple(BarSegment(0.01, "load") for _ in range(20))
    whole, of_hairs = ChartBar("a", (BarSegment(50.2, "load"),)), ChartBar("b", (BarSegment(50.0, "load"), *hairs))
    boxes = [p for p in scene(bars(whole, of_hairs, limit=(100.0, "busy"))).parts if p.kind == "box"]
    assert boxes[-1].rectangle[2] == pytest.approx(boxes[0].rectangle[2])
    assert list(overlapping_parts(scene(bars(of_hairs)))) == []


def test_what_stands_around_a_part_is_named_in_grey() -> None:
    inner, outer = (
        ChartBar("mine", (BarSegment(1.0, "load"),), "1 %"),
        ChartBar("theirs", (BarSegment(1.0, "load"),), "1 %", is_outside=True),
    )
    texts = {
        p.name: p.attributes["label"] for p in scene(bars(inner, outer)).parts if p.name in {"t0", "t1", "v0", "v1"}
    }
    grey = {name for name, label in texts.items() if palette.MUTED in label}
    assert (len(texts), grey) == (4, {"t1", "v1"})


def test_the_same_chart_gives_the_same_bytes() -> None:
    item = bars(STEP, limit=(150.0, "deadline 150 ms"), legend=("sampling", "response"))
    once, again = (
        graphviz.draw_pictures([item], ["svg", "png", "pdf"], resolve_link=lambda _: None)["chains/c"] for _ in range(2)
    )
    assert (once.svg, once.png, once.pdf, once.dot) == (again.svg, again.png, again.pdf, again.dot)


def _luminance(colour: str) -> float:
    parts = (int(colour[at : at + 2], 16) / 255 for at in (1, 3, 5))
    red, green, blue = (part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("step", palette.PERIODS)
def test_text_reads_well_on_every_fill_in_light_and_dark(step: str) -> None:
    fill = palette.PERIODS[step]
    ink, dark = palette.text_colour_on(fill), dict(palette.dark_pairs())
    assert contrast(fill, ink) >= 4.5
    in_the_dark = dark.get(fill, fill), ink if ink == palette.PAPER else dark.get(ink, ink)
    assert contrast(*in_the_dark) >= 4.5


def test_the_scale_grows_lighter_step_by_step() -> None:
    light = [
        _luminance(palette.PERIODS[s]) for s in ("to_10_ms", "to_30_ms", "to_100_ms", "to_300_ms", "to_1_s", "slower")
    ]
    assert light == sorted(light)
    assert all(contrast(one, other) > 1.3 for one, other in zip(light_fills(), light_fills()[1:], strict=False))


def light_fills() -> list[str]:
    return list(palette.PERIODS.values())[:6]


def test_every_colour_is_written_in_full() -> None:
    assert all(re.fullmatch("#[0-9a-f]{6}", colour) for colour in palette.PERIODS.values())


def test_figures_are_short_and_tips_keep_all_digits() -> None:
    step = ChartBar("camera", (BarSegment(2621.667, "response", "2621.667 ms"),), ">= 2621.667 ms")
    chart = bars(step, conclusion="Met: at the latest after 2621.667 ms.", limit=(8000.0, "deadline 8000 ms"))
    attributes = "\n".join(str(part.attributes) for part in scene(chart).parts)
    assert all(text in attributes for text in ("≥ 2.62 s", "after 2.63 s.", "deadline 8 s"))
    assert "2621.667 ms" in attributes
    ticks = [part.attributes["label"] for part in scene(chart).parts if re.fullmatch(r"a\d+", part.name)]
    assert [re.sub("<[^>]*>|[<>]", "", tick) for tick in ticks][-2:] == ["6", "8 s"]
    assert ">= 2" not in attributes


def test_what_is_unknown_pushes_the_bars_behind_it_and_ends_the_axis() -> None:
    bars = (
        ChartBar("a", (BarSegment(100, "response"), BarSegment(None, "link"))),
        ChartBar("b", (BarSegment(None, "response"),), start=100, gaps=1),
        ChartBar("c", (BarSegment(50, "response"),), start=100, gaps=2),
    )
    chart = Chart("c", "C", "ms", bars, limit=(120, "deadline"))
    parts = {part.name: part for part in chart_layout.lay_out_chart(chart, lambda _: None).parts}
    ends = [parts[name].rectangle for name in ("b0.0", "b0.q", "b1.q", "b2.0")]
    for one, other in pairwise(ends):
        assert one[2] - 0.1 <= other[0] <= one[2] + 3
    texts = [part.attributes["label"] for name, part in parts.items() if name[0] == "a"]
    assert texts[-1].count("ms + ?") == 1
    assert "limit" not in parts, "a deadline behind what is unknown is only named"
    assert "deadline →" in parts["limits"].attributes["label"]
