"""Where a load becomes too much: exactly full cores, bounds of Liu and Layland, rounded ticks, the jobs of a round."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.timing.load import busy_windows, event_streams, link_queueing
from archgen.timing.load.busy_windows import DivergedError, SearchBudget
from archgen.timing.load.event_propagation import propagate_events
from archgen.timing.load.host_verdicts import is_below_rate_bound, rate_monotonic_bound
from archgen.timing.load.link_queueing import longest_queueing, settle_links
from archgen.timing.system.system_builder import build_system
from archgen.timing.system.trigger_graph import find_triggers
from tests.timing.printed import MS, show_ms
from tests.timing.sketches import analyse_sketch, read_sketch


def test_the_rate_monotonic_bound_is_rounded_down_to_nine_decimals() -> None:
    """N (2^(1/n) - 1), C. Liu and J. Layland 1973: 1, 0.8284, 0.7798, 0.7568 ... ln 2."""
    assert [rate_monotonic_bound(count) for count in (0, 1)] == [1, 1]
    assert rate_monotonic_bound(2) == Fraction(828_427_124, 10**9)
    assert rate_monotonic_bound(3) == Fraction(779_763_147, 10**9)
    assert rate_monotonic_bound(4) == Fraction(4 * 189_207_115, 10**9)
    assert rate_monotonic_bound(64) == Fraction(64 * 10_889_286, 10**9)
    assert rate_monotonic_bound(65) == Fraction(693_147_180, 10**9)


def test_the_exact_bound_needs_no_root() -> None:
    assert is_below_rate_bound(Fraction(1), 1)
    assert not is_below_rate_bound(Fraction(1_000_001, 10**6), 1)
    assert is_below_rate_bound(Fraction(828_427_124, 10**9), 2)
    assert not is_below_rate_bound(Fraction(828_427_125, 10**9), 2)
    assert is_below_rate_bound(Fraction(5), 0)
    assert is_below_rate_bound(Fraction(64 * 10_889_286, 10**9), 64)
    assert is_below_rate_bound(Fraction(693_147_180, 10**9), 65)
    assert not is_below_rate_bound(Fraction(693_147_181, 10**9), 65)


@pytest.mark.parametrize(
    ("cores", "shares", "responses"),
    [
        # 0.8 + 0.4 / 2 = 1: nobody knows how much of it may be pending, beside the others too.
        (2, (8, 2, 2), ["none [diverged]"] * 3),
        # 7 + (2 + 2 + 2) / 2: one of each comes within 10, and one of them may have been pending. The others: 2 + B, where
        # 2 B = min(7, B) + 2: the first keeps one core busy, and the other core has 2 besides.
        (2, (7, 2, 2), ["10", "4", "4"]),
        # 0.8 + 0.6 / 3 = 1.
        (3, (8, 2, 2, 2), ["none [diverged]"] * 4),
        # 6 + (2 + 2 + 2 + 2 x 2) / 3: two were pending. 2 + B, where 3 B = min(6, B) + 2 + 2.
        (3, (6, 2, 2, 2), ["28/3", "4", "4", "4"]),
    ],
)
def test_a_thread_and_its_part_of_the_others_fill_a_core(
    cores: int, shares: tuple[int, ...], responses: list[str]
) -> None:
    nodes = {f"c{index} @pc": f"period: 10 ms, wcet: {share} ms" for index, share in enumerate(shares)}
    analysis = analyse_sketch(nodes, "", f"hosts: {{pc: {{cores: {cores}}}}}")
    assert [show_ms(time.worst) for time in analysis.responses.values()] == responses


@pytest.mark.parametrize(
    ("shares", "others", "responses"),
    [
        # 0.5 + (0.5 + 0.2) / 2 + 0.3 / 3 = 0.95. 5 + (11 x 5 + 14 x 2) / 2 + 8 x 3 / 3 = 54.5: with responses of 54.5, 83 and
        # 25, so many came within 54.5 and the response before it.
        ((5, 5, 2), 3, ["109/2", "109/2", "83", "25"]),
        # 0.5 + (0.5 + 0.3) / 2 + 0.3 / 3 = 1.
        ((5, 5, 3), 3, ["none [diverged]"] * 4),
        # 0.5 + (0.5 + 0.2) / 2 + 0.6 / 3 = 1.05.
        ((5, 5, 2), 6, ["none [diverged]"] * 4),
    ],
)
def test_threads_of_one_container_share_its_threads(shares: tuple[int, ...], others: int, responses: list[str]) -> None:
    nodes = {f"c{index} +box": f"period: 10 ms, wcet: {share} ms" for index, share in enumerate(shares)}
    nodes["other @pc"] = f"period: 10 ms, wcet: {others} ms"
    nodes["fourth @pc"] = "period: 10 ms, wcet: 0 ms"  # with one thread fewer each would have a core
    rest = "hosts: {pc: {cores: 3}}\ncontainers: {box: {threads: 2, host: pc}}"
    analysis = analyse_sketch(nodes, "", rest)
    assert [show_ms(time.worst) for name, time in analysis.responses.items() if name != "fourth"] == responses


def test_a_container_has_as_many_cores_as_threads_where_there_are_enough() -> None:
    """5 + (4 + 2) / 2, 4 + (5 + 2) / 2 and 2 + (5 + 4) / 2: the third core is left to `other`."""
    nodes = {f"c{index} +box": f"period: 20 ms, wcet: {share} ms" for index, share in enumerate((5, 4, 2))}
    nodes["other @pc"] = "period: 20 ms, wcet: 13 ms"
    rest = "hosts: {pc: {cores: 3}}\ncontainers: {box: {threads: 2, host: pc}}"
    responses = analyse_sketch(nodes, "", rest).responses.values()
    assert [show_ms(time.worst) for time in responses] == ["8", "15/2", "13/2", "13"]


@pytest.mark.parametrize(("jobs", "settles"), [(5, True), (4, False)])
def test_a_full_core_settles_within_so_many_jobs(monkeypatch: pytest.MonkeyPatch, jobs: int, settles: object) -> None:
    """5 each 10, 10 each 20 and nothing each 40: 4 + 2 = 6 jobs of work in 40 ms, but the hyperperiod of work is 20: 2 + 1."""
    monkeypatch.setattr(event_streams, "_MAX_JOBS_IN_ROUND", jobs - 2)
    nodes = {
        "a @pc": "period: 10 ms, wcet: 5 ms, priority: 3",
        "b @pc": "period: 20 ms, wcet: 10 ms, priority: 2",
        "c @pc": "period: 40 ms, wcet: 0 ms, priority: 1",
    }
    worst = analyse_sketch(nodes, "", "hosts: {pc: {cores: 1}}").responses["b"].worst
    assert show_ms(worst) == ("20" if settles else "none [overload]")


def test_bytes_take_whole_ticks_rounded_up() -> None:
    """1 kB at 1 MB/s takes 1 ms: in ticks of 3/7 ms 2.33, so 3."""
    rest = "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], bandwidth: 8 Mbit/s, latency: 5 ms}}"
    system, _ = build_system(read_sketch({"a @p": "period: 10 ms, wcet: 0 ms", "b @q": "wcet: 0 ms"}, "a>b", rest))
    settled, _, state = settle_links(replace(system, tick=Fraction(3 * 10**6, 7)))
    assert longest_queueing(state, "lan", settled.arcs) == 3


@pytest.mark.parametrize(("bandwidth", "response"), [("400 bit/s", "20000"), ("399 bit/s", None)])
def test_a_wait_of_more_than_twenty_seconds_is_not_given(bandwidth: str, response: str | None) -> None:
    """1 kB at 50 B/s takes 20 s: the answer's gap of 100 s grows by it; a little slower, and the link counts as unknown."""
    rest = f"hosts: {{p: {{cores: 1}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q], bandwidth: {bandwidth}}}}}"
    analysis = analyse_sketch({"a @p": "period: 100 s, wcet: 0 ms, bcet: 0 ms", "b @q": "wcet: 0 ms"}, "a>b", rest)
    jitter = analysis.paces["b"].jitter
    assert show_ms(jitter) == (response or "none ?lan")


def test_what_has_not_settled_in_so_many_turns_is_given_up_and_the_rest_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """1 kB takes 8 ms on `lan` from the first turn on. That makes `b` 8 late, so that two of its messages, 4 ms each on `wan`, may
    follow 2 ms apart: 8 ms instead of 4 from the second turn on.
    """
    nodes = {"a @p": "period: 10 ms, wcet: 0 ms", "b @q": "wcet: 0 ms", "c @r": "wcet: 0 ms"}
    rest = (
        "hosts: {p: {cores: 1}, q: {cores: 1}, r: {cores: 1}}\n"
        "links: {lan: {connects: [p, q], bandwidth: 1 Mbit/s}, wan: {connects: [q, r], bandwidth: 2 Mbit/s}}"
    )
    for turns, jitters in ((24, ["0", "8", "16"]), (2, ["0", "8", "none ?wan"]), (1, ["0", "none ?lan", "none ?lan"])):
        monkeypatch.setattr(link_queueing, "_MAX_TURNS", turns)
        paces = analyse_sketch(nodes, "a>b b>c", rest).paces.values()
        assert [show_ms(pace.jitter) for pace in paces] == jitters


def test_one_budget_bounds_all_searches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing may be looked at: no response is found, though 1 + 2 would do."""
    nodes = {"a @pc": "period: 10 ms, wcet: 1 ms", "b @pc": "period: 10 ms, wcet: 2 ms"}
    system, _ = build_system(read_sketch(nodes, "", "hosts: {pc: {cores: 1}}"))
    for term_count, causes in ((0, ["diverged", "diverged"]), (1000, [3, 3])):
        monkeypatch.setattr(busy_windows, "_TERMS_PER_GROUP", term_count)
        monkeypatch.setattr(busy_windows, "_TERMS_PER_MEMBER", 0)
        state = propagate_events(system, find_triggers(system))
        found = [time.cause.notes[0] if time.value is None else time.value for time in state.responses.values()]
        assert found == [cause if isinstance(cause, str) else cause * MS / system.tick for cause in causes]


@pytest.mark.parametrize(
    ("cores", "shares", "others", "is_full"),
    [
        # In percent of a core. 80 + (20 + 20) / 2 fills one: no search is needed to know it; with 19 there is room left.
        (2, (80, 20, 20), 0, True),
        (2, (80, 20, 19), 0, False),
        # 80 + (20 + 20 + 20) / 3; without 1 of it there is room left.
        (3, (80, 20, 20, 20), 0, True),
        (3, (79, 20, 20, 20), 0, False),
        # Two threads of a container on three cores: 50 + (50 + 30) / 2 + 30 / 3; one less, and there is room left.
        (3, (50, 50, 30), 30, True),
        (3, (50, 50, 29), 30, False),
        (3, (50, 50, 30), 29, False),
    ],
)
def test_what_a_full_core_is_known_by_without_a_search(
    monkeypatch: pytest.MonkeyPatch, cores: int, shares: tuple[int, ...], others: int, *, is_full: bool
) -> None:
    """What is known to be full is not searched for, nor what is beside it, as long as it counts there."""
    looks: list[int] = []

    def give_up(term_count: int) -> None:
        looks.append(term_count)
        raise DivergedError

    monkeypatch.setattr(SearchBudget, "start_search", lambda _: give_up)
    place = "+box" if others else "@pc"
    nodes = {f"c{index} {place}": f"period: 100 ms, wcet: {share} ms" for index, share in enumerate(shares)}
    nodes |= (
        {"other @pc": f"period: 100 ms, wcet: {others} ms", "fourth @pc": "period: 9 ms, wcet: 0 ms"} if others else {}
    )
    rest = f"hosts: {{pc: {{cores: {cores}}}}}\ncontainers: {{box: {{threads: 2, host: pc}}}}"
    system, _ = build_system(read_sketch(nodes, "", rest))
    found = propagate_events(system, find_triggers(system)).responses
    assert {response.cause.notes for response in found.values()} == {("diverged",)}
    assert bool(looks) is not is_full


@pytest.mark.parametrize(("deadline", "verdict"), [(10, "schedulable"), (9, "undecided")])
def test_the_rate_monotonic_bound_holds_for_deadlines_that_are_not_before_the_next_activation(
    deadline: int, verdict: str
) -> None:
    """In any order `a` may end 38 ms late, by rate both are in time: 2 / 10 + 30 / 100 is below 0.828."""
    nodes = {
        "a @pc": f"period: 10 ms, wcet: 2 ms, deadline: {deadline} ms",
        "b @pc": "period: 100 ms, wcet: 30 ms",
    }
    assert analyse_sketch(nodes, "", "hosts: {pc: {cores: 1}}").hosts["pc"].verdict == verdict
