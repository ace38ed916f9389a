"""Witnesses of missed deadlines: runs of which anybody can see again what was seen."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.model.architecture import Architecture
from archgen.simulation import chain_witnesses, simulate_system
from archgen.simulation.chain_witnesses import find_publish_pauses, find_witnesses, judge_chains
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.sketches import read_sketch

NODES = {"scan @p": "period: 100 ms, wcet: 1 ms", "fast @p": "wcet: 2 ms", "slow @p": "period: 50 ms, wcet: 20 ms"}
REST = "hosts: {p: {cores: 1}}\nchains: {c: {through: [scan, fast], deadline: DEADLINE}, free: {through: [scan, fast]}}"


def _prepare(deadline: str):  # type: ignore[no-untyped-def]  # noqa: ANN202 - what both need
    model = _read_robot(deadline)
    analysis = analyse_architecture(model)
    return analysis, bound_all_chains(analysis, model)


def _read_robot(deadline: str) -> Architecture:
    return read_sketch(NODES, "scan>fast", REST.replace("DEADLINE", deadline))


def test_what_was_seen_is_seen_again_from_its_seed() -> None:
    analysis, results = _prepare("115 ms")
    assert results["c"].verdict == "not proven"
    witnesses = find_witnesses(analysis, results.values())
    witness = witnesses["c"]
    assert witness.longest > 115 * 10**6
    assert results["c"].bound.value is not None
    assert witness.longest <= results["c"].bound.value
    seeds = range(witness.seed, witness.seed + 1)
    again = simulate_system(
        analysis.system, witness.seconds, seeds, {"c": results["c"].through}, find_publish_pauses(analysis)
    ).chains["c"]
    figures = [again.bounded_figures.reaction, again.bounded_figures.age]
    assert max(figure.largest for figure in figures if figure) == witness.longest
    judged = judge_chains(analysis, _read_robot("115 ms"))
    assert [(key, chain.verdict, chain.late_run) for key, chain in judged.items()] == [
        ("c", "missed", witness),
        ("free", "open", None),
    ]


def test_the_same_run_is_found_each_time() -> None:
    analysis, results = _prepare("115 ms")
    assert find_witnesses(analysis, results.values()) == find_witnesses(analysis, results.values())


@pytest.mark.parametrize("deadline", ["123 ms", "1 s"])
def test_what_cannot_be_seen_has_no_witness(deadline: str) -> None:
    """The bound is 123 ms: 100, and all three jobs."""
    analysis, results = _prepare(deadline)
    assert results["c"].bound.value == Fraction(123 * 10**6)
    assert find_witnesses(analysis, results.values()) == {}


def test_a_system_that_is_too_large_is_not_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    analysis, results = _prepare("115 ms")
    monkeypatch.setattr(chain_witnesses, "_MAX_JOBS_PER_RUN", 10)
    assert find_witnesses(analysis, results.values()) == {}
