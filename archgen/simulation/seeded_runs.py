"""Run a system with many seeds: all of them, for what they show together, or until one run is late.

A seed is a number, and one run: it decides all that is drawn. Of eight seeds in a row two begin with everything at once
and always take the longest times, and three let some activity come after all its neighbours (`find_last_turn`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from archgen.simulation.chain_series import find_latest_passage
from archgen.simulation.chain_tracking import ChainTrack, track_chain
from archgen.simulation.drawn_orders import list_drawn_orders
from archgen.simulation.event_loop import EventFloodError, run_plan
from archgen.simulation.plan_builder import PublishPauses, build_plan
from archgen.simulation.run_totals import RunTotals
from archgen.simulation.simulation_plan import SimulationPlan
from archgen.simulation.simulation_result import SimulationResult
from archgen.simulation.simulation_run import SimulationRun
from archgen.timing.analysis import LateRun
from archgen.timing.system.timing_system import TimingSystem

_SECOND = 10**9


def simulate_system(
    system: TimingSystem,
    seconds: int = 60,
    seeds: int | range = 20,
    chains: Mapping[str, Sequence[str]] | None = None,
    pauses: PublishPauses | None = None,
) -> SimulationResult:
    """Simulate a system for `seconds` with each of `seeds`: a range, or how many from 0 on.

    `chains` give the ids of activities along arcs, by chain id. For `pauses` see `build_plan`: without them a
    conditional output with a promised largest gap is published at each chance.
    """
    plan = build_plan(system, pauses)
    tracks = {
        key: track
        for key, activity_ids in (chains or {}).items()
        if (track := track_chain(plan, activity_ids)) is not None
    }
    horizon = int(seconds * _SECOND / plan.unit)
    totals = RunTotals(plan, tracks)
    numbers = range(seeds) if isinstance(seeds, int) else seeds
    for seed in numbers:
        totals.add_run(_run_recorded(plan, seed, horizon, tuple(tracks.values())), horizon)
    return totals.to_result(seconds, numbers, horizon, chains or {})


def find_late_runs(
    system: TimingSystem,
    deadlines: Mapping[str, tuple[Sequence[str], Fraction]],
    *,
    seconds: int = 10,
    seeds: int = 24,
    pauses: PublishPauses | None = None,
) -> dict[str, LateRun]:
    """Return for each chain the first run, by seeds from 0 on, in which it takes longer than its deadline.

    `deadlines` are by chain the ids of activities along arcs, and the deadline in ns. The data age counts where the first
    activity samples the world; where its event is the stimulus the deadline is for the reaction alone. Only inputs count
    that each activity on the way sends on as soon as it can, as in the bounds. Chains that are never late are left out,
    and all of them if the events multiply without end.
    """
    plan = build_plan(system, pauses)
    tracks = {
        key: track for key, (through, _) in deadlines.items() if (track := track_chain(plan, through)) is not None
    }
    late_runs: dict[str, LateRun] = {}
    for seed in range(seeds):
        waiting = {key: track for key, track in tracks.items() if key not in late_runs}
        if not waiting:
            break
        try:
            run = _run_recorded(plan, seed, int(seconds * _SECOND / plan.unit), tuple(waiting.values()))
        except EventFloodError:
            break
        for key, track in waiting.items():
            passage = find_latest_passage(track.trace_run(run), forwarded_only=track.is_selective)
            longest = passage.length * plan.unit if passage else Fraction(0)
            if longest > deadlines[key][1]:
                late_runs[key] = LateRun(seed, seconds, longest, list_drawn_orders(run, track.activities))
    return late_runs


def _run_recorded(plan: SimulationPlan, seed: int, horizon: int, tracks: Sequence[ChainTrack]) -> SimulationRun:
    """Run one seed; only activities and wires on a chain are recorded, for a trace grows with each job."""
    watched = {activity for track in tracks for activity in track.activities}
    logged = {wire for track in tracks for parallel_wires in track.wires for wire in parallel_wires}
    return run_plan(plan, seed, horizon, watched, logged)
