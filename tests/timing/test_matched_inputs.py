"""Inputs that are matched by time: bounds by hand, and held against the simulation's matcher."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest

from archgen.simulation import simulate_system
from archgen.simulation.time_matching import make_matcher
from archgen.timing.analysis import Analysis
from archgen.timing.chains.fused_inputs import find_fused_inputs
from archgen.timing.chains.step_delays import StepDelays
from archgen.timing.load.event_models import MatchedInput, find_match_windows
from archgen.timing.run_analysis import analyse_architecture, analyse_system
from archgen.timing.system.timing_system import Activity, TimingSystem
from tests.simulation.systems import arc, call, event, system, timed
from tests.timing.random_systems import architecture


def test_a_slow_and_a_fast_sensor() -> None:
    """Within and the slow gap are the age; G + max(w, g) + the slow gap the wait; the fast gap and its wait the gap."""
    analysis = analyse_system(_pair(100, 30, within=40))
    figures = analysis.matches["fuse"]
    assert {key: _ms(age) for key, age in figures.ages.items()} == {"slow": 140, "fast": 140}
    assert {key: _ms(wait) for key, wait in figures.waits.items()} == {"slow": 230, "fast": 240}
    assert (_ms(figures.gap), _ms(analysis.paces["fuse"].gap)) == (270, 270)
    assert analysis.paces["fuse"].rate.value == 10
    assert analysis.paces["fuse"].rate.side == "at most"


def test_responses_and_links_are_on_the_way() -> None:
    """`slow` takes 2 to 5 ms, and its link 1 to 4 ms: 109 ms until its next message has come."""
    of = _pair(100, 30, within=40)
    slow = replace(of.activities["slow"], wcet=5, bcet=2)
    of = replace(of, activities={**of.activities, "slow": slow})
    arcs = tuple(replace(one, best=1, worst=4, link="l") if one.source == "slow" else one for one in of.arcs)
    of = replace(of, arcs=arcs, arcs_into={"slow": (), "fast": (), "fuse": arcs}, bandwidths={"l": None})
    figures = analyse_system(of).matches["fuse"]
    assert _ms(figures.ages["slow"]) == 40 + 109
    assert _ms(figures.waits["slow"]) == 30 + 100 + 109 - 3


def test_a_filter_on_the_way_makes_gaps_longer_by_what_its_source_varies() -> None:
    """Between two messages of the filter: 100 ms and 9 - 2. So `fast` waits 40 + 107 + 3 ms, and the filter's own 1 to 3 ms
    come to that: 150 - 1. What arrives varies by 9 - 2 + 3 - 1.
    """
    of = system(
        (
            timed("slow", 100, 9, bcet=2, outputs=("out",)),
            timed("fast", 30, 0, outputs=("out",)),
            event("filter", 3, "slow", bcet=1, outputs=("out",)),
            event("fuse", 1, "filter", "fast", mode="match", within=40),
        ),
        [arc("slow", "filter"), arc("filter", "fuse"), arc("fast", "fuse")],
    )
    analysis = analyse_system(of)
    assert {key: _ms(age) for key, age in analysis.matches["fuse"].ages.items()} == {"filter": 150, "fast": 150}
    assert _ms(analysis.paces["fuse"].jitter) == 150 - 1 + 9


def test_an_input_from_outside_has_no_gap_that_anybody_knows() -> None:
    """Also where a component sends to it as well: it is the input that is unknown, not its reader."""
    model = architecture("""groups: {g: {components: {
  a: {outputs: {out: std_msgs/msg/String}},
  c: {outputs: {out: std_msgs/msg/String}},
  b: {inputs: {a: {from: a.out, external: The world}, c: c.out}, timing: {trigger: {match: [a, c], within: 10 ms}, wcet: 1 ms}}}}}
nodes: {a: {implements: g.a, timing: {period: 10 ms}}, c: {implements: g.c, timing: {period: 10 ms}}, b: {implements: g.b}}
""")
    gap = analyse_architecture(model).paces["b"].gap
    assert (gap.value, gap.missing) == (None, ("g.b.a", "c"))


@pytest.mark.parametrize(
    ("within", "note"),
    [
        (29, "fuse matches what is at most 29 ms apart; `within: 30 ms` would make matches sure"),
        (0, "messages of different sources have the same time at fuse only by chance"),
    ],
)
def test_what_is_not_sure_says_what_would_be(within: int, note: str) -> None:
    analysis = analyse_system(_pair(100, 30, within=within))
    gap = analysis.paces["fuse"].gap
    assert gap.value is None
    assert any(note in text for text in gap.assumptions)
    # How old it is, is known all the same.
    assert _ms(analysis.matches["fuse"].ages["slow"]) == 100 + within


def test_a_queue_that_is_too_short_promises_nothing() -> None:
    """A message may wait for 100 + 40 + 100 ms, in which 120 more come."""
    of = _pair(100, 2, within=40)
    notes = analyse_system(of).paces["fuse"].gap.assumptions
    assert any(
        "fuse keeps 10 messages of fast, and 121 may wait for their match (`depth: 121`)" in one for one in notes
    )
    arcs = tuple(replace(one, depth=121) for one in of.arcs)
    deep = replace(of, arcs=arcs, arcs_into={"slow": (), "fast": (), "fuse": arcs})
    assert _ms(analyse_system(deep).paces["fuse"].gap) == 242


def test_messages_of_one_job_match_at_once() -> None:
    camera = timed("camera", 50, 3, outputs=("left", "right"))
    arcs = [replace(arc("camera", "stereo"), output=side, input=side, topic=f"/{side}") for side in ("left", "right")]
    stereo = event("stereo", 1, "left", "right", mode="match", within=0)
    analysis = analyse_system(system((camera, stereo), arcs))
    assert _ms(analysis.paces["stereo"].gap) == 50
    # Each message has its match: the rate is that of the camera, and not at most that.
    assert (analysis.paces["stereo"].rate.value, analysis.paces["stereo"].rate.side) == (20, "exact")
    assert {key: _ms(wait) for key, wait in analysis.matches["stereo"].waits.items()} == {"left": 0, "right": 0}
    assert [(_ms(fused.apart), _ms(fused.ages["left"])) for fused in find_fused_inputs(analysis)] == [(0, 3)]


def test_how_far_apart_what_waits_for_all_may_be() -> None:
    """`slow` may have waited 30 ms for `fast`, or `fast` 30 ms (its own gap) for `slow`; the other is 1 ms old or new."""
    of = _pair(100, 30, within=None)
    (fused,) = find_fused_inputs(analyse_system(of))
    assert {key: _ms(age) for key, age in fused.ages.items()} == {"slow": 30, "fast": 30}
    assert (_ms(fused.apart), fused.within) == (30, None)


def test_no_simulated_match_is_older_or_rarer_than_its_bound() -> None:
    for seed in range(40):
        dice = random.Random(seed)  # noqa: S311 - a test's dice
        slow, fast = dice.choice((40, 50, 100)), dice.choice((5, 10, 20, 30))
        analysis = analyse_system(_pair(slow, fast, within=dice.choice((5, 20, 40)), jitter=dice.choice((0, 3, fast))))
        _hold(analysis)


def test_no_stream_of_messages_waits_longer_than_its_bound() -> None:
    """Beside the analysis: stamps at random gaps, delays at random, up to four inputs, straight into the matcher."""
    sure_count = 0
    for seed in range(150):
        dice = random.Random(seed)  # noqa: S311
        within = dice.choice((3, 5, 10, 20))
        slow = dice.randrange(count := dice.choice((2, 2, 3, 4)))
        gaps = [dice.choice((10, 33, 50)) if number == slow else dice.randint(1, within) for number in range(count)]
        inputs = [MatchedInput(gap, best := dice.choice((0, 1)), best + dice.choice((0, 3, 9))) for gap in gaps]
        windows = find_match_windows(inputs, within, same_source=False)
        assert windows.waits is not None
        assert windows.gap is not None
        sure_count += 1
        arrivals = _draw_arrivals(dice, inputs)
        sets = _match(arrivals, count, within)
        times = [time for time, _ in sets]
        assert max(later - time for time, later in pairwise(times)) <= windows.gap
        for time, stamps in sets:
            assert all(time - stamp <= age for stamp, age in zip(stamps, windows.ages, strict=True))
        for time, number, stamp in arrivals:
            if stamp < 600:
                use = next(used for used, stamps in sets if used >= time and stamps[number] >= stamp)
                assert use - time <= windows.waits[number]
    assert sure_count == 150


def _draw_arrivals(dice: random.Random, inputs: list[MatchedInput]) -> list[tuple[int, int, int]]:
    """Draw (arrival, input, stamp); messages of one input keep their order."""
    arrivals: list[tuple[int, int, int]] = []
    for number, (gap, best, worst) in enumerate(inputs):
        stamp, last = dice.randint(0, gap), 0
        while stamp < 1000:
            last = max(last, stamp + dice.choice((best, worst, dice.randint(best, worst))))
            arrivals.append((last, number, stamp))
            stamp += dice.choice((gap, gap, dice.randint(1, gap)))
    return sorted(arrivals)


def _match(arrivals: list[tuple[int, int, int]], count: int, within: int) -> list[tuple[int, list[int]]]:
    matcher = make_matcher([10_000] * count, within)
    return [
        (time, [each[0] for each in matched])
        for time, number, stamp in arrivals
        for matched in matcher.add_sample(number, (stamp, number, 0))
    ]


def _hold(analysis: Analysis) -> None:
    """Hold a simulation against the gap, the age and the distance of what is matched."""
    seen = simulate_system(analysis.system, 3, 6).activities["fuse"]
    figures, response = analysis.matches["fuse"], analysis.responses["fuse"].worst.value or 0
    oldest = max(age.value or 0 for age in figures.ages.values())
    assert seen.fused_age is None or seen.fused_age <= oldest + response
    within = (analysis.system.activities["fuse"].within or 0) * analysis.system.tick
    assert seen.fused_spread is None or seen.fused_spread <= within
    if figures.gap.value is not None:
        assert seen.activation_gap is not None
        assert seen.activation_gap <= figures.gap.value


def _pair(slow: int, fast: int, *, within: int | None, jitter: int = 0) -> TimingSystem:
    """Return two sensors without execution time, and what matches them (or waits for both)."""
    sensors: list[Activity] = [
        timed("slow", slow, 0, outputs=("out",)),
        timed("fast", fast, 0, outputs=("out",), jitter=jitter),
    ]
    mode = {"mode": "all"} if within is None else {"mode": "match", "within": within}
    fuse = event("fuse", 1, "slow", "fast", **mode)
    return system((*sensors, fuse), [arc("slow", "fuse"), arc("fast", "fuse")])


def _ms(value: object) -> Fraction:
    return value.value / 10**6  # type: ignore[attr-defined, no-any-return]


@pytest.mark.parametrize(("is_called", "age"), [(False, 140), (True, 140 + 270)])
def test_a_call_works_again_with_a_match_that_may_be_a_gap_old(*, is_called: bool, age: int) -> None:
    of = _pair(100, 30, within=40)
    if is_called:
        caller = timed("caller", 50, 1)
        request, answer = call("caller", "fuse")
        of = system((*of.activities.values(), caller), (*of.arcs, request, answer))
    analysis = analyse_system(of)
    slow = next(one for one in of.arcs if one.source == "slow")
    assert _ms(StepDelays.of_analysis(analysis).holding_age(slow)) == age
