"""Loops of data flow: which activities feed themselves, and how long one round takes."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence

from archgen.frozen import dataclass
from archgen.timing.network import Network
from archgen.timing.rings import rings
from archgen.timing.sums import bounded
from archgen.timing.system import Arc
from archgen.timing.value import Value


@dataclass(frozen=True, slots=True)
class Round:
    """One round of a loop, in ns: the sum of (link worst + S_i + R_i) over its arcs.

    The activities that feed one another (`members` of them) may make many rounds; this is the shortest one (in steps)
    through the first of them. A service's answer does not close a loop.
    """

    through: tuple[str, ...]
    members: int
    latency: Value


def rounds(network: Network) -> tuple[Round, ...]:
    """Return a round of each loop, in order of appearance."""
    system = network.steps.analysis.system
    after = {
        name: [arc.target for arc in system.out_of.get(name, ()) if arc.role != "answer"] for name in system.activities
    }
    made: list[Round] = []
    for ring in rings(after):
        arcs = _round(network, ring)
        latency = bounded([value for arc in arcs for value in network.step(arc, "bound")])
        made.append(Round((*(arc.source for arc in arcs), ring[0]), len(ring), latency))
    return tuple(made)


def _round(network: Network, ring: Sequence[str]) -> tuple[Arc, ...]:
    """Return the arcs of the shortest round through the first activity of a ring."""
    members, first = frozenset(ring), ring[0]
    came: dict[str, Arc] = {}
    queue = deque([first])
    # Breadth first, until the first activity is reached again; `arriving_arcs` holds the arc by which each was reached.
    while queue and first not in came:
        here = queue.popleft()
        for arc in network.steps.analysis.system.out_of.get(here, ()):
            if arc.role != "answer" and arc.target in members and arc.target not in came:
                came[arc.target] = arc
                queue.append(arc.target)
    back = [came[first]]
    while back[-1].source != first:
        back.append(came[back[-1].source])
    return tuple(reversed(back))
