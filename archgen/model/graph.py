"""Who feeds whom: the flow between components, and reachability in it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from archgen.model.architecture import Architecture
from archgen.model.mapping import flow_of

Neighbours = Mapping[str, tuple[str, ...]]


@dataclass(frozen=True, slots=True)
class Flow:
    """The components that each component feeds and is fed by, by complete ids.

    A service or action carries data both ways, so it counts in both directions.
    """

    feeds: Neighbours = field(default_factory=dict)
    fed_by: Neighbours = field(default_factory=dict)


def flow(architecture: Architecture) -> Flow:
    """Read the flow off the edges."""
    feeds: defaultdict[str, dict[str, None]] = defaultdict(dict)
    fed_by: defaultdict[str, dict[str, None]] = defaultdict(dict)
    inputs, outputs = architecture.inputs, architecture.outputs
    for edge in architecture.edges:
        output = outputs[edge.output]
        writer, reader = output.component, inputs[edge.input].component
        feeds[writer][reader] = fed_by[reader][writer] = None
        if flow_of(architecture.message(output)) != "topic":
            feeds[reader][writer] = fed_by[writer][reader] = None
    return Flow(
        {key: tuple(found) for key, found in feeds.items()}, {key: tuple(found) for key, found in fed_by.items()}
    )


def reach(start: Iterable[str], neighbours: Neighbours, steps: int | None = None) -> frozenset[str]:
    """Give what can be reached within a number of steps (any number for None), the start included."""
    seen = set(start)
    edge = list(seen)
    while edge and (steps is None or steps > 0):
        edge = [b for b in dict.fromkeys(n for a in edge for n in neighbours.get(a, ())) if b not in seen]
        seen.update(edge)
        steps = None if steps is None else steps - 1
    return frozenset(seen)
