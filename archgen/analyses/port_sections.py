"""Is each port of a node listed in the section that fits its message: as a topic, or as a service or action?"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.model.message_types import flow_of
from archgen.model.port_media import is_physical

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from archgen.model.architecture import Architecture
    from archgen.model.node import FlowKind, PortUse

# The section where an entry belongs, by the section where it is written: the direction (out, in) stays the same.
_TOPIC_SECTION = {"publishes": "publishes", "serves": "publishes", "subscribes": "subscribes", "calls": "subscribes"}
_SERVICE_SECTION = {"publishes": "serves", "serves": "serves", "subscribes": "calls", "calls": "calls"}
_FLOW_PHRASES: Mapping[FlowKind, str] = {"topic": "a topic", "service": "a service", "action": "an action"}


def wrong_section(architecture: Architecture) -> Iterator[Diagnostic]:
    """A node lists a service or action among its topics, a topic among its services, or a physical port at all."""
    nodes = [node for node in architecture.nodes.values() if node.uses]
    flows = _flows_of_ports(architecture) if nodes else {}
    for node in nodes:
        for use in node.uses:
            fault = _find_section_fault(architecture, flows, use)
            if fault:
                yield Diagnostic(
                    "wrong-section",
                    f"`{use.key}` of the node `{node.id}` {fault[0]}",
                    use.at,
                    help=fault[1],
                    element=node.id,
                )


def _find_section_fault(
    architecture: Architecture, flows: Mapping[str, set[FlowKind]], use: PortUse
) -> tuple[str, str] | None:
    """Return what is wrong with an entry and what to do about it, or None."""
    port = architecture.outputs.get(use.port or "") or architecture.inputs.get(use.port or "")
    if port and is_physical(port):
        return (
            f"is physical and does not stand below `{use.use}`",
            "leave it out: physical ports have neither topic nor message",
        )
    # A message that the node itself names outranks those of the port. An input may have sources of several kinds: then
    # any of their sections will do.
    actual_flows = {flow_of(use.message)} if use.message else flows.get(use.port or "", set())
    right_sections = {(_TOPIC_SECTION if flow == "topic" else _SERVICE_SECTION)[use.use] for flow in actual_flows}
    if not actual_flows or use.use in right_sections:
        return None
    flow_phrase = " and ".join(_FLOW_PHRASES[flow] for flow in ("topic", "service", "action") if flow in actual_flows)
    section_phrase = " or ".join(f"`{section}`" for section in sorted(right_sections))
    return f"is {flow_phrase}, but stands below `{use.use}`", f"move it to {section_phrase}"


def _flows_of_ports(architecture: Architecture) -> Mapping[str, set[FlowKind]]:
    """Return what flows through each port (topic, service, action) as far as messages are known, by port id."""
    flows: dict[str, set[FlowKind]] = defaultdict(set)
    for output in architecture.outputs.values():
        message = architecture.message_of(output)
        if message:
            flows[output.id].add(flow_of(message))
    for edge in architecture.edges:
        flows[edge.input] |= flows.get(edge.output, set())
    return flows


RULES = ((wrong_section, Severity.WARNING),)
