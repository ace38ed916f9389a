"""What is proposed: proven where it can be, never less than priorities by rate prove, and no more than is needed."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.link.timing_overrides import apply_overrides
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search import proposals
from archgen.timing.search.proposals import ConfigurationSpace, RunConfiguration, find_proposal, find_short_proposal
from tests.property_sizes import try_some
from tests.timing.random_systems import architecture
from tests.timing.search.late_systems import draw_late_system, propose_for
from tests.timing.search.trials import bound_with, start_trials
from tests.timing.sketches import sketch

ROBOT = Path(__file__).with_name("nav_robot.yaml").read_text(encoding="utf-8")
_SLOW = "period: 200 ms, wcet: 60 ms"
_SENSOR = "period: 100 ms, wcet: 1 ms, response: 1 ms"


def test_one_trigger_proves_the_newcomers_robot() -> None:
    """Nothing else can prove its second chain: with nobody in its way it takes 424.8 ms."""
    asked = architecture(ROBOT, is_fair=True)
    proposal = propose_for(asked)
    assert proposal.hopeless == {"scan_and_stop": 424_800_000}
    assert proposal.best.late == ()
    assert [str(change) for change in proposal.best.changes if "trigger" in str(change)] == [
        "costmap.timing.trigger=[scan]"
    ]
    chains = bound_with(asked, list(map(str, proposal.best.changes)))
    assert {name: chain.bound.value for name, chain in chains.items()} == proposal.best.bounds
    assert {chain.verdict for chain in chains.values()} == {"met"}
    assert proposal.best.bounds["scan_and_stop"] == 338_850_000


def test_the_newcomers_robot_is_least_late_without_a_trigger() -> None:
    asked = architecture(ROBOT, is_fair=True)
    kept = propose_for(asked).kept_triggers
    alone = find_proposal(
        start_trials(asked, 60), bound_all_chains(analyse_architecture(asked), asked), keep_triggers=True
    )
    for each in (kept, alone.best):
        assert each.late == ("scan_and_stop",)
        assert each.bounds["scan_and_stop"] == 425_100_000
        assert each.words.startswith(
            "a process for each node, priorities by the chains' deadlines, then from each chain's end"
        )
    assert not any(tried.changes_triggers for tried in alone.tried)


def _prove_by_rate(seed: int) -> tuple[bool, bool] | None:
    """Return whether priorities by rate, with a process for each node, prove all chains of a system, and what is proposed does."""
    asked = draw_late_system(seed)
    if asked is None:
        return None
    analysis = analyse_architecture(asked)
    space = ConfigurationSpace(asked, analysis, bound_all_chains(analysis, asked))
    by_rate = space.list_changes(space.rank(RunConfiguration(own_processes=space.separable_nodes), "rate"))
    trials = start_trials(asked)
    proposal = propose_for(asked)
    slacks = [trials.find_slack(name, by_rate) for name in proposal.deadlines]
    assert set(proposal.best.late) <= set(proposal.tried[0].late)
    return all(slack is not None and slack >= 0 for slack in slacks), not proposal.best.late


@pytest.mark.parametrize("first_seed", try_some(range(0, 150, 15), 1, 3))
def test_all_that_priorities_by_rate_prove_is_proven(first_seed: int) -> None:
    answers = [answer for seed in range(first_seed, first_seed + 15) if (answer := _prove_by_rate(seed)) is not None]
    assert all(is_proposed or not is_proven_by_rate for is_proven_by_rate, is_proposed in answers)
    assert sum(is_proposed for _, is_proposed in answers) > sum(by_rate for by_rate, _ in answers)


def test_nothing_is_tried_for_a_chain_that_lacks_figures() -> None:
    """What is known of it is above the deadline already; no order of processes writes how many cores the host has."""
    text = sketch(
        {"a @p": _SENSOR, "b @p": "wcet: 3 ms", "c @p": _SLOW},
        "a>b",
        "hosts: {p: {}}\nchains: {c: {through: [g.a, g.b], deadline: 50 ms}}",
    )
    proposal = propose_for(architecture(text, is_fair=True))
    assert (proposal.unjudged, proposal.deadlines, len(proposal.tried)) == (("c",), {}, 1)


def test_a_project_that_is_in_time_is_left_alone() -> None:
    text = sketch(
        {"a @p": _SENSOR, "b @p": "wcet: 3 ms"},
        "a>b",
        "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 1 s}}",
    )
    trials = start_trials(architecture(text), 60)
    proposal = find_proposal(trials, bound_with(architecture(text)))
    assert (len(proposal.tried), proposal.best, trials.tries_left) == (1, proposal.tried[0], 60)


def test_what_is_proposed_is_proposed_no_second_time() -> None:
    asked = architecture(ROBOT, is_fair=True)
    changes = list(map(str, propose_for(asked).best.changes))
    proposal = propose_for(apply_overrides(asked, changes))
    assert (len(proposal.tried), proposal.best.changes) == (1, ())


def test_what_makes_another_chain_late_is_not_proposed() -> None:
    """With a priority for b the other chain, of o, would wait for it."""
    text = sketch(
        {"a @p": _SENSOR, "b @p": "wcet: 30 ms", "s @p": _SENSOR, "o @p": "wcet: 3 ms, priority: 5", "slow @p": _SLOW},
        "a>b s>o",
        "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 150 ms}, other: {through: [s, o], deadline: 105 ms}}",
    )
    assert [chain.verdict for chain in bound_with(architecture(text)).values()] == ["not proven", "met"]
    proposal = propose_for(architecture(text))
    assert proposal.best.late == ()
    assert any("other" in tried.late for tried in proposal.tried)


def test_a_core_for_each_process_may_prove_what_no_order_does() -> None:
    """Four chains in a row: on cores that all may use, each step may find both of them busy."""
    asked = draw_late_system(66)
    assert asked is not None
    proposal = propose_for(asked)
    assert (proposal.best.late, proposal.best.words) == ((), "priorities by rate, each process on one core of h")
    assert all(tried.late for tried in proposal.tried if not any(change.kind == "core" for change in tried.changes))
    chains = bound_with(asked, list(map(str, proposal.best.changes)))
    assert {name: chain.bound.value for name, chain in chains.items()} == proposal.best.bounds


@pytest.mark.slow
def test_who_moves_with_a_core_for_each_process_in_vain_moves_without_as_well() -> None:
    """Its best configuration before any move has a core for each process, and no move proves it from there."""
    asked = draw_late_system(52)
    assert asked is not None
    proposal = propose_for(asked)
    assert (proposal.best.late, proposal.best.words) == (
        (),
        "a process for each node, priorities by rate on h1, n7 first on h1",
    )
    unmoved = [tried for tried in proposal.tried if "first" not in tried.words and "last" not in tried.words]
    assert "each process on one core" in min(unmoved, key=lambda tried: tried.rank).words


def test_no_more_is_changed_than_is_needed() -> None:
    """A process of its own for `b` is enough, and `more` may stay with `slow`."""
    text = sketch(
        {
            "a @p": _SENSOR,
            "slow +box": _SLOW,
            "b +box": "wcet: 3 ms",
            "x @q": _SENSOR,
            "y +far": "wcet: 3 ms",
            "z +far": _SLOW,
        },
        "a>b x>y",
        "hosts: {p: {cores: 4}, q: {cores: 4}}\ncontainers: {box: {threads: 1, host: p}, far: {threads: 1, host: q}}\n"
        "chains: {c: {through: [a, b], deadline: 120 ms}, d: {through: [x, y], deadline: 1 s}}",
    )
    proposal = propose_for(architecture(text))
    assert [str(change) for change in proposal.best.changes] == ["b.container=none"]
    assert proposal.best.words == "own processes for b"


def test_where_no_clock_is_to_blame_a_trigger_is_the_last_resort() -> None:
    """Alone on its core the chain takes at most 253 ms, but it may lie in wait for the clock of `b` as well."""
    text = sketch(
        {"a @p": "period: 100 ms, wcet: 10 ms", "b @p": "period: 100 ms, wcet: 30 ms"},
        "a>b",
        "hosts: {p: {cores: 1, scheduling: non_preemptive}}\nchains: {c: {through: [a, b], deadline: 250 ms}}",
    )
    proposal = propose_for(architecture(text))
    assert proposal.hopeless == {}
    assert [str(change) for change in proposal.best.changes] == ["b.timing.trigger=[a]"]
    assert proposal.best.late == ()


def test_who_is_fired_by_each_message_works_oftener_where_nothing_else_is_short_enough() -> None:
    """Fired by one map in five, the plan waits as long as for its clock."""
    text = sketch(
        {"map @p": "period: 200 ms, wcet: 5 ms", "plan @p": "period: 1 s, wcet: 60 ms"},
        "map>plan",
        "hosts: {p: {cores: 2}}\nchains: {c: {through: [map, plan], deadline: 500 ms}}",
    )
    proposal = propose_for(architecture(text))
    assert proposal.best.words == "plan fired by each message of its input map, 5 times as often as now"
    assert proposal.best.late == ()


@pytest.mark.parametrize(
    ("seed", "words"),
    [
        # No order, process or trigger at the present rates proves its chains.
        (83, "fired by each message"),
        # Neither does a trigger in an order without moves.
        (183, "priorities by rate, 5 moves in it, n11 fired by one message in 2 of its input n3"),
    ],
)
def test_triggers_may_prove_what_no_floor_forbids(seed: int, words: str) -> None:
    asked = draw_late_system(seed)
    assert asked is not None
    proposal = propose_for(asked)
    assert (proposal.hopeless, proposal.best.late) == ({}, ())
    assert words in proposal.best.words


@pytest.mark.slow
def test_who_asks_gets_more_tries_than_who_did_not() -> None:
    """What proves its chains is the 5th move from the best order: with half of the tries it is not found."""
    asked = draw_late_system(70)
    assert asked is not None
    unasked = find_short_proposal(
        asked, (analysis := analyse_architecture(asked)), bound_all_chains(analysis, asked), apply_overrides
    )
    assert unasked is not None
    assert (unasked.best.late, unasked.is_cut) == (("c3",), True)
    assert propose_for(asked).best.late == ()


@pytest.mark.slow
def test_tries_are_counted_and_the_same_each_time(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = architecture(ROBOT, is_fair=True)
    assert propose_for(asked, 3).is_cut
    assert len(propose_for(asked, 3).tried) == 4
    assert propose_for(asked) == propose_for(asked)
    monkeypatch.setattr(proposals, "_KEPT_TRIES", 1_000)
    assert propose_for(draw_late_system(7) or asked).is_cut


def test_a_chain_without_figures_is_not_judged() -> None:
    text = sketch(
        {"a @p": _SENSOR, "b @p": "wcet: 3 ms", "open": "", "slow @p": _SLOW},
        "a>b b>open",
        "hosts: {p: {cores: 1}}\nchains: {c: {through: [a, b], deadline: 120 ms}, d: {through: [a, open], deadline: 1 s}}",
    )
    assert list(propose_for(architecture(text)).deadlines) == ["c"]
