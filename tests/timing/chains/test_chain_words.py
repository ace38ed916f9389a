"""Chains beyond the sum: Dürr's bounds and where they do not hold, regions of elements, cut loops, data age, verdicts."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.model.architecture import Waypoint
from archgen.timing.chains import path_states
from archgen.timing.chains.chain_bounds import (
    bound_all_chains,
    find_data_age,
    find_paths_between,
    find_unmet_chains,
    list_bounded_paths,
)
from archgen.timing.chains.chain_regions import lay_out_chain
from archgen.timing.chains.chain_verdicts import judge_deadline
from archgen.timing.chains.cost_network import CostNetwork, PathAim
from archgen.timing.chains.duerr_bounds import PeriodicTask, bound_periodic_chain, bound_reaction, bound_reduced_age
from archgen.timing.chains.element_index import ChainPoint, ElementIndex
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import MS, show_ms
from tests.timing.random_systems import architecture
from tests.timing.sketches import analyse_sketch, read_sketch

TASKS = tuple(PeriodicTask(Fraction(period), Fraction(response)) for period, response in ((10, 2), (20, 30), (15, 4)))


def test_duerr_by_hand() -> None:
    """T1 + R3 + max(R1, T2 + p R1) + max(R2, T3 + p R2), and R3 + T1 + p R1 + T2 + p R2 (p = 0 with precedence)."""
    assert bound_reaction(TASKS, (False, False)) == 10 + 4 + (20 + 2) + (15 + 30)
    assert bound_reaction(TASKS, (True, True)) == 10 + 4 + 20 + 30
    assert bound_reduced_age(TASKS, (False, False)) == 4 + (10 + 2) + (20 + 30)
    assert bound_reduced_age(TASKS, (True, False)) == 4 + 10 + (20 + 30)


@pytest.mark.parametrize(
    ("a", "b", "bounds"),
    [
        # a before b on one core: 10 + 3 + max(1, 20) and 3 + 10; turned round 10 + 2 + (20 + 3) and 2 + (10 + 3).
        (
            "a @p: period: 10 ms, wcet: 1 ms, priority: 2",
            "b @p: period: 20 ms, wcet: 2 ms, priority: 1, inputs: {a: {stored: at_once}}",
            (33, 13),
        ),
        # While `a` works, what `b` reads may wait to be stored.
        ("a @p: period: 10 ms, wcet: 1 ms, priority: 2", "b @p: period: 20 ms, wcet: 2 ms, priority: 1", None),
        ("a @p: period: 10 ms, wcet: 1 ms, priority: 1", "b @p: period: 20 ms, wcet: 2 ms, priority: 2", (35, 15)),
        (
            "a @p: period: 10 ms, wcet: 1 ms, priority: 2",
            "b @p: period: 20 ms, wcet: 2 ms, priority: 2, inputs: {a: {stored: at_once}}",
            (36, 16),
        ),
        ("a: period: 10 ms, response: 1 ms", "b: period: 20 ms, response: 2 ms", (33, 13)),
        ("a @p: period: 10 ms, response: 1 ms", "b @p: period: 20 ms, response: 2 ms, priority: 1", (33, 13)),
        ("a @p: period: 10 ms, wcet: 1 ms", "b @p: period: 20 ms, wcet: 2 ms, priority: 1", None),
        ("a @p: period: 10 ms, response: 1 ms", "b @q: period: 20 ms, response: 2 ms", None),
        ("a: period: 10 ms, response: 1 ms", "b: trigger: [a], response: 2 ms", None),
        # An overload has no response, though nothing is missing of it.
        ("a @p: period: 10 ms, wcet: 11 ms, priority: 2", "b @p: period: 20 ms, wcet: 2 ms, priority: 1", None),
        ("a: period: 10 ms, response: 1 ms", "b: behaviour: periodic, response: 2 ms", None),
        ("a: period: 10 ms, response: 1 ms", "b: period: 20 ms", None),
    ],
)
def test_duerr_holds_for_periodic_elements_with_priorities_and_no_link(
    a: str, b: str, bounds: tuple[int, int] | None
) -> None:
    nodes = dict(row.split(": ", 1) for row in (a, b))
    rest = "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], latency: 1 ms}}"
    analysis = analyse_sketch(nodes, "a>b", rest)
    found = bound_periodic_chain(analysis, ("a", "b"))
    assert found == (None if bounds is None else tuple(count * MS for count in bounds))
    assert bound_periodic_chain(analysis, ("a",)) is None
    assert bound_periodic_chain(analysis, ("b", "a")) is None


WAYS = read_sketch(
    {
        "a": "period: 60 ms, wcet: 1 ms, bcet: 1 ms",
        "b": "wcet: 2 ms, bcet: 1 ms",
        "c": "wcet: 3 ms, bcet: 3 ms",
        "d": "wcet: 4 ms, bcet: 4 ms",
        "lone": "wcet: 1 ms",
    },
    "a>b a>c b>d c>d a>d b>c",
)


@pytest.mark.parametrize(
    ("aim", "limit", "lines"),
    [
        ("bound", 9, ["a b c d 85", "a c d 83", "a b d 79", "a d 77"]),
        ("bound", 2, ["a b c d 85", "a c d 83"]),
        ("best", 2, ["a d 5", "a b d 6"]),
    ],
)
def test_ways_from_one_element_to_another(aim: PathAim, limit: int, lines: list[str]) -> None:
    """60 + 1, then 2 (b), 2 x 3 (c is fired by a and b), 4 x 4 (d by each of the four ways): 60 + 1 + 2 + 6 + 16."""
    analysis = analyse_architecture(WAYS)
    network = CostNetwork.of_analysis(analysis)
    paths = find_paths_between(network, WAYS, Waypoint("node", "a"), Waypoint("node", "d"), aim)
    assert paths is not None
    assert paths.path_count == 4
    found = [
        f"{' '.join(path.through)} {float((path.bound.value or 0) / MS):g}"
        for path in list_bounded_paths(network, paths, limit)
    ]
    assert found == lines
    nowhere = find_paths_between(network, WAYS, Waypoint("node", "a"), Waypoint("node", "lone"))
    assert nowhere is not None
    assert nowhere.path_count == 0
    assert find_paths_between(network, WAYS, Waypoint("node", "a"), Waypoint("node", "gone")) is None
    assert find_paths_between(network, WAYS, Waypoint("node", "gone"), Waypoint("node", "a")) is None


def _exact(number: int | None, *assumptions: str) -> TimingValue:
    return TimingValue(None if number is None else Fraction(number), assumptions=assumptions)


def _at_least(number: int, *assumptions: str) -> TimingValue:
    return TimingValue(Fraction(number), complete=False, assumptions=assumptions, side="at least")


@pytest.mark.parametrize(
    ("bound", "best", "deadline", "verdict"),
    [
        (_exact(5), 0, _exact(5), "met"),
        (_exact(6), 5, _exact(5), "not proven"),
        (_exact(7), 6, _exact(5), "missed"),
        (_exact(6), 6, None, "open"),
        (_exact(6), 6, _exact(None), "open"),
        (_exact(None, "overload"), 0, _exact(5), "missed"),
        (_exact(None, "unbounded"), 0, _exact(5), "missed"),
        (_exact(None, "diverged"), 0, _exact(5), "not proven"),
        (_exact(None, "diverged"), 6, _exact(5), "missed"),
        (_at_least(4, "diverged"), 0, _exact(5), "not proven"),
        (replace(_at_least(4, "diverged"), missing=("x",)), 0, _exact(5), "open"),
        (_at_least(5), 0, _exact(5), "open"),
        (_at_least(6), 0, _exact(5), "not proven"),
        (_at_least(5), 6, _exact(5), "missed"),
        (TimingValue(Fraction(5), side="at most"), 0, _exact(5), "met"),
    ],
)
def test_only_what_is_shown_to_be_possible_is_missed(
    bound: TimingValue, best: int, deadline: TimingValue | None, verdict: str
) -> None:
    assert judge_deadline(bound, _at_least(best), deadline) == verdict


LATE = """
chains:
  late: {through: [a, b], deadline: 12 ms}
  fine: {through: [a, b], deadline: 13 ms}
  free: {through: [a, b]}
  event: {through: [b, c], deadline: 1 ms}
  lost: {through: [c, a], deadline: 1 ms}
"""


def test_missed_chains_and_the_age_of_data() -> None:
    """10 + 1 + 2; of an event 2 + 3, and its data is older by the gap of b."""
    nodes = {"a": "period: 10 ms, wcet: 1 ms, bcet: 1 ms", "b": "wcet: 2 ms, bcet: 2 ms", "c": "wcet: 3 ms"}
    model = read_sketch(nodes, "a>b b>c", LATE)
    analysis = analyse_architecture(model)
    assert [
        (late.chain.id, late.bound.value, late.verdict, len(late.terms))
        for late in find_unmet_chains(analysis, model, Fraction(0))
    ] == [
        ("late", 13 * MS, "not proven", 2),
        ("event", 5 * MS, "missed", 2),
    ]
    network, chains = CostNetwork.of_analysis(analysis), bound_all_chains(analysis, model)
    assert find_data_age(network, chains["fine"]).value == 13 * MS
    assert find_data_age(network, chains["event"]).value == (2 + 3 + 10) * MS
    assert find_data_age(network, chains["lost"]) is chains["lost"].bound
    wrong = replace(model, chains={"late": replace(model.chains["late"], unresolved=("x",))})
    assert list(find_unmet_chains(analysis, wrong, Fraction(0))) == []
    assert show_ms(bound_all_chains(analysis, wrong)["late"].bound) == "none ?x [`x` is not resolved]"


def _ring(count: int) -> str:
    return " ".join(f"c{first}>c{second}" for first in range(count) for second in range(count) if first != second)


@pytest.mark.parametrize(
    ("count", "text"),
    [
        (3, "the loops are large: ways that go back along c2 > c1 are left out"),
        (4, "the loops are large: ways that go back along c2 > c1, c3 > c1, c3 > c2 are left out"),
        (5, "the loops are large: ways that go back along c2 > c1, c3 > c1, c3 > c2 and 3 more are left out"),
    ],
)
def test_loops_that_are_too_large_are_cut_and_named(monkeypatch: pytest.MonkeyPatch, count: int, text: str) -> None:
    monkeypatch.setattr(path_states, "MAX_STATES", 2)
    nodes = {f"c{index}": "period: 10 ms, wcet: 1 ms" for index in range(count)} | {"end": "period: 10 ms, wcet: 1 ms"}
    wires = f"{_ring(count)} c{count - 1}>end"
    model = read_sketch(nodes, wires, "chains: {way: {through: [c0, end]}}")
    (chain,) = bound_all_chains(analyse_architecture(model), model).values()
    assert [assumption for assumption in chain.bound.assumptions if "loops" in assumption] == [text]


POINTS = architecture("""
groups:
  g:
    components:
      eye: {outputs: {left: std_msgs/msg/Empty, right: std_msgs/msg/Empty}}
      ear: {outputs: {out: std_msgs/msg/Empty}}
      mind: {inputs: {l: eye.left, r: eye.right, e: ear.out}}
nodes:
  head: {implements: [g.eye, g.ear]}
  brain: {implements: g.mind}
  spare: {implements: g.eye}
""")


@pytest.mark.parametrize(
    ("kind", "id_", "activities", "output"),
    [
        ("node", "head", ("head.eye", "head.ear"), None),
        ("node", "head.ear", ("head.ear",), None),
        ("node", "brain", ("brain",), None),
        ("node", "gone", (), None),
        ("component", "g.eye", ("head.eye", "spare"), None),
        ("component", "g.gone", (), None),
        ("output", "g.eye.left", ("head.eye", "spare"), "g.eye.left"),
        ("output", "g.gone.out", (), "g.gone.out"),
    ],
)
def test_an_element_stands_for_activities(kind: str, id_: str, activities: tuple[str, ...], output: str | None) -> None:
    system = analyse_architecture(POINTS).system
    (point,) = ElementIndex(system, POINTS).resolve_points((Waypoint(kind, id_),))  # type: ignore[arg-type]
    assert (point.activities, point.output) == (activities, output)


@pytest.mark.parametrize(
    ("through", "gap"),
    [
        ("[a, b, lone]", "no way leads from `b` to `lone`"),
        ("[lone, a, b]", "no way leads from `lone` to `a`"),
        ("[a, b, c, lone]", "no way leads from `c` to `lone`"),
    ],
)
def test_the_first_two_elements_that_nothing_joins_are_named(through: str, gap: str) -> None:
    nodes = dict.fromkeys(("a", "b", "c", "lone"), "period: 10 ms, wcet: 1 ms")
    model = read_sketch(nodes, "a>b b>c", f"chains: {{way: {{through: {through}}}}}")
    (chain,) = bound_all_chains(analyse_architecture(model), model).values()
    assert chain.bound.assumptions == (gap,)


def test_of_equal_ways_the_one_with_an_unknown_figure_is_shown() -> None:
    """By `b` nothing is added, by `c` nobody knows how much: 10 + 10 is the least that there is."""
    nodes = {
        "a": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
        "b": "wcet: 0 ms",
        "c": "",
        "d": "period: 10 ms, wcet: 0 ms",
    }
    for wires in ("a>b a>c b>d c>d", "a>c a>b c>d b>d"):
        model = read_sketch(nodes, wires, "chains: {way: {through: [a, d]}}")
        (chain,) = bound_all_chains(analyse_architecture(model), model).values()
        assert (chain.through, show_ms(chain.bound)) == (
            ("a", "c", "d"),
            ">= 20 ?c [assuming a dedicated core]",
        )


def test_an_output_is_left_at_once() -> None:
    """Two nodes do the work of `a`, each of which reads what both send: a chain that begins with the output leaves it at once,
    10 + 1 + 2, one through the component may go from the one node to the other first, 10 more.
    """
    model = architecture("""
groups: {g: {components: {
  a: {outputs: {out: std_msgs/msg/Empty}, inputs: {back: a.out}},
  b: {inputs: {i: a.out}}}}}
nodes:
  one: {implements: a, publishes: {out: /t}, subscribes: {back: /t}, timing: {period: 10 ms, wcet: 1 ms, inputs: {back: {memory: each_source}}}}
  two: {implements: a, publishes: {out: /t}, subscribes: {back: /t}, timing: {period: 10 ms, wcet: 1 ms, inputs: {back: {memory: each_source}}}}
  b: {implements: b, timing: {wcet: 1 ms}}
chains: {output: {through: [a.out, b]}, component: {through: [a, b]}}
""")
    chains = bound_all_chains(analyse_architecture(model), model)
    assert [(chain.id, len(chain.through)) for chain in chains.values()] == [("output", 2), ("component", 3)]
    # Two messages may wait for b at once: 2 ms.
    assert [chain.bound.value for chain in chains.values()] == [13 * MS, 24 * MS]


@pytest.mark.parametrize(
    ("deadline", "margin", "is_late"),
    [
        # Bound are 10 + 1 + 2 = 13 ms. Half of 26 ms must stay free: 13 are left.
        ("26 ms", Fraction(1, 2), False),
        ("26 ms", Fraction(51, 100), True),
        ("13 ms", Fraction(0), False),
        ("13 ms", Fraction(1, 1000), True),
        ("12.999 ms", Fraction(0), True),
    ],
)
def test_a_margin_is_a_share_of_the_deadline(deadline: str, margin: Fraction, is_late: object) -> None:
    nodes = {"a": "period: 10 ms, wcet: 1 ms, bcet: 1 ms", "b": "wcet: 2 ms"}
    model = read_sketch(nodes, "a>b", f"chains: {{way: {{through: [a, b], deadline: {deadline}}}}}")
    missed = [late.chain.id for late in find_unmet_chains(analyse_architecture(model), model, margin)]
    assert missed == (["way"] if is_late else [])


@pytest.mark.parametrize(
    ("b", "c", "through", "bound"),
    [
        # 30 Hz is 33 1/3 ms, 29 Hz 34 14/29 ms: fractions are compared exactly.
        ("rate: 30 Hz", "period: 33 ms", "b", Fraction(100, 3)),
        ("rate: 30 Hz", "period: 34 ms", "c", 34),
        ("rate: 30 Hz", "rate: 29 Hz", "c", Fraction(1000, 29)),
        ("period: 33.333333 ms", "rate: 30 Hz", "c", Fraction(100, 3)),
        # What has no bound outweighs everything else, whatever it is.
        ("period: 1000 s", "behaviour: once", "c", None),
    ],
)
def test_the_longer_of_two_ways_is_found(b: str, c: str, through: str, bound: Fraction | None) -> None:
    nodes = {"a": "period: 1 ms", "b": b, "c": c, "d": "period: 1 ms"}
    nodes = {name: f"{timing}, wcet: 0 ms, bcet: 0 ms" for name, timing in nodes.items()}
    for wires in ("a>b a>c b>d c>d", "a>c a>b c>d b>d"):
        model = read_sketch(nodes, wires, "chains: {way: {through: [a, d]}}")
        (chain,) = bound_all_chains(analyse_architecture(model), model).values()
        assert chain.through == ("a", through, "d")
        assert chain.bound.value == (None if bound is None else (1 + bound + 1) * MS)


def test_a_gap_that_is_no_bound_is_not_told() -> None:
    """What fires `r` is sent each 10 ms, and up to an unknown time later: that it reads `a` each 10 ms, nobody can say."""
    nodes = {"a": "period: 5 ms, wcet: 1 ms, bcet: 1 ms", "dark": "period: 10 ms", "r": "trigger: [dark], wcet: 1 ms"}
    model = read_sketch(nodes, "a>r dark>r", "chains: {way: {through: [a, r]}}")
    analysis = analyse_architecture(model)
    assert show_ms(analysis.paces["r"].gap) == ">= 10 ?dark"
    (chain,) = bound_all_chains(analysis, model).values()
    assert [term.why for term in chain.terms] == ["samples the world every 5 ms at the latest", "reads /g/a/out"]


@pytest.mark.parametrize(
    ("latency", "bound", "notes"),
    [
        # 1 kB takes 1 ms, twice as two readers each have a copy; what is written counts, be it nothing.
        ("0 ms", 10 + 0 + 2, ["link lan keeps its written latency, though 2 ms of traffic can wait for it"]),
        (
            "1.9 ms",
            10 + Fraction(19, 10) + 2,
            ["link lan keeps its written latency, though 2 ms of traffic can wait for it"],
        ),
        ("2 ms", 10 + 2 + 2, ["queueing on link lan (up to 2 ms) is within its latency"]),
    ],
)
def test_a_written_latency_counts_with_a_note_on_what_can_wait(latency: str, bound: Fraction, notes: list[str]) -> None:
    nodes = {"a @p": "period: 10 ms, wcet: 0 ms, bcet: 0 ms", "b @q": "response: 2 ms", "c @q": "response: 2 ms"}
    rest = (
        "hosts: {p: {cores: 1}, q: {cores: 1}}\n"
        f"links: {{lan: {{connects: [p, q], bandwidth: 8 Mbit/s, latency: {latency}}}}}\n"
        "chains: {way: {through: [a, b]}}"
    )
    model = read_sketch(nodes, "a>b a>c", rest)
    (chain,) = bound_all_chains(analyse_architecture(model), model).values()
    assert chain.bound.value == bound * MS
    assert [note for note in chain.bound.assumptions if "lan" in note] == notes


def test_ways_that_meet_in_no_activity_are_no_way() -> None:
    """`a` reaches `b` on the one node, and `c` is fed by `b` on the other: nothing passes between both."""
    model = architecture("""
groups: {g: {components: {
  a: {outputs: {out: std_msgs/msg/Empty}},
  b: {inputs: {i: a.out}, outputs: {out: std_msgs/msg/Empty}},
  c: {inputs: {i: b.out}}}}}
nodes:
  one: {implements: b, subscribes: {i: /g/a/out}, publishes: {out: /one}}
  two: {implements: b, subscribes: {i: /nobody}, publishes: {out: /two}}
  c: {implements: c, subscribes: {i: /two}}
chains: {way: {through: [a, b, c], deadline: 1 s}}
""")
    (chain,) = bound_all_chains(analyse_architecture(model), model).values()
    assert (show_ms(chain.bound), chain.verdict) == ("none ? [no way leads through all elements]", "open")


def test_without_elements_or_activities_there_is_no_route() -> None:
    network = CostNetwork.of_analysis(analyse_sketch({"a": "period: 10 ms", "b": "wcet: 1 ms"}, "a>b"))
    a, b, gone = ChainPoint(("a",)), ChainPoint(("b",)), ChainPoint(())
    assert lay_out_chain(network, ()) == ()
    assert lay_out_chain(network, (a, gone)) == lay_out_chain(network, (gone, b)) == ()
    assert len(lay_out_chain(network, (a, b))) == 2


@pytest.mark.parametrize(
    ("timing", "why"),
    [
        ("", "triggered by /g/a/out"),
        ("every: 1", "triggered by /g/a/out"),
        ("every: 2", "triggered by /g/a/out; fires only once for 2 triggers"),
        ("throttle: 5 ms", "triggered by /g/a/out; keeps a smallest gap"),
        ("jitter: 1 ms", "triggered by /g/a/out; starts late by its jitter"),
        (
            "every: 3, throttle: 5 ms, jitter: 1 ms",
            "triggered by /g/a/out; fires only once for 3 triggers, keeps a smallest gap, starts late by its jitter",
        ),
    ],
)
def test_why_a_trigger_waits(timing: str, why: str) -> None:
    nodes = {"a": "period: 10 ms, wcet: 1 ms, bcet: 1 ms", "b": timing}
    model = read_sketch(nodes, "a>b", "chains: {way: {through: [a, b]}}")
    (chain,) = bound_all_chains(analyse_architecture(model), model).values()
    assert chain.terms[1].why == why
