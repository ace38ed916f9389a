"""Loops of data flow: which activities feed themselves, and how long one round takes."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from archgen.frozen import dataclass
from archgen.model.graph_search import find_rings
from archgen.timing.chains.cost_network import CostNetwork
from archgen.timing.figures.timing_values import TimingValue, sum_bounds
from archgen.timing.system.timing_system import Arc


@dataclass(frozen=True, slots=True)
class LoopRound:
    """One round of a loop, in ns: the sum of (link worst + S_i + R_i) over its arcs.

    The activities that feed one another (`members` of them) may make many rounds; this is the shortest one (in steps)
    through the first of them. A service's answer does not close a loop.
    """

    through: tuple[str, ...]
    members: int
    latency: TimingValue


def find_loop_rounds(network: CostNetwork) -> tuple[LoopRound, ...]:
    """Return a round of each loop, in order of appearance."""
    system = network.steps.analysis.system
    successors = {
        name: [arc.target for arc in system.arcs_from.get(name, ()) if arc.role != "answer"]
        for name in system.activities
    }
    loop_rounds: list[LoopRound] = []
    for ring in find_rings(successors):
        arcs = _shortest_round(network, ring)
        latency = sum_bounds([value for arc in arcs for value in network.step_costs(arc, "bound")])
        loop_rounds.append(LoopRound((*(arc.source for arc in arcs), ring[0]), len(ring), latency))
    return tuple(loop_rounds)


def _shortest_round(network: CostNetwork, ring: Sequence[str]) -> tuple[Arc, ...]:
    """Return the arcs of the shortest round through the first activity of a ring."""
    members, first = frozenset(ring), ring[0]
    arriving_arcs: dict[str, Arc] = {}
    queue = deque([first])
    # Breadth first, until the first activity is reached again; `arriving_arcs` holds the arc by which each was reached.
    while queue and first not in arriving_arcs:
        current = queue.popleft()
        for arc in network.steps.analysis.system.arcs_from.get(current, ()):
            if arc.role != "answer" and arc.target in members and arc.target not in arriving_arcs:
                arriving_arcs[arc.target] = arc
                queue.append(arc.target)
    backward_arcs = [arriving_arcs[first]]
    while backward_arcs[-1].source != first:
        backward_arcs.append(arriving_arcs[backward_arcs[-1].source])
    return tuple(reversed(backward_arcs))
