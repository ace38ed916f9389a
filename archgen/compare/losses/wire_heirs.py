"""Outputs that live on under another id that no likeness explains: a component was split or merged, and the wire stayed.

What programs see are topics, messages and QoS. So an output that is new and offers all that a removed one offered is its
heir, however the diff presents it.
"""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.matched_ids import MatchedIds
from archgen.compare.version_pair import VersionPair
from archgen.model.architecture import Architecture

Wire = frozenset[tuple[object, ...]]
"""What the nodes of an output offer: names, messages, QoS, and whether a program does so or only a plan."""


def find_wire_heirs(
    versions: VersionPair, architectures: tuple[Architecture, Architecture], matched_ids: MatchedIds
) -> Mapping[str, str]:
    """Return for each removed output that somebody read the new output on the same wire, if there is exactly one."""
    old_elements, new_elements = versions.elements_before, versions.elements_after
    # Only what is new: a topic that another output offered already loses one of its publishers.
    new_outputs = [element for key, element in new_elements.items() if key[0] == "output" and key not in old_elements]
    lost_outputs = [
        name for name in versions.connections_before.readers_by_output if versions.is_removed("output", name)
    ]
    if not (new_outputs and lost_outputs):
        return {}
    wires_before = _collect_wires(architectures[0], matched_ids)
    wires_after = _collect_wires(architectures[1], MatchedIds())
    heirs = {}
    for name in lost_outputs:
        wire: Wire = wires_before.get(name, frozenset())
        candidates = [
            each.id
            for each in new_outputs
            if all(old_elements["output", name].values.get(key) == each.values.get(key) for key in ("type", "medium"))
            and _continues_wire(name, wire, each.id, wires_after.get(each.id, frozenset()))
        ]
        if len(candidates) == 1:
            heirs[name] = candidates[0]
    return heirs


def _collect_wires(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[str, Wire]:
    """Return the wire of each output of a written node, by common id."""
    wires: dict[str, set[tuple[object, ...]]] = {}
    for endpoint in architecture.endpoints:
        node = architecture.nodes[endpoint.node]
        if endpoint.use in {"publishes", "serves"} and endpoint.port and node.written:
            wire = wires.setdefault(matched_ids.common_id("output", endpoint.port), set())
            qos = endpoint.qos
            durations = [each and each.value for each in (qos.deadline, qos.lifespan, qos.lease_duration)]
            kept_qos = (qos.reliability, qos.durability, qos.history, qos.depth, qos.liveliness)
            is_planned = node.status == "planned"
            wire.add((endpoint.label, endpoint.flow, endpoint.message, *kept_qos, *durations, is_planned))
    return {port: frozenset(wire) for port, wire in wires.items()}


def _continues_wire(old_id: str, old_wire: Wire, new_id: str, new_wire: Wire) -> bool:
    if old_wire:
        # A program may take the place of a plan, but no plan that of a program.
        planned_wire = {(*offer[:-1], True) for offer in new_wire}
        return old_wire <= new_wire | planned_wire
    # Without a node there is no wire yet, and no program: then the name says what it is.
    return old_id.rpartition(".")[2] == new_id.rpartition(".")[2]
