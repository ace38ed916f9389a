"""Charts of timing: terms add up to the bound, the unknown stays unknown, verdicts are in words."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.analysis import HostLoad
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.load.host_verdicts import name_host_verdict
from archgen.views.lookup import make_lookup
from archgen.views.picture_shapes import Chart
from archgen.views.timing import chain_charts, load_charts
from archgen.views.timing.timing_lookup import TimingLookup
from tests.judged_projects import judge_ramcip
from tests.timings import MS, analysis_of, chain, exact, timed


@pytest.fixture(scope="module")
def drawn() -> dict[str, Chart]:
    architecture = judge_ramcip().architecture
    return {
        chart.id: chart
        for chart in chain_charts.make_timing_charts(make_lookup(architecture, timing_lookup=timed(architecture)))
    }


def test_every_chain_and_host_has_a_chart(drawn: dict[str, Chart]) -> None:
    architecture = judge_ramcip().architecture
    wanted = {f"chains/{name}" for name in architecture.chains} | {f"load/{name}" for name in architecture.hosts}
    assert set(drawn) == {"load", *wanted}


def test_terms_stand_end_to_end_and_reach_the_bound(drawn: dict[str, Chart]) -> None:
    for name, chart in drawn.items():
        if name.startswith("chains/"):
            *steps, total, _ = chart.bars
            ends = [bar.start + sum(each.length or 0 for each in bar.segments) for bar in steps]
            assert [bar.start for bar in steps] == pytest.approx([0.0, *ends[:-1]])
            assert total.segments[0].length == pytest.approx(ends[-1])


def _verdict(deadline: int | None, wcet: int | None = 30 * MS) -> str:
    analysis = analysis_of({"a": (100 * MS, 8 * MS), "b": (None, wcet)}, [("a", "b")])
    found = TimingLookup(analysis)
    return chain_charts.describe_chain_verdict(chain(("c", ("a", "b"), deadline), analysis), found)


def test_verdicts() -> None:
    assert _verdict(200 * MS) == "Met: at the latest after 138.3 ms, 61.7 ms before the deadline of 200 ms."
    assert _verdict(100 * MS) == (
        "Not proven. It may take up to 138.3 ms, 38.3 ms longer than its deadline of 100 ms allows; nothing shows that it ever does."
    )
    assert _verdict(200 * MS, None) == "Open: >= 108.3 ms; no bound: execution time of b unknown."
    assert _verdict(None) == "No deadline. At the latest after 138.3 ms."


def test_an_unknown_term_is_drawn_as_unknown() -> None:
    architecture = judge_ramcip().architecture
    found = timed(architecture)
    (open_chain,) = (result for result in found.chains if result.verdict == "open")
    chart = chain_charts.make_chain_chart(make_lookup(architecture, timing_lookup=found), found, open_chain)
    unknown = [bar.title for bar in chart.bars if any(each.length is None for each in bar.segments)]
    assert unknown == ["light_engine", "Reaction at the latest"]
    assert "unknown" in chart.legend
    assert [bar.value for bar in chart.bars if bar.title == "light_engine"] == ["+ 33.3 ms + ?"]


LOADS = [
    (
        exact(Fraction(1, 2)),
        "schedulable",
        (("a", exact(Fraction(1, 2))),),
        "In time: 50 % of 1 core, and everything is done before it is due again.",
    ),
    (exact(Fraction(5, 4)), "overload", (("a", exact(Fraction(5, 4))),), "Overloaded: 125 % of 1 core."),
    (
        exact(Fraction(9, 10)),
        "undecided",
        (("a", exact(Fraction(9, 10))),),
        "90 % of 1 core: below full load, but nothing proves of 1 of 1 activity that their work is done in time.",
    ),
    (
        TimingValue(Fraction(1, 5), complete=False, missing=("b",)),
        "unknown",
        (("a", exact(Fraction(1, 5))), ("b", UNKNOWN_VALUE)),
        ">= 20 % of 1 core; the load of 1 activity is not known.",
    ),
    (
        TimingValue(Fraction(0), complete=False, missing=("b",)),
        "unknown",
        (("b", UNKNOWN_VALUE),),
        "The load is not known: that of 1 activity is missing.",
    ),
]


UNPROVEN = {"undecided": ("a",)}


@pytest.mark.parametrize(("load", "verdict", "parts", "said"), LOADS)
def test_loads(load: TimingValue, verdict: str, parts: tuple[tuple[str, TimingValue], ...], said: str) -> None:
    assert (
        load_charts.describe_load(
            HostLoad(load, 1, exact(Fraction(7, 10)), verdict, parts, unproven=UNPROVEN.get(verdict, ()))  # type: ignore[arg-type]
        )
        == said
    )


def test_nothing_is_said_to_be_done_in_time_that_only_other_priorities_would_do() -> None:
    load = HostLoad(
        exact(Fraction(1, 5)), 1, UNKNOWN_VALUE, "schedulable", (("a", exact(Fraction(1, 5))),), unproven=("a",)
    )
    assert load_charts.describe_load(load) == "In time: 20 % of 1 core, and priorities by rate are sure to do."
    assert name_host_verdict(load) == "in time with priorities by rate"


def test_a_full_core_is_seen_on_a_host_that_is_not_full() -> None:
    places = (("onboard_pc core 7", 1, exact(Fraction(11, 10))), ("onboard_pc", 7, exact(Fraction(7, 10))))
    load = HostLoad(exact(Fraction(9, 5)), 8, UNKNOWN_VALUE, "overload", (("a", exact(Fraction(9, 5))),), places)
    assert load_charts.describe_load(load) == "Overloaded (core 7): 22.5 % of 8 cores."
    architecture = judge_ramcip().architecture
    chart = load_charts.make_host_chart(make_lookup(architecture), timed(architecture), "onboard_pc", load)
    alone = [(bar.title, bar.value, bar.segments[0].kind) for bar in chart.bars[-2:]]
    assert alone == [("core 7", "110 %", "missed"), ("the other 7 cores", "10 %", "best")]


def test_many_activities_are_summed_up_in_the_last_bar(drawn: dict[str, Chart]) -> None:
    titles = [bar.title for bar in drawn["load/onboard_pc"].bars]
    assert len(titles) == 19
    assert titles[-2:] == ["12 more", "Together"]
