"""Where the time of a chain goes: shares of two axes, words, and what to do."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.lookup import Lookup, make_lookup
from archgen.views.shapes import Bullets, Inlines, Waterfall
from archgen.views.timing.chain_waterfall import make_waterfall
from archgen.views.timing.element_timing import link_names
from archgen.views.timing.timing_lookup import analyse_with_chains
from tests.judged_projects import judge_ramcip

ROBOT = """\
partners: {{p: {{title: Partner P}}, q: {{title: Partner Q}}}}
hosts: {{pc: {{title: Base, cores: 1}}, box: {{title: Box, cores: 1}}}}
links: {{lan: {{title: LAN, connects: [pc, box], latency: 20 ms, bandwidth: 1 Gbit/s}}}}
requirements: {{R-1: Stops in time}}
groups:
  g:
    components:
      eye: {{owner: p, outputs: {{o: std_msgs/msg/Bool}}}}
      brain: {{owner: q, inputs: {{i: eye.o}}, outputs: {{o: std_msgs/msg/Bool}}}}
      brake: {{owner: p, inputs: {{i: brain.o}}}}
nodes:
  eye: {{implements: eye, host: pc, timing: {{period: {period}, wcet: 50 ms, bcet: 5 ms}}}}
  brain: {{implements: brain, host: box, timing: {{period: 100 ms, wcet: 10 ms, bcet: 1 ms}}}}
  brake: {{implements: brake, host: box, timing: {{behaviour: event{wcet}}}}}
chains:
  stop: {{title: Stops in time, through: [eye, brain, brake]{deadline}, requirements: [R-1]}}
"""


def look_up(
    folder: Path, period: str = "200 ms", wcet: str = ", wcet: 5 ms", deadline: str = ", deadline: 1 s"
) -> Lookup:
    file = folder / "robot.yaml"
    file.write_text(ROBOT.format(period=period, wcet=wcet, deadline=deadline), encoding="utf-8")
    checked = check_project(file)
    assert not checked.structural_errors, checked.structural_errors
    return make_lookup(checked.architecture, checked.findings, timing_lookup=analyse_with_chains(checked.architecture))


def fall(lookup: Lookup) -> Waterfall:
    assert lookup.timing is not None
    waterfall = make_waterfall(lookup, lookup.timing, lookup.timing.chains[0])
    assert waterfall is not None
    return waterfall


def read(cell: Inlines) -> str:
    return "".join(run.text for run in cell)


def test_a_met_chain_stands_whole_against_its_deadline(tmp_path: Path) -> None:
    waterfall = fall(look_up(tmp_path))
    assert read(waterfall.lead).startswith("Met: at the latest after ")
    assert [(piece.kind, piece.tip) for piece in waterfall.total] == [
        ("sampling", "waits 300 ms"),
        ("response", "responds 65 ms"),
        ("link", "link 20 ms"),
    ]
    assert waterfall.limits == (1.0, None)
    assert waterfall.limit_text == "deadline 1 s"
    assert waterfall.labels[1] == (pytest.approx(waterfall.total[-1].end), "385 ms")
    assert [figure.title for figure in waterfall.figures] == [
        "At the latest",
        "Deadline",
        "Margin",
        "At the earliest",
        "Requirements",
    ]


def test_steps_follow_each_other_with_owner_host_and_reason(tmp_path: Path) -> None:
    steps = fall(look_up(tmp_path)).steps
    assert [(step.title.text, read(step.note)) for step in steps] == [
        ("eye", "Partner P, Base"),
        ("brain", "Partner Q, Box"),
        ("brake", "Partner P, Box"),
    ]
    assert steps[0].words == "waits 200 ms, responds 50 ms · samples the world every 200 ms at the latest"
    pieces = [piece for step in steps for piece in step.pieces]
    assert pieces[0].start == 0.0
    assert pieces[-1].end == pytest.approx(1.0)
    # Without a gap and without an overlap.
    assert [piece.end for piece in pieces[:-1]] == pytest.approx([piece.start for piece in pieces[1:]])


def test_a_reason_leads_to_its_topics_and_nodes(tmp_path: Path) -> None:
    lookup = look_up(tmp_path)
    assert lookup.timing is not None
    topic = next(iter(lookup.architecture.topics))
    sentence = f"reads {topic} every 1 s, {topic}/other and eye"
    assert [(run.text, run.ref) for run in link_names(lookup, lookup.timing, sentence)] == [
        ("reads ", None),
        (topic, f"topic:{topic}"),
        (" every 1 s, ", None),
        (f"{topic}/other", None),
        (" and eye", None),
    ]


def test_a_piece_that_dwarfs_the_others_is_cut_and_the_others_keep_one_scale(tmp_path: Path) -> None:
    waterfall = fall(look_up(tmp_path, period="30 s", deadline=", deadline: 60 s"))
    pieces = [piece for step in waterfall.steps for piece in step.pieces]
    assert [piece.is_cut for piece in pieces] == [True, *[False] * (len(pieces) - 1)]
    assert pieces[0].end == pytest.approx(0.1)
    assert waterfall.remark == "The first 30 s are drawn short."
    # 50 ms of 185 ms that are not cut.
    assert pieces[1].end - pieces[1].start == pytest.approx(0.9 * 50 / 185)
    assert [text for _, text in waterfall.ticks][:3] == ["0", "30 s", "30.1 s"]
    # The whole stays on a true scale.
    assert waterfall.total[0].end == pytest.approx(30.1 / 60)


def test_what_is_unknown_has_room_and_words_and_somebody_who_owes_it(tmp_path: Path) -> None:
    waterfall = fall(look_up(tmp_path, wcet=""))
    assert waterfall.total[-1].kind == "unknown"
    assert waterfall.total[-1].end == 1.0
    assert waterfall.labels[1][1].endswith(" known")
    last = waterfall.steps[-1]
    assert (last.pieces[-1].kind, last.pieces[-1].end) == ("unknown", pytest.approx(1.0))
    assert "responds unknown" in last.words
    to_do = waterfall.cards[0]
    assert to_do.title == "What to do"
    (bullets,) = to_do.blocks
    assert isinstance(bullets, Bullets)
    assert read(bullets.items[0]) == (
        "Measure the execution time of brake and write it (wcet:).Owner Partner P, robot.yaml:14"
    )


def test_a_missed_deadline_stands_on_both_axes(tmp_path: Path) -> None:
    waterfall = fall(look_up(tmp_path, deadline=", deadline: 5 ms"))
    whole, step = waterfall.limits
    assert whole is not None
    assert step is not None
    assert whole == pytest.approx(5 / 385)
    # On this axis the first wait, of 200 ms, is drawn short.
    assert step == pytest.approx(0.1 * 5 / 200)


def test_a_chain_without_a_deadline_has_no_limit(tmp_path: Path) -> None:
    waterfall = fall(look_up(tmp_path, deadline=""))
    assert waterfall.limits == (None, None)
    assert waterfall.total[-1].end == pytest.approx(1.0)


def test_shares_stay_on_the_axis_and_figures_apart_in_the_case_study() -> None:
    checked = judge_ramcip()
    timing = analyse_with_chains(checked.architecture)
    lookup = make_lookup(checked.architecture, checked.findings, timing_lookup=timing)
    for result in timing.chains:
        waterfall = make_waterfall(lookup, timing, result)
        assert waterfall is not None
        pieces = [*waterfall.total, *(piece for step in waterfall.steps for piece in step.pieces)]
        assert all(0 <= piece.start < piece.end <= 1.0000001 for piece in pieces), result.id
        places = [place for place, _ in waterfall.ticks]
        assert 3 <= len(places) <= 9, result.id
        assert all(right - left > 0.05 for left, right in pairwise(places)), result.id
        assert len({text for _, text in waterfall.ticks}) == len(places), result.id


def test_each_unknown_pushes_what_follows_and_the_axis_ends_there(tmp_path: Path) -> None:
    text = ROBOT.replace("period: 100 ms, wcet: 10 ms, bcet: 1 ms", "period: 100 ms")
    file = tmp_path / "robot.yaml"
    file.write_text(text.format(period="200 ms", wcet="", deadline=", deadline: 10 s"), encoding="utf-8")
    architecture = check_project(file).architecture
    waterfall = fall(make_lookup(architecture, timing_lookup=analyse_with_chains(architecture)))
    pieces = [piece for step in waterfall.steps for piece in step.pieces]
    assert sum(piece.kind == "unknown" for piece in pieces) >= 2
    for one, other in pairwise(pieces):
        assert other.start == pytest.approx(one.end), "nothing overlaps, nothing is left between"
    assert pieces[-1].end == pytest.approx(1.0)
    first = next(piece for piece in pieces if piece.kind == "unknown")
    *known, (place, words) = waterfall.ticks
    assert words == "+ ?"
    assert first.start < place < first.end
    assert all(place <= first.start for place, _ in known)
    assert waterfall.limits[1] is None, "a deadline behind what is unknown has no place"
