"""Chains against published figures and by hand."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains import duerr_bounds
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.timing import random_systems
from tests.timing.made import analysis, arc, architecture, event, missing, periodic
from tests.timing.sketches import analyse_sketch, read_sketch

S1 = {"a": (10, 1), "b": (20, 3)}
S2 = {"imu": (5, 1), "ctrl": (10, 3), "loc": (20, 8), "plan": (100, 55)}


def _all_periodic(tasks: dict[str, tuple[int, int]]) -> Analysis:
    order = {name: 100 - at for at, name in enumerate(tasks)}
    activities = [periodic(name, period, priority=order[name]) for name, (period, _) in tasks.items()]
    arcs = [arc(one, other) for one in tasks for other in tasks if one != other]
    responses = {name: response for name, (_, response) in tasks.items()}
    return analysis(activities, arcs, responses, {name: period for name, (period, _) in tasks.items()})


def _one(found: Analysis, *through: str, deadline: int | None = None) -> ChainResult:
    return bound_all_chains(found, architecture(tuple(found.system.activities), *through, deadline=deadline))["c"]


def _ms(value: TimingValue) -> Fraction | None:
    return value.value / 10**6 if value.value is not None else None


@pytest.mark.parametrize(
    ("tasks", "through", "davare", "reaction", "age"),
    [
        (S1, "a b", 34, 33, 13),
        (S1, "b a", 34, 34, 24),
        (S2, "imu ctrl", 19, 18, 8),
        (S2, "imu loc plan ctrl", 202, 193, 183),
        (S2, "plan ctrl imu", 174, 174, 169),
    ],
)
def test_periodic_chains_reach_the_published_figures(
    tasks: dict[str, tuple[int, int]], through: str, davare: int, reaction: int, age: int
) -> None:
    found = _all_periodic(tasks)
    result = _one(found, *through.split())
    assert _ms(result.bound) == davare
    assert result.bound.complete
    assert [term.activity for term in result.terms] == through.split()
    assert _ms(result.reduced_reaction) == davare - tasks[through.split(maxsplit=1)[0]][0]
    assert duerr_bounds.bound_periodic_chain(found, result.through) == (
        Fraction(reaction * 10**6),
        Fraction(age * 10**6),
    )


@pytest.mark.parametrize(
    ("wires", "gap", "bound", "age"),
    [
        ("front>boxes rear>boxes boxes>stop", 8, 40 + 1 + 20 + 8 + 2, 71),  # by the sum of its own steps 125
        ("rear>boxes boxes>stop", 50, 40 + 1 + 10 + 50 + 2, 64),
    ],
)
def test_what_is_sent_is_never_older_than_the_data_age(wires: str, gap: int, bound: int, age: int) -> None:
    nodes = {
        "front": "period: 40 ms, wcet: 1 ms",
        "rear": "period: 40 ms, wcet: 1 ms",
        "boxes": "behaviour: event, wcet: 10 ms",
        "stop": f"period: {gap} ms, wcet: 2 ms",
    }
    sketch = nodes, wires, "chains: {c: {through: [rear, boxes, stop]}}"
    result = bound_all_chains(analyse_sketch(*sketch), read_sketch(*sketch))["c"]
    assert (_ms(result.bound), _ms(result.reduced_age)) == (bound, age)


TWO_NODES_OF_ONE_ELEMENT = """
hosts: {pc: {cores: 1}, arm: {cores: 1}}
links: {lan: {connects: [pc, arm], latency: 1 ms}}
groups:
  g:
    components:
      camera: {outputs: {small: std_msgs/msg/Empty}}
      finder: {inputs: {image: camera.small}}
nodes:
  driver: {implements: camera, host: pc, internal: {publishes: {raw: {topic: /raw, message: std_msgs/msg/Empty}}}, timing: {period: 60 ms, wcet: 7 ms}}
  thinner: {implements: camera, host: pc, internal: {subscribes: {raw: {topic: /raw, message: std_msgs/msg/Empty}}}, publishes: {small: /small}, timing: {behaviour: event, wcet: 20 ms}}
  reader: {implements: finder, host: arm, timing: {period: 50 ms, wcet: 2 ms}}
chains: {c: {through: [g.camera, g.finder]}}
"""


def test_what_the_samples_of_the_first_element_fire_is_no_older_than_they_are() -> None:
    """`thinner` may work 87 ms apart, so that what it sends is used again: but no longer than the sample behind it."""
    model = random_systems.architecture(TWO_NODES_OF_ONE_ELEMENT)
    result = bound_all_chains(analyse_architecture(model), model)["c"]
    assert result.through == ("driver", "thinner", "reader")
    # 60 + a run of 27 + 1 + 50 + 2. By the sum of its own steps 27 + 1 + (87 + 27) + 2: what it sent is used until the next comes.
    assert (_ms(result.bound), _ms(result.reduced_age)) == (140, 140)


def test_what_an_event_brought_may_be_used_until_the_next_which_may_never_come() -> None:
    nodes = {
        "clock": "period: 10 ms, wcet: 1 ms, outputs: {out: {conditional: true}}",
        "alarm": "behaviour: event, wcet: 1 ms",
        "stop": "period: 8 ms, wcet: 2 ms",
    }
    sketch = nodes, "clock>alarm alarm>stop", "chains: {c: {through: [alarm, stop]}}"
    result = bound_all_chains(analyse_sketch(*sketch), read_sketch(*sketch))["c"]
    assert (_ms(result.bound), result.reduced_age.value, "unbounded" in result.reduced_age.assumptions) == (
        11,
        None,
        True,
    )


def test_reduced_age_of_a_periodic_chain_is_response_and_gap_of_each_producer() -> None:
    # R_a + (T_a + R_b): a's sample lies for at most a's gap.
    assert _ms(_one(_all_periodic(S1), "a", "b").reduced_age) == 1 + 10 + 3


def test_an_event_chain_adds_responses_and_links_only() -> None:
    found = analysis(
        [periodic("cam", 100), event("det", "det.cam"), event("act", "act.det")],
        [arc("cam", "det", link="lan", best=1_000_000, worst=3_000_000), arc("det", "act")],
        {"cam": 5, "det": 40, "act": 2},
        {"cam": 100, "det": 100, "act": 100},
    )
    result = _one(found, "cam", "det", "act", deadline=150)
    assert _ms(result.bound) == 100 + 5 + 3 + 40 + 2
    assert _ms(result.reduced_reaction) == 50
    assert _ms(result.reduced_age) == 50
    assert _ms(result.best) == 5 + 1 + 40 + 2
    assert result.verdict == "met"
    from_event = _one(found, "det", "act").bound
    assert _ms(from_event) == 42
    assert from_event.assumptions == (
        "the reaction counts from the event that fires det; data age is larger by its largest gap (100 ms)",
    )


def test_a_sampled_input_waits_for_the_readers_next_activation() -> None:
    found = analysis(
        [periodic("map", 1000), periodic("cam", 100), event("det", "det.cam")],
        [arc("map", "det"), arc("cam", "det")],
        {"map": 10, "cam": 5, "det": 40},
        {"map": 1000, "cam": 100, "det": 100},
        {"map": 1003},
    )
    result = _one(found, "map", "det")
    assert _ms(result.bound) == 1000 + 10 + 100 + 40
    assert _ms(result.reduced_age) == 10 + 1003 + 40


def test_all_of_waits_for_the_slowest_of_the_others() -> None:
    found = analysis(
        [
            periodic("l", 30),
            periodic("r", 50),
            periodic("x", 70),
            event("pair", "pair.l", "pair.r", "pair.x", mode="all"),
        ],
        [arc("l", "pair"), arc("r", "pair"), arc("x", "pair")],
        {"l": 1, "r": 1, "x": 1, "pair": 4},
        {"l": 30, "r": 50, "x": 70, "pair": 70},
    )
    assert _ms(_one(found, "l", "pair").bound) == 30 + 1 + 70 + 4
    assert _ms(_one(found, "x", "pair").bound) == 70 + 1 + 50 + 4
    assert _ms(_one(found, "l", "pair").reduced_age) == 1 + 30 + 4  # its own gap is smaller than 70
    assert _ms(_one(found, "x", "pair").reduced_age) == 1 + 50 + 4


def test_any_of_sends_old_data_again() -> None:
    found = analysis(
        [periodic("l", 30), periodic("r", 50), event("mix", "mix.l", "mix.r")],
        [arc("l", "mix"), arc("r", "mix")],
        {"l": 1, "r": 1, "mix": 4},
        {"l": 30, "r": 50, "mix": 30},
    )
    result = _one(found, "r", "mix")
    assert _ms(result.bound) == 50 + 1 + 4
    assert _ms(result.reduced_age) == 1 + 50 + 4


def test_every_third_adds_two_gaps_and_a_throttle_its_gap_and_only_jitter_makes_data_older() -> None:
    thinned = event("slow", "slow.cam", every=3)
    throttled = event("slow", "slow.cam", throttle=250 * 10**6)
    both = event("slow", "slow.cam", every=3, throttle=250 * 10**6)
    late = event("slow", "slow.cam", jitter=7 * 10**6)
    for activity, extra, older in ((thinned, 200, 0), (throttled, 250 + 100, 0), (both, 250 + 300, 0), (late, 7, 7)):
        found = analysis(
            [periodic("cam", 100), activity, event("act", "act.slow")],
            [arc("cam", "slow"), arc("slow", "act")],
            {"cam": 5, "slow": 10, "act": 2},
            {"cam": 100, "slow": 300, "act": 300},
        )
        assert _ms(_one(found, "cam", "slow", "act").bound) == 100 + 5 + extra + 10 + 2
        assert _ms(_one(found, "cam", "slow", "act").reduced_age) == 17 + older


def test_what_is_missing_is_named_and_the_rest_adds_up() -> None:
    found = analysis(
        [periodic("cam", 100), periodic("det", 50)],
        [arc("cam", "det")],
        {"cam": missing("cam"), "det": missing("det")},
        {"cam": 100, "det": 50},
    )
    result = _one(found, "cam", "det", deadline=500)
    assert result.bound == TimingValue(Fraction(150 * 10**6), complete=False, missing=("cam", "det"), side="at least")
    assert result.verdict == "open"
    assert _one(found, "cam", "det", deadline=120).verdict == "not proven"
    assert result.best.value is None  # nothing is known of it; zero is never made up


def test_a_figure_known_from_below_bounds_the_best_case_alone() -> None:
    """100 + 5 + 50 ms, and at least 3 ms of `det`; at best 5 + 3 ms or more."""
    at_least = TimingValue(Fraction(3 * 10**6), complete=False, missing=("det",), side="at least")
    found = analysis(
        [periodic("cam", 100), periodic("det", 50)],
        [arc("cam", "det")],
        {"cam": 5, "det": at_least},
        {"cam": 100, "det": 50},
    )
    result = _one(found, "cam", "det", deadline=500)
    assert (_ms(result.bound), result.bound.complete, result.verdict) == (158, False, "open")
    assert (_ms(result.best), result.best.complete, result.best.side) == (8, True, "at least")


def test_an_overloaded_host_makes_the_chain_boundless() -> None:
    found = analysis(
        [periodic("cam", 100), periodic("det", 50)],
        [arc("cam", "det")],
        {"cam": 5, "det": TimingValue(None, assumptions=("overload",))},
        {"cam": 100, "det": 50},
    )
    result = _one(found, "cam", "det", deadline=500)
    assert (result.bound.value, result.bound.assumptions, result.verdict) == (None, ("overload",), "missed")


def test_neighbours_that_no_edge_joins_take_the_worst_way_between_them() -> None:
    found = analysis(
        [periodic("a", 10), event("b", "b.a"), event("c", "c.a"), event("d", "d.b", "d.c")],
        [arc("a", "b"), arc("a", "c"), arc("b", "d"), arc("c", "d")],
        {"a": 1, "b": 7, "c": 9, "d": 2},
        {"a": 10, "b": 10, "c": 10, "d": 10},
    )
    result = _one(found, "a", "d")
    assert result.through == ("a", "c", "d")
    assert _ms(result.bound) == 10 + 1 + 9 + 2
    assert _ms(result.best) == 1 + 7 + 2


def test_another_way_without_figures_leaves_the_bound_open() -> None:
    found = analysis(
        [periodic("a", 10), event("b", "b.a"), event("c", "c.a"), event("d", "d.b", "d.c")],
        [arc("a", "b"), arc("a", "c"), arc("b", "d"), arc("c", "d")],
        {"a": 1, "b": missing("b"), "c": 9, "d": 2},
        {"a": 10, "b": 10, "c": 10, "d": 10},
    )
    result = _one(found, "a", "d", deadline=100)
    assert _ms(result.bound) == 22
    assert (result.bound.complete, result.bound.missing) == (False, ("b",))
    assert result.verdict == "open"


def test_nothing_leads_there() -> None:
    found = analysis([periodic("a", 10), periodic("b", 10)], [], {"a": 1, "b": 1}, {"a": 10, "b": 10})
    result = _one(found, "a", "b", deadline=100)
    assert (result.bound.value, result.verdict) == (None, "open")
    assert result.bound.assumptions == ("no way leads from `a` to `b`",)


def test_a_share_is_met_by_the_bound_missed_by_the_best_case_and_else_open() -> None:
    rest = "chains: {c: {through: [a, b], deadline: {50 %: 1 ms, 90 %: 50 ms, 95 %: 102 ms}}}"
    model = read_sketch({"a": "period: 100 ms, wcet: 1 ms, bcet: 1 ms", "b": "wcet: 1 ms, bcet: 1 ms"}, "a>b", rest)
    result = bound_all_chains(analyse_architecture(model), model)["c"]
    assert result.deadline is None
    assert [(each.name, each.verdict) for each in result.shares] == [
        ("50 %", "missed"),
        ("90 %", "open"),
        ("95 %", "met"),
    ]
    assert [result.find_limit(Fraction(share, 100)) for share in (40, 90, 91, 99)] == [
        10**6,
        50 * 10**6,
        102 * 10**6,
        None,
    ]
