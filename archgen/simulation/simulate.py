"""Simulate one system many times, with seeds from 0 on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.simulation.engine import go
from archgen.simulation.flatten import Pauses, flatten
from archgen.simulation.result import Result
from archgen.simulation.seen import Seen
from archgen.simulation.tracks import route
from archgen.timing.system import System

_SECOND = 10**9


def simulate(
    system: System,
    seconds: int = 60,
    seeds: int = 20,
    chains: Mapping[str, Sequence[str]] | None = None,
    pauses: Pauses | None = None,
) -> Result:
    """Simulate a system for `seconds` with each of `seeds` seeds.

    `chains` give the ids of activities along arcs, by chain id. For `pauses` see `build_plan`: without them a
    conditional output with a promised largest gap is published at each chance.
    """
    plan = flatten(system, pauses)
    # Only activities and wires on a chain are recorded: a trace grows with each job.
    ways = {key: found for key, way in (chains or {}).items() if (found := route(plan, way)) is not None}
    watched = {at for way in ways.values() for at in way.steps}
    logged = {wire for way in ways.values() for pair in way.wires for wire in pair}
    horizon = int(seconds * _SECOND / plan.unit)
    seen = Seen(plan, ways)
    for seed in range(seeds):
        seen.add(go(plan, seed, horizon, watched, logged), horizon)
    return seen.result(seconds, seeds, horizon, chains or {})
