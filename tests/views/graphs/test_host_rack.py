"""Hosts as a rack: what crosses links adds up, figures are never below the exact ones, every host has its strip."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.views.graphs.host_rack import draw_host_racks, draw_slide_rack, list_crossings
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.picture_shapes import Sheet
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.running import RAMCIP

SMALL = """\
archgen: 1
hosts: {one: {cores: 4, tags: [gpu]}, two: {cores: 2}, three: {cores: 1}, four: {}, five: {cores: 40}}
links:
  lan: {connects: [one, two, three], bandwidth: 1 Gbit/s}
  can: {connects: [two, four], bandwidth: 500 kbit/s}
types: {T: std_msgs/msg/Int32}
groups:
  g:
    components:
      a: {outputs: {x: T}, timing: {rate: 100 Hz, wcet: 3.333 ms}}
      b: {inputs: {x: a.x}, outputs: {y: T}, timing: {rate: 50 Hz, wcet: 30 ms}}
      c: {inputs: {x: a.x, y: b.y}, timing: {rate: 10 Hz}}
      d: {inputs: {y: b.y}, timing: {rate: 200 Hz, wcet: 7 ms}}
      e: {inputs: {x: a.x}}
containers: {box: {host: one, threads: 2}}
nodes:
  a: {implements: a, container: box}
  b: {implements: b, host: two, core: 1}
  c: {implements: c, host: three}
  d: {implements: d, host: four}
  e: {implements: e}
"""


def look_up(project: Path) -> Lookup:
    architecture = pipeline.check_project(project).architecture
    return replace(make_lookup(architecture), timing=analyse_with_chains(architecture))


@pytest.fixture
def small(tmp_path: Path) -> Lookup:
    (tmp_path / "robot.yaml").write_text(SMALL, "utf-8")
    return look_up(tmp_path / "robot.yaml")


def list_words(sheet: Sheet) -> list[str]:
    return [text.text for text in sheet.texts]


def test_pairs_of_hosts_add_up_to_the_traffic_of_each_link(small: Lookup) -> None:
    for lookup in (small, look_up(RAMCIP)):
        crossings = list_crossings(lookup)
        assert lookup.timing is not None
        assert crossings
        for link, load in lookup.timing.analysis.links.items():
            assert load.traffic.value == sum(
                (each.traffic.value or 0 for each in crossings if each.link == link), Fraction(0)
            )
        assert all(each.giver != each.taker for each in crossings)


def test_every_host_has_a_strip_with_its_cores_and_links(small: Lookup) -> None:
    wide, upright = draw_host_racks(small)
    assert (wide.id, upright.id) == ("hosts", "hosts_upright")
    for sheet in (wide, upright):
        words = list_words(sheet)
        assert [title for title in ("One", "Two", "Three", "Four", "Five") if title not in words] == []
        assert "gpu" in words
        assert "40 cores" in words, "more than there is room for are counted"
        assert "1 node on no host yet" in words
        assert [bar.ref for bar in sheet.bars if bar.ref] == (["link:lan", "link:can"] if sheet is wide else [])
        assert all(text.size >= 7.5 for text in sheet.texts)
    # 33.33 % of a core, and of 400: rounded up.
    assert "33.4" in list_words(wide)
    assert "8.4 % of all cores" in list_words(wide)
    assert "■ Box: 33.4 %, 1 node, 2 threads" in list_words(wide)
    assert sum(line.head for line in wide.lines) == 6, "one arrow for each direction in which something flows"


def test_a_load_is_never_shown_below_the_exact_one() -> None:
    lookup = look_up(RAMCIP)
    assert lookup.timing is not None
    words = list_words(draw_host_racks(lookup)[0])
    shown = [
        Fraction(word.removesuffix(" % of all cores").lstrip("<= "))
        for word in words
        if word.endswith("of all cores") and word[0] not in ">?"
    ]
    exact = [
        load.utilisation.value * 100 / load.cores
        for load in lookup.timing.analysis.hosts.values()
        if load.cores and load.utilisation.complete and load.utilisation.value
    ]
    assert len(shown) == len(exact) > 1
    assert all(0 <= figure - value < Fraction(1, 10) for figure, value in zip(shown, exact, strict=True))


def test_many_hosts_and_none(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(
        "archgen: 1\nhosts: {"
        + ", ".join(f"h{at}: {{cores: 2}}" for at in range(40))
        + "}\ngroups: {g: {components: {a: {}}}}\n",
        "utf-8",
    )
    lookup = look_up(tmp_path / "robot.yaml")
    assert all(f"H{at}" in list_words(sheet) for sheet in draw_host_racks(lookup) for at in range(40))
    assert draw_host_racks(replace(lookup, architecture=replace(lookup.architecture, hosts={}))) == ()
    assert draw_host_racks(replace(lookup, timing=None))


def test_the_rack_of_a_slide_is_as_high_as_leaves_its_type_large() -> None:
    lookup = look_up(RAMCIP)
    rack, slide = draw_host_racks(lookup)[0], draw_slide_rack(lookup)
    bottoms = [max(bar.y + bar.height for bar in sheet.bars) for sheet in (rack, slide)]
    assert bottoms[1] <= 430 < bottoms[0]
    assert slide.id == "hosts_slide"
    assert {host.title for host in lookup.architecture.hosts.values()} <= set(list_words(slide))


def test_long_titles_stay_in_their_strip_and_lose_no_figure(tmp_path: Path) -> None:
    titled = SMALL.replace("one: {cores: 4,", "one: {title: Real-time Computer of Arm and Hand, cores: 4,").replace(
        "box: {host: one, threads: 2}",
        "box: {title: Head Camera and Projector Process, host: one, threads: 2}, more: {host: one}",
    )
    (tmp_path / "robot.yaml").write_text(titled, "utf-8")
    for sheet in draw_host_racks(look_up(tmp_path / "robot.yaml")):
        frame = max(bar.x + bar.width for bar in sheet.bars if bar.fill == "paper" and bar.rounded)
        box = next(text for text in sheet.texts if text.text.startswith("■ Head"))
        assert box.x + 4.4 * len(box.text) < frame, "text of 8 px is up to 4.4 px wide a letter: it ran over the frame"
        assert re.search(r": 33\.4 %, 1 node(, 2 threads)?; 1 more$", box.text), "the title is cut, not the figures"
        title = [text.text for text in sheet.texts if text.tooltip == "Real-time Computer of Arm and Hand"]
        assert " ".join(title) == "Real-time Computer of Arm and Hand"
