"""The picture of a late run: each row fills the chain's time, red is the chain, and it is there only where a run was seen."""

from __future__ import annotations

import math

import pytest

from archgen.views.drawing_set import make_drawings
from archgen.views.lookup import make_lookup
from archgen.views.timing.chain_charts import make_late_run_charts, make_late_run_figures
from archgen.views.timing.timing_lookup import TimingLookup, add_late_runs, analyse_with_chains
from tests.simulation.late_robot import ROBOT
from tests.timing.random_systems import architecture


@pytest.fixture(scope="module", name="timing")
def make_timing() -> TimingLookup:
    return add_late_runs(analyse_with_chains(architecture(ROBOT)))


def test_a_chain_that_a_run_shows_late_is_missed_and_drawn(timing: TimingLookup) -> None:
    assert [result.verdict for result in timing.chains] == ["missed"]
    lookup = make_lookup(architecture(ROBOT), timing_lookup=timing)
    (chart,) = make_late_run_charts(lookup, timing)
    assert chart.id in make_drawings(lookup, None, "implementation")
    longest = float(timing.late_runs["stop"].longest) / 10**6
    chain, *rows = chart.bars
    assert math.fsum(each.length or 0 for each in chain.segments) == pytest.approx(longest)
    assert {each.kind for each in chain.segments} == {"missed", "late_wait"}
    assert any(each.label == "held up by planner 150 ms" for each in chain.segments)
    assert [bar.title for bar in rows] == ["other on Pc", "box on Pc", "lidar on Pc", "detector on Pc", "gpu"]
    assert all(math.fsum(each.length or 0 for each in bar.segments) <= longest + 1e-9 for bar in rows)
    # What works for the chain is red in the rows too, and takes as long there.
    works = {
        kind: math.fsum(s.length or 0 for bar in rows[:-1] for s in bar.segments if s.kind == kind)
        for kind in ("missed",)
    }
    own = math.fsum(each.length or 0 for each in chain.segments if each.kind == "missed")
    assert works["missed"] <= own
    assert chart.limit == (250.0, "deadline 250 ms")
    assert "box in rounds, as ROS 2 does" in chart.notes[0]


def test_how_to_see_it_again_is_said(timing: TimingLookup) -> None:
    lookup = make_lookup(architecture(ROBOT), timing_lookup=timing)
    paragraph, figure = make_late_run_figures(lookup, timing, timing.chains[0])
    late = timing.late_runs["stop"]
    assert paragraph.inlines[-1].text == (  # type: ignore[union-attr]
        f"archgen simulate --chain stop --seed {late.seed} --seconds {late.seconds} --trace late.json"
    )
    assert figure.graph == "chains/stop.late"  # type: ignore[union-attr]


def test_a_chain_in_time_has_no_picture() -> None:
    model = architecture(ROBOT.replace("250 ms", "1 s"))
    timing = add_late_runs(analyse_with_chains(model))
    assert [result.verdict for result in timing.chains] == ["met"]
    lookup = make_lookup(model, timing_lookup=timing)
    assert list(make_late_run_charts(lookup, timing)) == []
    assert make_late_run_figures(lookup, timing, timing.chains[0]) == ()
