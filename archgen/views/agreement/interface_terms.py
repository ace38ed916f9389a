"""The terms of an interface, as readers see them.

No term names a line of a file: text that moves changes nothing between the partners.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from archgen.diagnostics.diagnostic import Diagnostic
from archgen.model.component import Component
from archgen.model.node import Endpoint
from archgen.model.ros_distro import is_ros_1
from archgen.timing.analysis import ChainResult
from archgen.timing.system import activity_builder
from archgen.views import inline_text
from archgen.views.agreement import interface_timing, message_fields
from archgen.views.agreement.partner_interfaces import PartnerInterface, components_at_ends, foreign_owners
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text

_FLOW_NAMES = {"topic": "Topic", "service": "Service", "action": "Action", "physical": ""}
_SETTLED_FACTS = ("Type", "Message", "Rate", "Size", "Answers within", "QoS offered")
"""Facts without which an interface is not settled, by the beginning of their name."""


@dataclass(frozen=True, slots=True)
class InterfaceEnd:
    """One row of who gives and who takes: partners, component with port, and node with its QoS."""

    role: str
    owners: tuple[str, ...]
    component: Component | None
    port: str
    node: str | None
    qos: str
    is_taker: bool


@dataclass(frozen=True, slots=True)
class InterfaceTerms:
    """An interface with all that is said of it. `field_rows` is None if the message has no definition."""

    interface: PartnerInterface
    title: str
    facts: tuple[interface_timing.TermFact, ...]
    ends: tuple[InterfaceEnd, ...]
    field_rows: tuple[message_fields.FieldRow, ...] | None
    chains: tuple[ChainResult, ...]
    requirements: tuple[Inlines, ...]
    findings: tuple[Diagnostic, ...]
    shared_notes: tuple[str, ...]
    """Sentences on what both partners, or a partner and a third one, are responsible for together."""

    @property
    def open_terms(self) -> tuple[str, ...]:
        """Return the names of the facts that are still to be settled."""
        definition_note = ["definition of the message"] if self.interface.message and self.field_rows is None else []
        unknown_facts = (name for name, value in self.facts if name.startswith(_SETTLED_FACTS) and _is_unknown(value))
        return (*(name if name.startswith("QoS") else name.lower() for name in unknown_facts), *definition_note)


def gather_terms(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> InterfaceTerms:
    """Gather all terms of an interface."""
    return InterfaceTerms(
        interface,
        interface_title(lookup, interface),
        tuple(_list_facts(lookup, activity_names, interface)),
        tuple(_list_ends(lookup, interface)),
        message_fields.list_field_rows(lookup.architecture.interfaces, interface.message)
        if interface.message
        else None,
        tuple(interface_timing.find_chains_through(lookup, activity_names, interface)),
        tuple(_requirement_runs(lookup, interface)),
        tuple(_related_findings(lookup, activity_names, interface)),
        tuple(_shared_sentences(lookup, interface)),
    )


def interface_title(lookup: Lookup, interface: PartnerInterface) -> str:
    """Return the name of an interface for people: component and port, or its topic."""
    if interface.output is None:
        return interface.key
    return f"{lookup.architecture.components[interface.output.component].title} · {interface.output.name}"


def _list_facts(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> Iterator[interface_timing.TermFact]:
    flow_name = _FLOW_NAMES[interface.flow]
    if interface.flow == "physical":
        yield "Kind", inline_text.to_inlines("physical: neither message nor topic")
    else:
        yield (
            flow_name,
            inline_text.join_inlines((Text(name, code=True),) for name in interface.topic_names)
            or inline_text.UNKNOWN_INLINES,
        )
    yield "Type", inline_text.value_or_unknown(interface.type)
    if interface.output and interface.output.description:
        yield "Meaning", inline_text.to_inlines(interface.output.description)
    if interface.flow != "physical":
        yield "Message", _message_runs(lookup, interface)
    yield from interface_timing.timing_facts(lookup, activity_names, interface)
    if interface.flow == "topic" and not is_ros_1(lookup.architecture.distro):
        yield "QoS offered", _qos_runs(interface.giver_endpoints)
    other_components = dict.fromkeys(other_input.component for other_input in interface.other_inputs)
    if other_components:
        yield "Also read by", inline_text.join_lines(_other_reader(lookup, component) for component in other_components)


def _message_runs(lookup: Lookup, interface: PartnerInterface) -> Inlines:
    if interface.message is None:
        return inline_text.UNKNOWN_INLINES
    message_type = lookup.architecture.types.get(interface.type or "")
    planned_note = [" (planned)"] if message_type and message_type.status == "planned" else []
    return inline_text.to_inlines(Text(interface.message, code=True), *planned_note)


def _qos_runs(endpoints: Iterable[Endpoint]) -> Inlines:
    qos_texts = dict.fromkeys(describe_qos(endpoint) for endpoint in endpoints)
    if not any(endpoint.qos.written for endpoint in endpoints):
        return (Text("not written: ROS's default counts", muted=True),)
    return inline_text.join_lines(inline_text.to_inlines(qos_text) for qos_text in qos_texts)


def describe_qos(endpoint: Endpoint) -> str:
    """Return a QoS in words; one that nobody wrote is the default."""
    return inline_text.format_qos(endpoint.qos) if endpoint.qos.written else "default (not written)"


def _other_reader(lookup: Lookup, component_id: str) -> Inlines:
    component_model = lookup.architecture.components[component_id]
    owners = partner_titles(lookup, component_model.owners)
    return inline_text.to_inlines(component_model.title, Text(f" ({owners})" if owners else ""))


def partner_titles(lookup: Lookup, owners: Iterable[str]) -> str:
    """Return partners' titles, comma separated."""
    known_partners = lookup.architecture.partners
    return ", ".join(known_partners[owner].title if owner in known_partners else owner for owner in owners)


def _list_ends(lookup: Lookup, interface: PartnerInterface) -> Iterator[InterfaceEnd]:
    giving_components, taking_components = components_at_ends(lookup, interface)
    verbs = ("serves", "calls") if interface.flow in {"service", "action"} else ("publishes", "reads")
    if interface.flow == "physical":
        verbs = ("gives", "takes")
    for component in giving_components or (None,):
        endpoints = [
            endpoint
            for endpoint in interface.giver_endpoints
            if component is None or endpoint.component == component.id
        ]
        port = interface.output.name if interface.output else ""
        yield from _end_rows(lookup, verbs[0], component, port, endpoints, is_taker=False)
    if not interface.inputs:
        for component in taking_components or (None,):
            endpoints = [
                endpoint
                for endpoint in interface.taker_endpoints
                if component is None or endpoint.component == component.id
            ]
            yield from _end_rows(lookup, verbs[1], component, "", endpoints, is_taker=True)
    for input_port in interface.inputs:
        endpoints = [endpoint for endpoint in interface.taker_endpoints if endpoint.port == input_port.id]
        role = f"{verbs[1]} (optional)" if input_port.optional else verbs[1]
        yield from _end_rows(
            lookup,
            role,
            lookup.architecture.components[input_port.component],
            input_port.name,
            endpoints,
            is_taker=True,
        )


def _end_rows(  # noqa: PLR0913 - the columns of a row
    lookup: Lookup, role: str, component: Component | None, port: str, endpoints: list[Endpoint], *, is_taker: bool
) -> Iterator[InterfaceEnd]:
    architecture = lookup.architecture
    component_owners = component.owners if component else ()
    with_qos = not is_ros_1(architecture.distro)
    rows: dict[tuple[str, str], None] = {}
    for endpoint in (endpoint for endpoint in endpoints if architecture.nodes[endpoint.node].written):
        # A dict as an ordered set: several endpoints of a node with one QoS are one row.
        rows[endpoint.node, describe_qos(endpoint) if endpoint.flow == "topic" and with_qos else ""] = None
    for node, qos in rows:
        owners = (
            dict.fromkeys((*component_owners, *foreign_owners(architecture, architecture.nodes[node])))
            or architecture.nodes[node].owners
        )
        yield InterfaceEnd(role, tuple(owners), component, port, node, qos, is_taker)
    if not rows:
        yield InterfaceEnd(role, component_owners, component, port, None, "", is_taker)


def _components_of(lookup: Lookup, interface: PartnerInterface) -> Iterable[Component]:
    """Return the components at both ends, each once."""
    return {
        component.id: component
        for components_of_end in components_at_ends(lookup, interface)
        for component in components_of_end
    }.values()


def _requirement_runs(lookup: Lookup, interface: PartnerInterface) -> Iterator[Inlines]:
    """Yield the requirements that the components at the ends serve, each once, with the components."""
    titles_by_requirement: dict[str, dict[str, None]] = {}
    for component in _components_of(lookup, interface):
        for use in component.requirements:
            titles_by_requirement.setdefault(use.text, {})[component.title] = None
    for text, titles in titles_by_requirement.items():
        declared = lookup.architecture.requirements.get(text)
        requirement_runs = [Text(text, strong=True), Text(f" {declared.title}")] if declared else [Text(text)]
        yield (*requirement_runs, Text(f" ({', '.join(titles)})", muted=True))


def _related_findings(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> Iterator[Diagnostic]:
    """Yield the findings about the interface itself: its ports, topics, type and chains, or that name them."""
    ports = {interface.key, *(input_port.id for input_port in interface.inputs)}
    exact_names = {*ports, *interface.topic_names, *([interface.type] if interface.type else [])}
    exact_names |= {result.id for result in interface_timing.find_chains_through(lookup, activity_names, interface)}
    element_ids = {component.id for component in _components_of(lookup, interface)}
    element_ids |= {endpoint.node for endpoint in (*interface.giver_endpoints, *interface.taker_endpoints)}
    port_names = {input_port.rpartition(".")[2] for input_port in ports}
    quoted_names = [f"`{name}`" for name in sorted(exact_names | port_names)]
    for finding in lookup.findings:
        if finding.element in exact_names or (
            finding.element in element_ids and any(word in finding.message for word in quoted_names)
        ):
            yield finding


def _shared_sentences(lookup: Lookup, interface: PartnerInterface) -> Iterator[str]:
    architecture = lookup.architecture
    for component in _components_of(lookup, interface):
        if len(component.owners) > 1:
            yield f"{component.title} belongs to {partner_titles(lookup, component.owners)} together: each answers for this interface."
    for node_id in dict.fromkeys(
        endpoint.node for endpoint in (*interface.giver_endpoints, *interface.taker_endpoints)
    ):
        component_titles = [architecture.components[name].title for name in architecture.nodes[node_id].implements]
        if (owners := foreign_owners(architecture, architecture.nodes[node_id])) and component_titles:
            yield f"{partner_titles(lookup, owners)} implements {', '.join(component_titles)} with the node {node_id}, and answers for this interface too."


def _is_unknown(value: Inlines) -> bool:
    return all(run.muted for run in value)
