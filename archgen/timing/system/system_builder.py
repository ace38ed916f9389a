"""Build a timing system from an architecture: activities and the arcs between them, all durations in one unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics.common_wording import join_first
from archgen.model.architecture import Architecture
from archgen.model.node import Node
from archgen.model.port_media import is_physical
from archgen.model.runtime_facts import count_node_threads, find_container_threads, find_library, find_usual_order
from archgen.timing.analysis import Reason
from archgen.timing.figures.tick_unit import choose_tick_unit
from archgen.timing.system import message_sizes
from archgen.timing.system.activity_builder import (
    activity_of_endpoint,
    build_activities,
    endpoint_key,
    executor_key,
    name_activities,
)
from archgen.timing.system.arc_builder import build_arcs
from archgen.timing.system.built_parts import BuiltParts
from archgen.timing.system.fair_hosts import build_fair_share
from archgen.timing.system.timing_system import Activity, Executor, SharedResource, TimingSystem, group_arcs

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
