"""Can data flow along each chain?"""

from __future__ import annotations

from collections import defaultdict, deque
from itertools import pairwise
from typing import TYPE_CHECKING

from archgen.diagnostic import Diagnostic, Label, Severity
from archgen.model.mapping import flow_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from archgen.model.architecture import Architecture, Waypoint


def successors(architecture: Architecture) -> Mapping[str, frozenset[str]]:
    """Give, by component, the components that receive something from it.

    A service or action carries data both ways. A reference to a component whose outputs are not known yet counts.
    """
    after = defaultdict[str, set[str]](set)
    for edge in architecture.edges:
        output = architecture.outputs[edge.output]
        reader = architecture.inputs[edge.input].component
        after[output.component].add(reader)
        if flow_of(architecture.message(output)) != "topic":
            after[reader].add(output.component)
    for connection in architecture.connections:
        if not connection.outputs:
            for component in _members(architecture, connection.target):
                after[component].add(architecture.inputs[connection.input].component)
    return {component: frozenset(readers) for component, readers in after.items()}


def broken_chain(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing flows from one element of a chain to the next, not even through others.

    Why: A chain is a path of cause and effect, from a sensor to a reaction, with a deadline. Where no way leads from an
    element to the next, the reaction never comes; mostly an input is missing, or the order is reversed.

    Bad:
        groups:
          driving:
            components:
              scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              brake: {inputs: {scan: scanner.scan}}
        nodes:
          scanner: {implements: scanner}
          brake: {implements: brake}
        chains:
          see_and_stop: {through: [driving.brake, driving.scanner], deadline: 100 ms}

    Good:
        groups:
          driving:
            components:
              scanner: {outputs: {scan: sensor_msgs/msg/LaserScan}}
              brake: {inputs: {scan: scanner.scan}}
        nodes:
          scanner: {implements: scanner}
          brake: {implements: brake}
        chains:
          see_and_stop: {through: [driving.scanner, driving.brake], deadline: 100 ms}
    """
    if not any(len(chain.through) > 1 for chain in architecture.chains.values()):
        return
    after = successors(architecture)
    readers = _readers(architecture)
    unsure = {i.component for i in architecture.inputs.values() if i.from_written and not i.connections}
    for chain in architecture.chains.values():
        for here, there in pairwise(chain.through):
            starts = readers[here.id] if here.kind == "output" else _components(architecture, here)
            goals = _components(architecture, there)
            reached = _reach(after, starts)
            # An open reference somewhere is reported already, and may be the very step that is missing.
            if not goals or not _components(architecture, here) or goals & reached or unsure - reached:
                continue
            yield Diagnostic(
                "broken-chain",
                f"in the chain `{chain.id}`, nothing leads from `{here.id}` to `{there.id}`",
                there.at,
                labels=(Label(here.at, "from here"),),
                help="name the connection that is missing in an input, or correct the order in `through`",
                element=chain.id,
            )


def _readers(architecture: Architecture) -> Mapping[str, set[str]]:
    """Give the components that read each output."""
    readers = defaultdict[str, set[str]](set)
    for edge in architecture.edges:
        readers[edge.output].add(architecture.inputs[edge.input].component)
    return readers


def _reach(after: Mapping[str, frozenset[str]], starts: Iterable[str]) -> set[str]:
    """Give all that data reaches from some components, themselves included."""
    seen = set(starts)
    queue = deque(seen)
    while queue:
        for component in after.get(queue.popleft(), ()):
            if component not in seen:
                seen.add(component)
                queue.append(component)
    return seen


def _components(architecture: Architecture, point: Waypoint) -> set[str]:
    """Give the components that an element of a chain belongs to."""
    if point.kind == "node":
        return set(architecture.nodes[point.id].implements)
    return {point.id if point.kind == "component" else architecture.outputs[point.id].component}


def _members(architecture: Architecture, target: str) -> Iterator[str]:
    group = architecture.groups.get(target)
    if group is None:
        yield target
    else:
        yield from (component.id for component in group.components.values())


RULES = ((broken_chain, Severity.WARNING),)
