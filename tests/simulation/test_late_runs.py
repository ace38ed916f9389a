"""A witness: the first run in which a chain is later than its deadline, and the same run again."""

from __future__ import annotations

from fractions import Fraction

from archgen.simulation import find_late_runs, simulate_system
from archgen.timing.analysis import LateRun
from archgen.timing.system.timing_system import TimingSystem
from tests.simulation.systems import arc, event, process, system, timed, within

MS = Fraction(1_000_000)
BOTH = system(
    [
        timed("scan", 100, 1),
        *within("both", event("both.fast", 2, "scan"), event("both.slow", 60, "scan")),
    ],
    [arc("scan", "both.fast"), arc("scan", "both.slow")],
    executors=process("both"),
)
CHAIN = ("scan", "both.fast")


def find_late_run(
    timing_system: TimingSystem, through: tuple[str, ...], deadline: Fraction, seconds: int = 10, seeds: int = 24
) -> LateRun | None:
    """Return the first late run of a single chain."""
    return find_late_runs(timing_system, {"c": (through, deadline)}, seconds=seconds, seeds=seeds).get("c")


def test_a_late_run_is_found_and_seen_again_from_its_seed() -> None:
    late = find_late_run(BOTH, CHAIN, 150 * MS)
    assert late is not None
    assert late.longest == 163 * MS
    again = simulate_system(BOTH, late.seconds, range(late.seed, late.seed + 1), {"c": CHAIN})
    reaction = again.chains["c"].all_inputs.reaction
    assert reaction is not None
    assert reaction.largest == late.longest


def test_the_first_seed_is_taken_each_time() -> None:
    assert find_late_run(BOTH, CHAIN, 150 * MS) == find_late_run(BOTH, CHAIN, 150 * MS)
    late = find_late_run(BOTH, CHAIN, 150 * MS)
    assert late is not None
    assert find_late_run(BOTH, CHAIN, 150 * MS, seeds=late.seed) is None


def test_no_run_is_later_than_the_worst_case() -> None:
    assert find_late_run(BOTH, CHAIN, 163 * MS, seeds=16) is None


def test_an_unfair_run_finds_what_only_the_least_favoured_sees() -> None:
    # Ten of one thread, all released together: the last one ends at 10.
    names = [f"n{at}" for at in range(10)]
    nodes = within("box", *(timed(name, 100, 1) for name in names))
    ten = system([*nodes, event("end", 0, "n7")], [arc("n7", "end")], executors=process("box"))
    late = find_late_run(ten, ("n7", "end"), 109 * MS, seconds=1, seeds=80)
    assert late is not None
    assert late.longest == 110 * MS


def test_a_chain_without_a_wire_is_never_late() -> None:
    assert find_late_run(BOTH, ("both.fast", "scan"), Fraction(0)) is None


def test_of_what_floods_the_simulation_no_run_is_late() -> None:
    ring = system(
        [timed("clock", 10, 0), event("a", 0, "clock", "b"), event("b", 0, "a")],
        [arc("clock", "a"), arc("a", "b"), arc("b", "a")],
    )
    assert find_late_run(ring, ("clock", "a"), Fraction(0)) is None
