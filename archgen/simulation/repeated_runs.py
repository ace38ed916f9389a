"""Simulate one system many times, with seeds from 0 on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.simulation.chain_tracking import track_chain
from archgen.simulation.event_loop import run_plan
from archgen.simulation.plan_builder import PublishPauses, build_plan
from archgen.simulation.run_totals import RunTotals
from archgen.simulation.simulation_result import SimulationResult
from archgen.timing.system.timing_system import TimingSystem

_SECOND = 10**9


def simulate_system(
    system: TimingSystem,
    seconds: int = 60,
    seeds: int = 20,
    chains: Mapping[str, Sequence[str]] | None = None,
    pauses: PublishPauses | None = None,
) -> SimulationResult:
    """Simulate a system for `seconds` with each of `seeds` seeds.

    `chains` give the ids of activities along arcs, by chain id. For `pauses` see `build_plan`: without them a
    conditional output with a promised largest gap is published at each chance.
    """
    plan = build_plan(system, pauses)
    # Only activities and wires on a chain are recorded: a trace grows with each job.
    tracks = {
        key: track
        for key, activity_ids in (chains or {}).items()
        if (track := track_chain(plan, activity_ids)) is not None
    }
    watched = {activity for activity_ids in tracks.values() for activity in activity_ids.activities}
    logged = {
        wire for activity_ids in tracks.values() for parallel_wires in activity_ids.wires for wire in parallel_wires
    }
    horizon = int(seconds * _SECOND / plan.unit)
    totals = RunTotals(plan, tracks)
    for seed in range(seeds):
        totals.add_run(run_plan(plan, seed, horizon, watched, logged), horizon)
    return totals.to_result(seconds, seeds, horizon, chains or {})
