"""The terms of an interface, as readers see them, and what two partners have still to settle about it.

No term names a line of a file: text that moves changes nothing between the partners. Open is only what stands between the
two: the project's other findings are its own business.

What holds where data is late or missing, as far as the model says it; nothing is added to that.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.analyses.port_types import is_expected_type
from archgen.analyses.qos_compatibility import find_qos_conflicts
from archgen.frozen import dataclass, replace
from archgen.model.agreed_terms import INTERFACE_TERMS, find_agreement
from archgen.model.component import Component
from archgen.model.node import Endpoint, Qos
from archgen.model.partner_interfaces import PartnerInterface, components_at_ends, foreign_owners, list_givers
from archgen.model.ros_distro import is_ros_1
from archgen.timing.analysis import ChainResult
from archgen.timing.system import activity_builder
from archgen.timing.system.activity_builder import ActivityNames
from archgen.views import inline_text
from archgen.views.agreement import message_fields, output_promises, promise_rows
from archgen.views.agreement.output_promises import CountedPort
from archgen.views.agreement.promise_rows import (
    QOS_OFFERED,
    RATE,
    PromiseRow,
    PromiseStrength,
    TermName,
    find_giver_timing,
    identify_qos,
    judge_sent_gaps,
    measure_qos,
)
from archgen.views.element_references import message_link
from archgen.views.graphs.element_boxes import join_owner_titles, name_in_place
from archgen.views.lookup import Lookup
from archgen.views.shapes import Fact, Inlines, Text
from archgen.views.timing import value_format

_OPEN_SENTENCES = {
    "type": "The type of what flows is not agreed.",
    "message": "The message is not agreed.",
    "fields": "The fields of the message are not stated here: its definition is not at hand.",
    RATE.key: "No rate is promised{of_node}, and none can be expected from what is known.",
    "size": "The size of a message is not known.",
    "response": "Nobody promises within what time{of_node} an answer comes, and it cannot be told from what is known.",
    QOS_OFFERED.key: "No quality of service is promised: ROS's default counts.",
}
"""What to say of a term that is open, by its key."""


def describe_open_term(name: TermName) -> str:
    """Return a sentence about a term that is not settled, such as the rate or the rate of one of several nodes."""
    return _OPEN_SENTENCES[name.key].format(of_node=f" by `{name.node}`" if name.node else "")


def _find_contradictions(lookup: Lookup, activity_names: ActivityNames, interface: PartnerInterface) -> Iterator[str]:
    """Yield a sentence for all in which both sides, or a promise and what is expected, do not fit together."""
    architecture = lookup.architecture
    output = interface.output
    for input_port in interface.inputs:
        if output and output.type and input_port.type and not is_expected_type(architecture, input_port.type, output):
            component = architecture.components[input_port.component].title
            yield f"{component} expects `{input_port.type}` as `{input_port.name}`, and is given `{output.type}`."
    if interface.flow == "topic" and not is_ros_1(architecture.distro):
        yield from _find_qos_clashes(lookup, interface)
    for endpoint in list_givers(lookup.architecture, interface):
        judged = judge_sent_gaps(lookup, activity_names, endpoint)
        yield from (each.sentence for each in judged if each.state == "broken")


def _find_late_chains(lookup: Lookup, chains: Iterable[ChainResult]) -> Iterator[str]:
    """Yield a sentence for each chain that misses its deadline, or that nothing proves to meet it."""
    for chain in chains:
        if chain.verdict in {"missed", "not proven"} and chain.deadline:
            bound, deadline = value_format.display_duration(chain.bound), value_format.display_duration(chain.deadline)
            title = lookup.architecture.chains[chain.id].title
            yield f"{title} has to be done within {deadline}; expected at the latest: {bound}."


def _find_qos_clashes(lookup: Lookup, interface: PartnerInterface) -> Iterator[str]:
    for writer in _list_written(lookup, interface.giver_endpoints):
        for reader in _list_written(lookup, interface.taker_endpoints):
            conflicts = tuple(find_qos_conflicts(writer.qos, reader.qos)) if writer.label == reader.label else ()
            if conflicts:
                requests = " and ".join(conflict.requested for conflict in conflicts)
                offers = " and ".join(conflict.offered for conflict in conflicts)
                yield f"`{reader.node}` asks for {requests}, and `{writer.node}` offers {offers}: nothing arrives."


def _list_written(lookup: Lookup, endpoints: Iterable[Endpoint]) -> list[Endpoint]:
    return [endpoint for endpoint in endpoints if lookup.architecture.nodes[endpoint.node].written]


def list_missing_data_duties(
    lookup: Lookup, interface: PartnerInterface, ports: Sequence[CountedPort], giver: str, taker: str
) -> Iterator[str]:
    """Yield sentences on what each side, named by its title, promises or bears where data does not come in time.

    `ports` are the outputs whose word counts for its readers.
    """
    architecture = lookup.architecture
    givers = list_givers(lookup.architecture, interface)
    sentences: dict[str, None] = {}
    for endpoint in givers:
        output_timing = find_giver_timing(lookup, endpoint).outputs.get(endpoint.port or "")
        if interface.flow == "topic" and output_timing and output_timing.conditional:
            max_gap = output_timing.max_gap or next((each.promise.max_gap for each in ports), None)
            sentences[_describe_silence(giver, str(max_gap or ""))] = None
        if interface.flow == "topic" and not is_ros_1(architecture.distro):
            sentences |= dict.fromkeys(_describe_qos_limits(giver, endpoint))
    for promise in (each.promise for each in ports):
        if promise.max_gap and not any(f" {promise.max_gap} pass " in each for each in sentences):
            sentences[f"{giver} lets no more than {promise.max_gap} pass between two messages."] = None
        if promise.max_age:
            sentences[f"{giver} promises that what is read is no older than {promise.max_age}."] = None
    for input_port in interface.inputs:
        if input_port.optional:
            component = architecture.components[input_port.component].title
            sentences[f"{component} of {taker} works without it: its input `{input_port.name}` is optional."] = None
    yield from sentences


def _describe_silence(giver: str, max_gap: str) -> str:
    if max_gap:
        return f"It is sent only when there is something to send, but {giver} lets no more than {max_gap} pass between two messages."
    return f"It is sent only when there is something to send: {giver} does not promise how long it may be silent."


def _describe_qos_limits(giver: str, endpoint: Endpoint) -> Iterator[str]:
    """Yield what the quality of service promises: ROS 2 itself tells both sides where a deadline or lease is missed."""
    qos = endpoint.qos
    if qos.deadline:
        yield f"{giver} lets no more than {qos.deadline} pass between two messages (deadline of the quality of service)."
    if qos.lifespan:
        yield f"A message that is older than {qos.lifespan} is not delivered any more (lifespan)."
    if qos.lease_duration:
        yield f"{giver} counts as gone after {qos.lease_duration} without a sign of life (lease duration)."


_FLOW_NAMES = {"topic": "Topic", "service": "Service", "action": "Action", "physical": ""}
_SETTLED_TERMS = {"type", "message", RATE.key, "size", "response"}
"""Keys of terms without which an interface is not settled: of these somebody has to know something, and promise `qos`."""


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
    qos_identity: str = ""
    """The values of the quality of service, whatever words they are in."""


@dataclass(frozen=True, slots=True)
class InterfaceTerms:
    """An interface with all that is said of it. `field_rows` is None if the message has no definition.

    `facts` say what it is, `promise_rows` what is promised and expected of it; `version` is its hash.
    """

    interface: PartnerInterface
    title: str
    version: str
    facts: tuple[Fact, ...]
    promise_rows: tuple[PromiseRow, ...]
    ends: tuple[InterfaceEnd, ...]
    field_rows: tuple[message_fields.FieldRow, ...] | None
    chains: tuple[ChainResult, ...]
    requirements: tuple[Inlines, ...]
    missing_data_duties: tuple[str, ...]
    """Sentences on what holds where data is late or missing."""
    contradictions: tuple[str, ...]
    """Sentences on what does not fit together between the two."""
    late_chains: tuple[str, ...]
    """Sentences on chains through the interface that miss their deadline."""
    shared_notes: tuple[str, ...]
    """Sentences on what both partners, or a partner and a third one, are responsible for together."""
    agreed: Mapping[str, str]
    """What the partners wrote of it below `agreements`, by the names of terms."""
    first_version: str
    """Its version by the first rules: those of older signatures."""

    def find_version(self, rules: int) -> str:
        """Return its version by the rules of a signature."""
        return self.version if rules > 1 else self.first_version

    @property
    def open_terms(self) -> tuple[str, ...]:
        """Return the names of the terms that are still to be settled."""
        return tuple("definition of the message" if name.key == "fields" else name.words for name in self.open_names)

    @property
    def open_points(self) -> tuple[str, ...]:
        """Return a sentence for each term that is still to be settled, and for each contradiction."""
        return (*map(describe_open_term, self.open_names), *self.contradictions, *self.late_chains)

    @property
    def open_names(self) -> tuple[TermName, ...]:
        """Return the terms that are still to be settled, as facts and rows name them."""
        return tuple(self._list_open_names())

    def _list_open_names(self) -> Iterator[TermName]:
        for fact in self.facts:
            if fact.key in _SETTLED_TERMS and all(run.muted for run in fact.value):
                yield TermName(fact.key, fact.title)
        for row in self.promise_rows:
            is_open = row.name.key in _SETTLED_TERMS and not (row.promised or row.expected)
            if is_open or (row.name == QOS_OFFERED and not row.promised):
                yield row.name
        if self.interface.message and self.field_rows is None:
            yield TermName("fields", "Fields")


def gather_terms(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> InterfaceTerms:
    """Gather all terms of an interface."""
    chains = tuple(promise_rows.find_chains_through(lookup, activity_names, interface))
    giver, taker = (join_owner_titles(lookup, [partner]) for partner in interface.pair)
    ports = output_promises.list_counted_ports(lookup, interface)
    version = output_promises.hash_interface(lookup, interface)
    is_launched = any(output_promises.list_launch_words(interface))
    agreement = find_agreement(lookup.architecture.agreements, *interface.pair)
    return InterfaceTerms(
        interface,
        interface_title(lookup, interface),
        version,
        (*_list_facts(lookup, interface), *output_promises.list_word_facts(ports)),
        tuple(_list_promises(lookup, activity_names, interface, ports)),
        tuple(_list_ends(lookup, interface)),
        message_fields.list_field_rows(lookup.architecture.interfaces, interface.message)
        if interface.message
        else None,
        chains,
        tuple(_requirement_runs(lookup, interface, chains)),
        tuple(list_missing_data_duties(lookup, interface, ports, giver, taker)),
        (
            *_find_contradictions(lookup, activity_names, interface),
            *output_promises.find_broken_words(lookup, interface, ports),
        ),
        tuple(_find_late_chains(lookup, chains)),
        tuple(_shared_sentences(lookup, interface)),
        {name: text for name in INTERFACE_TERMS if (text := agreement.find_term(name, interface.key))},
        output_promises.hash_interface(lookup, interface, rules=1) if is_launched else version,
    )


def interface_title(lookup: Lookup, interface: PartnerInterface) -> str:
    """Return the name of an interface for people: component and port, or its topic."""
    if interface.output is None:
        return interface.key
    return (
        f"{name_in_place(lookup, lookup.architecture.components[interface.output.component])} · {interface.output.name}"
    )


def _list_facts(lookup: Lookup, interface: PartnerInterface) -> Iterator[Fact]:
    flow_name = _FLOW_NAMES[interface.flow]
    if interface.flow == "physical":
        yield Fact("", "Kind", inline_text.to_inlines("physical: neither message nor topic"))
    elif interface.medium:
        yield Fact("", "Kind", inline_text.to_inlines(f"{interface.medium}: no ROS"))
        names = [endpoint.label.partition(" ")[2] for endpoint in interface.giver_endpoints if endpoint.name_written]
        if names:
            yield Fact("", "Name", inline_text.join_lines((Text(name, code=True),) for name in dict.fromkeys(names)))
    else:
        topics = inline_text.join_inlines((inline_text.topic_link(name),) for name in interface.topic_names)
        yield Fact("", flow_name, topics or inline_text.UNKNOWN_INLINES)
    # Where no type has a name, the message alone says what flows.
    if interface.type or not interface.message:
        yield Fact("type", "Type", inline_text.type_link(interface.type))
    if interface.output and interface.output.description:
        yield Fact("meaning", "Meaning", inline_text.to_inlines(interface.output.description))
    if interface.output and (frame_name := lookup.architecture.frame_of(interface.output)):
        yield Fact("", "Frame", inline_text.to_code(frame_name))
    yield from _list_declared_properties(lookup, interface)
    if interface.flow != "physical" and not interface.medium:
        yield from _list_message_facts(lookup, interface)
    launch_words = dict.fromkeys(sentence for sentence, _ in output_promises.list_launch_words(interface))
    if launch_words:
        yield Fact("launch", "As launched", inline_text.join_lines(map(inline_text.message_to_inlines, launch_words)))
    other_components = dict.fromkeys(other_input.component for other_input in interface.other_inputs)
    if other_components:
        readers = inline_text.join_lines(_other_reader(lookup, component) for component in other_components)
        yield Fact("other_readers", "Also read by", readers)


def _list_declared_properties(lookup: Lookup, interface: PartnerInterface) -> Iterator[Fact]:
    """Yield the properties of an output that the project declares: what it says freely is no term."""
    own_properties = interface.output.annotations.properties if interface.output else {}
    for declared in lookup.architecture.properties.values():
        if declared.id in own_properties:
            yield Fact("", declared.title, inline_text.to_inlines(own_properties[declared.id]))


def _list_message_facts(lookup: Lookup, interface: PartnerInterface) -> Iterator[Fact]:
    yield Fact("message", "Message", _message_runs(lookup, interface))
    definition = lookup.architecture.interfaces.definitions.get(interface.message or "")
    if definition and definition.comment:
        yield Fact("", "About the message", inline_text.to_inlines(" ".join(definition.comment.split())))


def _message_runs(lookup: Lookup, interface: PartnerInterface) -> Inlines:
    if interface.message is None:
        return inline_text.UNKNOWN_INLINES
    message_type = lookup.architecture.types.get(interface.type or "")
    planned_note = [" (planned)"] if message_type and message_type.status == "planned" else []
    return inline_text.to_inlines(message_link(interface.message), *planned_note)


def _list_promises(
    lookup: Lookup,
    activity_names: activity_builder.ActivityNames,
    interface: PartnerInterface,
    ports: Sequence[output_promises.CountedPort],
) -> Iterator[PromiseRow]:
    timing_rows = promise_rows.promise_timing(lookup, activity_names, interface)
    yield from output_promises.add_promises(lookup, activity_names, interface, ports, timing_rows)
    if interface.flow == "topic" and not interface.medium and not is_ros_1(lookup.architecture.distro):
        yield _promise_qos(interface.giver_endpoints)


def _promise_qos(endpoints: Sequence[Endpoint]) -> PromiseRow:
    written = [endpoint.qos for endpoint in endpoints if endpoint.qos.written]
    if not written:
        return PromiseRow(
            QOS_OFFERED, expected=inline_text.to_inlines(f"{inline_text.format_qos(Qos())} (ROS's default)")
        )
    lines = dict.fromkeys(map(describe_qos, endpoints))
    measures = list(map(measure_qos, written))
    # Of several publishers the one that promises least counts.
    strength: PromiseStrength = {
        aspect: min(measure[aspect] for measure in measures)
        for aspect in measures[0]
        if all(aspect in measure for measure in measures)
    }
    runs = inline_text.join_lines(map(inline_text.to_inlines, lines))
    identities = sorted({identify_qos(endpoint.qos) for endpoint in endpoints})
    return PromiseRow(QOS_OFFERED, runs, (), strength, "; ".join(identities))


def describe_qos(endpoint: Endpoint) -> str:
    """Return a QoS in words; one that nobody wrote is the default."""
    return inline_text.format_qos(endpoint.qos) if endpoint.qos.written else "default (not written)"


def _other_reader(lookup: Lookup, component_id: str) -> Inlines:
    component_model = lookup.architecture.components[component_id]
    owners = inline_text.join_inlines(
        inline_text.partner_link(lookup.architecture, owner) for owner in component_model.owners
    )
    return (inline_text.component_link(component_model), *((Text(" ("), *owners, Text(")")) if owners else ()))


def _list_ends(lookup: Lookup, interface: PartnerInterface) -> Iterator[InterfaceEnd]:
    giving_components, taking_components = components_at_ends(lookup.architecture, interface)
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
        marks = ["optional"] if input_port.optional else []
        marks += [f"no older than {input_port.freshness}"] if input_port.freshness else []
        role = f"{verbs[1]} ({', '.join(marks)})" if marks else verbs[1]
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
    rows: dict[tuple[str, str, str], None] = {}
    for endpoint in (endpoint for endpoint in endpoints if architecture.nodes[endpoint.node].written):
        # A dict as an ordered set: several endpoints of a node with one QoS are one row.
        has_qos = endpoint.flow == "topic" and with_qos and endpoint.medium == "ros"
        qos_texts = (describe_qos(endpoint), identify_qos(endpoint.qos)) if has_qos else ("", "")
        rows[endpoint.node, *qos_texts] = None
    for node, qos, qos_identity in rows:
        owners = (
            dict.fromkeys((*component_owners, *foreign_owners(architecture, architecture.nodes[node])))
            or architecture.nodes[node].owners
        )
        yield InterfaceEnd(role, tuple(owners), component, port, node, qos, is_taker, qos_identity)
    if not rows:
        yield InterfaceEnd(role, component_owners, component, port, None, "", is_taker)


def _components_of(lookup: Lookup, interface: PartnerInterface) -> Iterable[Component]:
    """Return the components at both ends, each once."""
    return {
        component.id: component
        for components_of_end in components_at_ends(lookup.architecture, interface)
        for component in components_of_end
    }.values()


def _requirement_runs(lookup: Lookup, interface: PartnerInterface, chains: Iterable[ChainResult]) -> Iterator[Inlines]:
    """Yield the requirements that the components at the ends serve, each once, with the components.

    Then those that only chains through the interface serve, with the chains.
    """
    links_by_requirement: dict[str, dict[str, Text]] = {}
    for component in _components_of(lookup, interface):
        for use in component.requirements:
            links_by_requirement.setdefault(use.text, {})[component.title] = inline_text.component_link(component)
    served_by_components = frozenset(links_by_requirement)
    for result in chains:
        chain = lookup.architecture.chains[result.id]
        for text in chain.requirements:
            if text not in served_by_components:
                links_by_requirement.setdefault(text, {})[chain.id] = Text(
                    f"the chain {chain.title}", ref=f"chain:{chain.id}"
                )
    for text, named_links in links_by_requirement.items():
        declared = lookup.architecture.requirements.get(text)
        requirement_runs = (
            [Text(text, ref=f"requirement:{text}", strong=True), Text(f" {declared.title}")]
            if declared
            else [Text(text)]
        )
        names = inline_text.join_inlines(((link,) for link in named_links.values()), ", ")
        # All of it is muted: that tells the titles, which may change, from the requirement.
        yield (
            *requirement_runs,
            Text(" (", muted=True),
            *(replace(run, muted=True) for run in names),
            Text(")", muted=True),
        )


def _shared_sentences(lookup: Lookup, interface: PartnerInterface) -> Iterator[str]:
    architecture = lookup.architecture
    for component in _components_of(lookup, interface):
        if len(component.owners) > 1:
            yield f"{component.title} belongs to {join_owner_titles(lookup, component.owners)} together: each answers for this interface."
    for node_id in dict.fromkeys(
        endpoint.node for endpoint in (*interface.giver_endpoints, *interface.taker_endpoints)
    ):
        component_titles = [architecture.components[name].title for name in architecture.nodes[node_id].implements]
        if (owners := foreign_owners(architecture, architecture.nodes[node_id])) and component_titles:
            yield f"{join_owner_titles(lookup, owners)} implements {', '.join(component_titles)} with the node {node_id}, and answers for this interface too."
