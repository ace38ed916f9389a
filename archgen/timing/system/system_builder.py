"""Build a timing system from an architecture: activities and the arcs between them, all durations in one unit."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from functools import cache

from archgen.diagnostics.common_wording import join_first
from archgen.diagnostics.source_span import NO_SPAN, Span
from archgen.frozen import NamedTuple, dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.deployment import Link
from archgen.model.node import QOS_PROFILES, Endpoint, Node, Topic
from archgen.model.port_media import is_physical
from archgen.model.runtime_facts import count_node_threads, find_container_threads, find_library, find_usual_order
from archgen.timing.analysis import Reason
from archgen.timing.figures.tick_unit import TickUnit, choose_tick_unit
from archgen.timing.system import message_sizes
from archgen.timing.system.activity_builder import (
    ActivityNames,
    BuiltParts,
    activity_of_endpoint,
    build_activities,
    endpoint_key,
    executor_key,
    name_activities,
)
from archgen.timing.system.core_placement import build_fair_share
from archgen.timing.system.timing_system import Activity, Arc, Executor, SharedResource, TimingSystem, group_arcs

LinkRoute = tuple[str | None, int | None, int | None]
"""A link (None on one host), with its best and worst latency in ticks (None where unknown)."""
_SAME_HOST: LinkRoute = (None, 0, 0)
_NO_LINK: LinkRoute = (None, None, None)


def build_arcs(
    architecture: Architecture,
    activity_names: ActivityNames,
    activities_by_id: Mapping[str, Activity],
    tick_unit: TickUnit,
) -> tuple[Arc, ...]:
    """Join writers with readers, topic by topic; services and actions in both directions."""
    joiner = _ArcJoiner(
        architecture,
        activity_names,
        _place_activities(architecture, activities_by_id).__getitem__,
        # Cached by pair of hosts: there are far more arcs than pairs.
        cache(_RouteFinder(architecture, tick_unit)),
        {(edge.output, edge.input): edge.at for edge in architecture.edges},
        message_sizes.make_writer_query(architecture),
    )
    return tuple(arc for _, topic in architecture.list_carriers() for arc in joiner.join_topic(topic))


class _Place(NamedTuple):
    """Where an activity runs: its host, and the device that it is or is in, with the links on which that is."""

    host: str | None
    device: str | None = None
    device_links: tuple[str, ...] = ()


def _place_activities(architecture: Architecture, activities_by_id: Mapping[str, Activity]) -> Mapping[str, _Place]:
    devices = _index_devices(architecture)
    return {
        name: _Place(activity.host, *devices.get(activity.component or "", ()))
        for name, activity in activities_by_id.items()
    }


def _index_devices(architecture: Architecture) -> Mapping[str, tuple[str, tuple[str, ...]]]:
    """Return the device that each component is or is in, and the links on which that is."""
    links_by_device: dict[str, tuple[str, ...]] = {}
    for link in architecture.links.values():
        for device in link.devices:
            links_by_device[device] = (*links_by_device.get(device, ()), link.id)
    return {
        leaf: (device, links) for device, links in links_by_device.items() for leaf in architecture.leaves_of(device)
    }


@dataclass(frozen=True, slots=True)
class _ArcJoiner:
    """The look-ups that each pair of a writer and a reader needs."""

    architecture: Architecture
    activity_names: ActivityNames
    place_of: Callable[[str], _Place]
    find_route: Callable[[_Place, _Place], LinkRoute]
    spans: Mapping[tuple[str, str], Span]
    size_of: Callable[[Endpoint, message_sizes.MessageRole], int | None]

    def join_topic(self, topic: Topic) -> Iterator[Arc]:
        """Yield the arcs of one topic, service or action."""
        for reader in topic.readers:
            for writer in topic.writers:
                # A shared topic would join all nodes with all others: only what an input names counts.
                if topic.shared and writer.port not in reader.sources:
                    continue
                if topic.flow == "topic":
                    yield self._data_arc(topic, writer, reader, self.size_of(writer, "data"))
                else:
                    # The server is the writer of a service, so that the arc from writer to reader is the answer.
                    answer_arc = self._data_arc(topic, writer, reader, None)
                    yield replace(self._request_arc(answer_arc), size=self.size_of(writer, "request"))
                    yield replace(answer_arc, role="answer", size=self.size_of(writer, "answer"))

    def _data_arc(self, topic: Topic, writer: Endpoint, reader: Endpoint, size: int | None) -> Arc:
        source = activity_of_endpoint(self.activity_names, writer)
        target = activity_of_endpoint(self.activity_names, reader)
        link, best, worst = self.find_route(self.place_of(source), self.place_of(target))
        port = self.architecture.inputs.get(reader.port or "")
        qos = reader.qos
        return Arc(
            source=source,
            output=endpoint_key(writer),
            target=target,
            input=endpoint_key(reader),
            topic=topic.name,
            flow=topic.flow,
            link=link,
            best=best,
            worst=worst,
            depth=None if qos.history == "keep_all" else qos.depth,
            size=size,
            optional=bool(port and port.optional),
            depth_written=qos.written and qos.depth != QOS_PROFILES[qos.profile].depth,
            at=self._span_of_arc(writer, reader),
            queue_at=qos.at,
        )

    def _request_arc(self, answer_arc: Arc) -> Arc:
        """Return the arc from client to server that belongs to an answer."""
        link, best, worst = self.find_route(self.place_of(answer_arc.target), self.place_of(answer_arc.source))
        return replace(
            answer_arc,
            source=answer_arc.target,
            output=answer_arc.input,
            target=answer_arc.source,
            input=answer_arc.output,
            role="request",
            link=link,
            best=best,
            worst=worst,
        )

    def _span_of_arc(self, writer: Endpoint, reader: Endpoint) -> Span:
        """Return the reference that joins the two; where they only meet on a topic, the place of the reader."""
        span = self.spans.get((writer.port or "", reader.port or ""))
        if span is not None:
            return span
        port = self.architecture.inputs.get(reader.port or "")
        return reader.at if reader.at != NO_SPAN or port is None else port.at


class _RouteFinder:
    """Finds the link between two hosts: of several the one with the least worst latency."""

    def __init__(self, architecture: Architecture, tick_unit: TickUnit) -> None:
        self._tick_unit = tick_unit
        self._links = architecture.links
        self._links_of_host: dict[str, dict[str, Link]] = defaultdict(dict)
        for link in architecture.links.values():
            for host in link.connects:
                self._links_of_host[host][link.id] = link

    def __call__(self, source: _Place, target: _Place) -> LinkRoute:
        """Return the link between two places and its latency.

        What a device exchanges with a host goes over the link that joins the two. Where neither end has a host, both are
        taken to be on one; where only one has, the latency is unknown.
        """
        common_links = self._find_device_links(source, target)
        if not common_links:
            # Of a device without a host nobody knows that it is where another end without one is.
            if source.host == target.host and (source.host or source.device == target.device):
                return _SAME_HOST
            if source.host is None or target.host is None:
                return _NO_LINK
            target_links = self._links_of_host[target.host]
            host_links = self._links_of_host[source.host].items()
            common_links = [link for link_id, link in host_links if link_id in target_links]
        if not common_links:
            return _NO_LINK
        # Those without a worst latency come last.
        link = min(common_links, key=lambda each: (each.worst is None, each.worst.value if each.worst else 0))
        return link.id, self._tick_unit.quantity_to_ticks(link.best), self._tick_unit.quantity_to_ticks(link.worst)

    def _find_device_links(self, source: _Place, target: _Place) -> list[Link]:
        """Return the links of a device that the other end is on, as a host or as another device."""
        if source.device == target.device:
            return []
        links = dict.fromkeys((*source.device_links, *target.device_links))
        return [self._links[link] for link in links if self._is_on(link, source) and self._is_on(link, target)]

    def _is_on(self, link_id: str, place: _Place) -> bool:
        return link_id in place.device_links or (place.host or "") in self._links[link_id].connects


_BITS_PER_BYTE = 8


def build_system(
    architecture: Architecture, memory: BuiltParts | None = None
) -> tuple[TimingSystem, tuple[Reason, ...]]:
    """Build the system of a linked architecture, with notes on what had to be assumed.

    What `memory` knows from another version of the project is taken over where it is the same.
    """
    tick_unit = choose_tick_unit(architecture)
    activity_names = name_activities(architecture)
    activities_by_id = build_activities(architecture, activity_names, tick_unit, memory)
    all_arcs = build_arcs(architecture, activity_names, activities_by_id, tick_unit)
    notes = (
        ()
        if tick_unit.exact
        else (Reason("the rates have no common measure of reasonable size: periods are rounded up"),)
    )
    timing_system = TimingSystem(
        tick=tick_unit.tick,
        activities=activities_by_id,
        arcs=all_arcs,
        arcs_into=group_arcs((arc.target, arc) for arc in all_arcs),
        arcs_from=group_arcs((arc.source, arc) for arc in all_arcs),
        external_inputs=dict(_external_inputs(architecture, activities_by_id)),
        optional_inputs=frozenset(port.id for port in architecture.inputs.values() if port.optional),
        cores={host.id: host.cores for host in architecture.hosts.values()},
        executors={executor.id: executor for executor in _build_executors(architecture, activities_by_id)},
        resources={
            # What drivers do, where nobody wrote anything else.
            resource.id: SharedResource(
                resource.id, resource.host, resource.scheduling or "fifo", not resource.scheduling
            )
            for resource in architecture.resources.values()
        },
        host_orders={host.id: host.scheduling for host in architecture.hosts.values() if host.scheduling},
        core_orders={
            (host.id, core): order
            for host in architecture.hosts.values()
            for core, order in host.core_scheduling.items()
        },
        fair_shares={
            host.id: build_fair_share(host, tick_unit)
            for host in architecture.hosts.values()
            if host.scheduling in {None, "fair"}
        },
        bandwidths={
            link.id: link.bandwidth.value / _BITS_PER_BYTE if link.bandwidth else None
            for link in architecture.links.values()
        },
        served_outputs=frozenset(
            (activity_of_endpoint(activity_names, endpoint), endpoint_key(endpoint))
            for endpoint in architecture.list_endpoints()
            if endpoint.use == "serves"
        ),
        topic_writers={
            name: tuple(
                (activity_of_endpoint(activity_names, endpoint), endpoint_key(endpoint)) for endpoint in topic.writers
            )
            for name, topic in architecture.list_carriers()
            if topic.flow == "topic"
        },
        topic_sizes=message_sizes.find_topic_sizes(architecture),
    )
    return timing_system, (*notes, *_note_languages(architecture))


def _build_executors(architecture: Architecture, activities_by_id: Mapping[str, Activity]) -> Iterator[Executor]:
    """Yield the processes: each container, and each node outside of one."""
    usual_order = find_usual_order(architecture)
    suspending = {activity.executor for activity in activities_by_id.values() if activity.suspends}
    nodes_in: dict[str, list[Node]] = {container: [] for container in architecture.containers}
    for node in architecture.nodes.values():
        if node.container:
            nodes_in[node.container].append(node)
    for container in architecture.containers.values():
        key, nodes = f"container {container.id}", nodes_in[container.id]
        # Where nobody says its host, it is the one that its nodes name, if they agree.
        node_hosts = dict.fromkeys(node.host for node in nodes)
        host = container.host or (next(iter(node_hosts)) if len(node_hosts) == 1 else None)
        threads = find_container_threads(architecture, container)
        yield Executor(key, threads, host, container.scheduling, find_library(nodes), key in suspending, usual_order)
    for node in architecture.nodes.values():
        if not node.container:
            key = executor_key(node)
            threads = count_node_threads(node)
            yield Executor(
                key, threads, node.host, node.scheduling, find_library([node]), key in suspending, usual_order
            )


def _note_languages(architecture: Architecture) -> Iterator[Reason]:
    """Yield what is taken for granted of nodes with several threads that say no language."""
    nodes = [each for each in architecture.nodes.values() if not each.container and count_node_threads(each) > 1]
    unsaid = tuple(each.id for each in nodes if each.language is None and (each.reentrant or len(each.implements) > 1))
    if unsaid:
        names, at = join_first(unsaid), architecture.nodes[unsaid[0]].at
        yield Reason(
            "no `language` is written for {0}: all threads compute at once, as in C++ and not in Python", at, (names,)
        )


def _external_inputs(
    architecture: Architecture, activities_by_id: Mapping[str, Activity]
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the inputs that something feeds from outside of the architecture."""
    for activity in activities_by_id.values():
        ports = (architecture.inputs.get(port) for port in activity.inputs)
        # An input whose `from` names something that does not exist counts as fed from outside: the wrong name is
        # reported elsewhere, and an input that nothing feeds would keep an all-of reader from ever firing.
        external_ports = tuple(
            p.id for p in ports if p and (p.external or is_physical(p) or (p.from_written and not p.connections))
        )
        if external_ports:
            yield activity.id, external_ports
