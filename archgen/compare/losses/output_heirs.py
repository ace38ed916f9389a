"""Outputs that live on under another id that no likeness explains: a component was split or merged, and the wire stayed.

What programs see are topics, messages and QoS. So an output that is new and offers all that a removed one offered is its
heir, however the diff presents it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from archgen.compare.compared_elements import ComparedElement
from archgen.compare.version_pair import VersionPair
from archgen.model.node import Endpoint

EndpointTable = Mapping[tuple[str, str], Sequence[Endpoint]]
"""What written nodes offer, by node and port."""


def find_heirs(
    versions: VersionPair, read_endpoints: Callable[[], tuple[EndpointTable, EndpointTable]]
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
    wires_before, wires_after = (_collect_wires(endpoints) for endpoints in read_endpoints())
    heirs = {}
    for name in lost_outputs:
        wire = wires_before.get(name, frozenset())
        candidates = [
            each.id
            for each in new_outputs
            if _is_same_output(old_elements["output", name], each)
            and _continues_wire(name, wire, each.id, wires_after.get(each.id, frozenset()))
        ]
        if len(candidates) == 1:
            heirs[name] = candidates[0]
    return heirs


def _collect_wires(endpoints: EndpointTable) -> Mapping[str, frozenset[object]]:
    """Return for each port what its nodes offer: names, messages and QoS."""
    wires: dict[str, set[object]] = {}
    for (_, port), port_endpoints in endpoints.items():
        wires.setdefault(port, set()).update(_describe_endpoints(port_endpoints))
    return {port: frozenset(wire) for port, wire in wires.items()}


def _describe_endpoints(endpoints: Iterable[Endpoint]) -> Iterable[object]:
    for endpoint in endpoints:
        qos = endpoint.qos
        kept_qos = (qos.reliability, qos.durability, qos.history, qos.depth, qos.liveliness)
        durations = tuple(each and each.value for each in (qos.deadline, qos.lifespan, qos.lease_duration))
        yield endpoint.name, endpoint.flow, endpoint.message, kept_qos, durations


def _is_same_output(old_output: ComparedElement, new_output: ComparedElement) -> bool:
    """Whether both carry the same type, into the same world."""
    return all(old_output.values.get(key) == new_output.values.get(key) for key in ("type", "medium"))


def _continues_wire(old_id: str, old_wire: frozenset[object], new_id: str, new_wire: frozenset[object]) -> bool:
    if old_wire:
        return old_wire <= new_wire
    # Without a node there is no wire yet, and no program: then the name says what it is.
    return old_id.rpartition(".")[2] == new_id.rpartition(".")[2]
