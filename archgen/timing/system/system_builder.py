"""Build a timing system from an architecture: activities and the arcs between them, all durations in one unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.architecture import Architecture
from archgen.model.deployment import Container
from archgen.model.port_media import is_physical
from archgen.model.process_threads import find_container_threads
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
        threads={each.id: find_container_threads(architecture, each) for each in architecture.containers.values()},
        executors={executor.id: executor for executor in _build_executors(architecture)},
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
    return timing_system, notes


def _build_executors(architecture: Architecture) -> Iterator[Executor]:
    """Yield the processes: each container, and each node outside of one."""
    for container in architecture.containers.values():
        executor_id = f"container {container.id}"
        threads = find_container_threads(architecture, container)
        yield Executor(executor_id, threads, _find_container_host(architecture, container), container.scheduling)
    for node in architecture.nodes.values():
        if not node.container:
            # What `rclcpp::spin(node)` is: one thread.
            yield Executor(executor_key(node), node.threads or 1, node.host, node.scheduling)


def _find_container_host(architecture: Architecture, container: Container) -> str | None:
    """Return the host of a container: its own, or the one that its nodes name, where they agree."""
    node_hosts = dict.fromkeys(node.host for node in architecture.nodes.values() if node.container == container.id)
    return container.host or (next(iter(node_hosts)) if len(node_hosts) == 1 else None)


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
