"""Can data flow along each chain?"""

from __future__ import annotations

from collections import defaultdict
from itertools import pairwise
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.model import flow_graph
from archgen.model.graph_search import find_reachable

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from archgen.model.architecture import Architecture, Chain, Waypoint
    from archgen.model.component import Input


def broken_chain(architecture: Architecture) -> Iterator[Diagnostic]:
    """Nothing flows from one element of a chain to the next, not even through others."""
    if not any(len(chain.through) > 1 for chain in architecture.chains.values()):
        return
    # The graph of components, not of nodes: a chain can be judged before anything is mapped to nodes.
    successors = flow_graph.build_component_graph(architecture).successors
    readers = _readers_by_output(architecture)
    open_components = _list_open_components(architecture)
    for chain in architecture.chains.values():
        if _runs_backwards(architecture, chain, successors):
            yield _diagnose_backward_chain(chain)
            continue
        for waypoint, next_waypoint in pairwise(chain.through):
            # A chain that goes through an output leaves its component by that output only.
            starts = (
                readers[waypoint.id] if waypoint.kind == "output" else _components_of_waypoint(architecture, waypoint)
            )
            goals = _components_of_waypoint(architecture, next_waypoint)
            reached = find_reachable(successors, starts).keys()
            # Inputs whose `from` could not be resolved are reported already, and one of them may be the missing step:
            # `unsure - reached` are the components with such inputs that cannot be reached from here.
            if (
                not goals
                or not _components_of_waypoint(architecture, waypoint)
                or goals & reached
                or open_components - reached
            ):
                continue
            yield Diagnostic(
                "broken-chain",
                f"in the chain `{chain.id}`, nothing leads from `{waypoint.id}` to `{next_waypoint.id}`",
                next_waypoint.at,
                labels=(Label(waypoint.at, "from here"),),
                help="name the connection that is missing in an input, or correct the order in `through`",
                element=chain.id,
            )


def _runs_backwards(architecture: Architecture, chain: Chain, successors: Mapping[str, Collection[str]]) -> bool:
    """Whether each of three elements or more leads to the one before it, and none to the one behind it.

    Of two elements, that nothing leads from one to the other says it as well.
    """
    steps = [_components_of_waypoint(architecture, waypoint) for waypoint in chain.through]
    if not all(steps):
        return False
    reached = [find_reachable(successors, step).keys() for step in steps]
    return len(steps) > 2 and all(  # noqa: PLR2004
        reached[number + 1] & steps[number] and not reached[number] & steps[number + 1]
        for number in range(len(steps) - 1)
    )


def _diagnose_backward_chain(chain: Chain) -> Diagnostic:
    right_order = ", ".join(waypoint.id for waypoint in reversed(chain.through))
    return Diagnostic(
        "broken-chain",
        f"the chain `{chain.id}` runs against what flows: from `{chain.through[0].id}` nothing leads to `{chain.through[-1].id}`",
        chain.through[0].at,
        help=f"a chain begins where the data come from: `[{right_order}]`",
        element=chain.id,
    )


def _list_open_components(architecture: Architecture) -> set[str]:
    """Return the ids of the components with an input of which the `from` could not be resolved.

    What reads an input of the composed component around it (`self.x`) is as open as that one: where that is fed by
    nothing or by the outside, nothing is missing.
    """
    givers = defaultdict[str, list[str]](list)
    for shell_port, readers in architecture.shell_ports.items():
        kind, _, shell_input = shell_port.partition(" ")
        if kind == "input":
            for reader in readers:
                givers[reader].append(shell_input)

    def is_open(port: Input) -> bool:
        if not port.from_written or port.connections:
            return False
        outer_ports = []
        for giver in givers[port.id]:
            shell_id, _, name = giver.rpartition(".")
            outer_ports.append(architecture.shells[shell_id].inputs[name])
        return not outer_ports or any(is_open(each) for each in outer_ports)

    return {port.component for port in architecture.inputs.values() if is_open(port)}


def _readers_by_output(architecture: Architecture) -> Mapping[str, set[str]]:
    """Return the ids of the components that read each output, by output id."""
    readers = defaultdict[str, set[str]](set)
    for edge in architecture.edges:
        readers[edge.output].add(architecture.inputs[edge.input].component)
    return readers


def _components_of_waypoint(architecture: Architecture, waypoint: Waypoint) -> set[str]:
    """Return the ids of the components that a chain's element belongs to."""
    if waypoint.kind == "node":
        return set(architecture.nodes[waypoint.id].implements)
    if waypoint.kind == "component":
        return set(architecture.leaves_of(waypoint.id))
    return {architecture.outputs[waypoint.id].component}


RULES = ((broken_chain, Severity.WARNING),)
