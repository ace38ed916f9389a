"""Random systems with deadlines that are within reach: from 1.1 to 1.8 times what each chain takes with nobody in its way."""

from __future__ import annotations

import random
from dataclasses import replace

from archgen.model.architecture import Architecture
from archgen.model.quantity import parse_quantity
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.search.change_trials import find_floors
from archgen.timing.search.proposals import MAX_TRIES, Proposal, find_proposal
from tests.timing.random_robots import random_robot_text
from tests.timing.random_styles import random_style_text
from tests.timing.random_systems import architecture
from tests.timing.random_threads import random_threads_text
from tests.timing.search.trials import start_trials

_FAR = parse_quantity("1 h", "duration")


def draw_late_system(seed: int) -> Architecture | None:
    """Return a random system with deadlines; None where a core or an order is written, or no chain has a floor."""
    draw = (random_style_text, random_robot_text, random_threads_text)[seed % 3]
    drawn = architecture(draw(seed // 3), is_fair=True)
    timings = [timing for node in drawn.nodes.values() for timing in node.timing.values()]
    is_pinned = any(timing.core is not None or timing.cores for timing in timings)
    if is_pinned or any(host.scheduling or host.core_scheduling for host in drawn.hosts.values()):
        return None
    asked = replace(drawn, chains={name: replace(chain, deadline=_FAR) for name, chain in drawn.chains.items()})
    floors = find_floors(analyse_architecture(asked), asked)
    dice = random.Random(seed)  # noqa: S311 - a test's dice
    chains = {
        name: replace(
            chain,
            deadline=parse_quantity(f"{int(floors[name] * int(dice.uniform(110, 180)) / 100_000)} us", "duration"),
        )
        for name, chain in asked.chains.items()
        if name in floors
    }
    return replace(asked, chains=chains) if chains else None


def propose_for(asked: Architecture, tries: int = MAX_TRIES) -> Proposal:
    """Return what is proposed for a system."""
    return find_proposal(start_trials(asked, tries), bound_all_chains(analyse_architecture(asked), asked))
