"""Response times and utilisation against figures from the literature; each set says where it stands."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.task_sets import MS, periodic, tasks, worst

Derived = Callable[[str], Architecture]
Rows = dict[str, tuple[str, str]]
"""Period and execution time in ms, the highest priority first."""


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        # C. L. Liu, J. W. Layland: Scheduling Algorithms for Multiprogramming in a Hard-Real-Time Environment, JACM 20(1),
        # 1973, section 3: periods 2 and 5. With 1 and 1 both orders do; the shorter period first lets the second take 2.
        ({"short": ("2", "1"), "long": ("5", "1")}, {"short": 1, "long": 2}),
        ({"long": ("5", "1"), "short": ("2", "1")}, {"long": 1, "short": 2}),
        ({"short": ("2", "1"), "long": ("5", "2")}, {"short": 1, "long": 4}),
        # L. Sha, J. B. Goodenough: Real-Time Scheduling Theory and Ada, IEEE Computer 23(4), 1990: the three tasks are
        # below the bound; with 40 in place of 20 they are not, and the third is done at 300 all the same.
        ({"one": ("100", "20"), "two": ("150", "40"), "three": ("350", "100")}, {"one": 20, "two": 60, "three": 240}),
        ({"one": ("100", "40"), "two": ("150", "40"), "three": ("350", "100")}, {"one": 40, "two": 80, "three": 300}),
        # A. Burns, A. Wellings: Real-Time Systems and Programming Languages, process sets A to D. A misses 50 by 2.
        ({"c": ("30", "10"), "b": ("40", "10"), "a": ("50", "12")}, {"c": 10, "b": 20, "a": 52}),
        ({"c": ("16", "4"), "b": ("40", "5"), "a": ("80", "32")}, {"c": 4, "b": 9, "a": 58}),
        ({"c": ("20", "5"), "b": ("40", "10"), "a": ("80", "40")}, {"c": 5, "b": 15, "a": 80}),
        ({"a": ("7", "3"), "b": ("12", "3"), "c": ("20", "5")}, {"a": 3, "b": 6, "c": 20}),
        # G. C. Buttazzo: Hard Real-Time Computing Systems, response time analysis: the fourth is done at 10.
        (
            {"one": ("4", "1"), "two": ("5", "1"), "three": ("6", "2"), "four": ("11", "1")},
            {"one": 1, "two": 2, "three": 4, "four": 10},
        ),
        # The same, rate monotonic against earliest deadline first: of 2/5 and 4/7 the second is done at 8, after its 7.
        ({"one": ("5", "2"), "two": ("7", "4")}, {"one": 2, "two": 8}),
    ],
)
def test_fixed_priorities(derived: Derived, rows: Rows, expected: dict[str, int]) -> None:
    found = analyse_architecture(derived(tasks({name: periodic(*row) for name, row in rows.items()})))
    assert worst(found) == expected
    assert {response.tier for response in found.responses.values()} == {"priorities"}


@pytest.mark.parametrize(
    ("rows", "verdict"),
    [
        # Burns and Wellings again: A is above its bound and misses, B is below, C has no slack at all and makes it.
        ({"c": ("30", "10"), "b": ("40", "10"), "a": ("50", "12")}, "undecided"),
        ({"c": ("16", "4"), "b": ("40", "5"), "a": ("80", "32")}, "schedulable"),
        ({"c": ("20", "5"), "b": ("40", "10"), "a": ("80", "40")}, "schedulable"),
        ({"one": ("100", "40"), "two": ("150", "40"), "three": ("350", "100")}, "schedulable"),
        ({"one": ("5", "3"), "two": ("7", "4")}, "overload"),
    ],
)
def test_hosts_are_judged_as_published(derived: Derived, rows: Rows, verdict: str) -> None:
    found = analyse_architecture(derived(tasks({name: periodic(*row) for name, row in rows.items()})))
    assert found.hosts["pc"].verdict == verdict


@pytest.mark.parametrize(
    ("rows", "verdict"),
    [
        # 4/10 + 8/20 is below 2 (sqrt(2) - 1) = 0.828, 4.2/10 + 8.4/20 above; without priorities both may take turns.
        ({"a": periodic("10", "4", ""), "b": periodic("20", "8", "")}, "schedulable"),
        ({"a": periodic("10", "4.2", ""), "b": periodic("20", "8.4", "")}, "undecided"),
        # Exactly one is the bound of earliest deadline first, and more than any order can promise.
        ({"a": periodic("10", "5", ""), "b": periodic("20", "10", "")}, "overload"),
        # Far below the bound, but with the priorities the wrong way round: the second waits 50 of its 10.
        ({"a": periodic("100", "50"), "b": periodic("10", "1")}, "undecided"),
        # The bound says nothing of activations that come late.
        ({"a": periodic("10", "4", "jitter: 9 ms"), "b": periodic("20", "8", "")}, "undecided"),
    ],
)
def test_below_the_bound_only_priorities_by_rate_are_sure_to_do(
    derived: Derived, rows: dict[str, str], verdict: str
) -> None:
    assert analyse_architecture(derived(tasks(rows))).hosts["pc"].verdict == verdict


def test_the_bounds_hold_for_one_core(derived: Derived) -> None:
    load = analyse_architecture(derived(tasks({"a": periodic("10", "4", "")}, host="cores: 2"))).hosts["pc"]
    for bound in (load.rate_monotonic_bound, load.earliest_deadline_bound):
        assert (bound.value, bound.assumptions) == (None, ("one core only",))


@pytest.mark.parametrize(
    ("number", "bound"),
    [(1, "1.000000"), (2, "0.828427"), (3, "0.779763"), (4, "0.756828"), (5, "0.743492"), (10, "0.717735")],
)
def test_the_rate_monotonic_bound(derived: Derived, number: int, bound: str) -> None:
    """Liu and Layland 1973: n (2^(1/n) - 1); for earliest deadline first it is 1."""
    found = analyse_architecture(derived(tasks({f"t{at}": periodic("100", "1") for at in range(number)})))
    load = found.hosts["pc"]
    assert f"{float(load.rate_monotonic_bound.value or 0):.6f}" == bound
    assert load.earliest_deadline_bound.value == 1


PYCPA = """
groups:
  g:
    components:
      t11: {outputs: {out: std_msgs/msg/Empty}}
      t12: {outputs: {out: std_msgs/msg/Empty}}
      t21: {inputs: {go: t11.out}}
      t22: {inputs: {go: t12.out}}
nodes:
  t11: {implements: t11, host: r1, timing: {period: 30 ms, jitter: 5 ms, wcet: 10 ms, bcet: 5 ms, priority: 2}}
  t12: {implements: t12, host: r1, timing: {period: 15 ms, jitter: 6 ms, wcet: 3 ms, bcet: 1 ms, priority: 1}}
  t21: {implements: t21, host: r2, timing: {wcet: 2 ms, bcet: 2 ms, priority: 2}}
  t22: {implements: t22, host: r2, timing: {wcet: 9 ms, bcet: 4 ms, priority: 1}}
hosts: {r1: {cores: 1}, r2: {cores: 1}}
links: {wire: {connects: [r1, r2], latency: 0 ms}}
"""


def test_jitter_is_passed_on_from_host_to_host(derived: Derived) -> None:
    """The example of static priorities of pyCPA (J. Diemer, P. Axer, R. Ernst, WATERS 2012): its results."""
    assert worst(analyse_architecture(derived(PYCPA))) == {"t11": 10, "t12": 13, "t21": 2, "t22": 19}


def test_messages_without_preemption_stay_below_the_bound_for_any_order(derived: Derived) -> None:
    """R. I. Davis, A. Burns, R. J. Bril, J. J. Lukkien: Controller Area Network (CAN) schedulability analysis: Refuted,
    revisited and revised, Real-Time Systems 35, 2007: A 2.5, B and C 3.5, 1 each. C's second instance takes 3.5, which is
    what the analysis before them had missed; with B's 3 and A's 2 it is within the longest busy period, 7.
    """
    rows = {"a": ("2.5", "1"), "b": ("3.5", "1"), "c": ("3.5", "1")}
    found = analyse_architecture(derived(tasks({name: periodic(*row, "") for name, row in rows.items()})))
    assert worst(found) == {"a": 7, "b": 7, "c": 7}


def test_lehoczkys_jobs_one_by_one(derived: Derived) -> None:
    """The chain of the second task waits 100 and takes 118: Lehoczky's worst of 114, 102, 116, 104, 118, 106, 94."""
    found = analyse_architecture(derived(tasks({"one": periodic("70", "26"), "two": periodic("100", "62")})))
    assert found.responses["two"].worst.value == 118 * MS
    assert found.hosts["pc"].verdict == "undecided"  # later than the next activation, but bounded
