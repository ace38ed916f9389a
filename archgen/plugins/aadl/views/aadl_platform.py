"""Computers, containers, links and devices as processors, virtual processors, buses and devices of AADL."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from fractions import Fraction
from typing import Any

from archgen.plugin.generating import write_place
from archgen.plugin.model import Architecture, Container, Host, Link
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    can_be_written,
    make_classifier,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
    write_aadl_duration,
    write_range,
)

_SCHEDULING: Mapping[str, str] = {
    "fixed_priority": "POSIX_1003_HIGHEST_PRIORITY_FIRST_PROTOCOL",
    "edf": "EARLIEST_DEADLINE_FIRST_PROTOCOL",
    "round_robin": "ROUND_ROBIN_PROTOCOL",
}


class Platform:
    """The package of hosts, and what of it stands in the system."""

    def __init__(
        self,
        architecture: Architecture,
        hosts: Collection[str],
        system_names: NameSpace,
        package_name: str,
        placed_devices: Collection[str],
    ) -> None:
        """Write the wanted hosts with their containers, and the links that join two of them or one and a device.

        `placed_devices` are components that are devices elsewhere; of the others a device stands beside the process.
        """
        self.names: dict[tuple[str, str], str] = {}
        """What elements are called in the system, by kind and id."""
        self.classifiers: list[dict[str, Any]] = []
        self.subcomponents: list[dict[str, Any]] = []
        self.connections: list[dict[str, Any]] = []
        self.properties: list[AadlProperty] = []
        self._classifier_names = NameSpace()
        self._system_names = system_names
        self._package_name = package_name
        self._buses: dict[str, str] = {}
        wanted_hosts = [host for host in architecture.hosts.values() if host.id in hosts]
        # A link to hosts of others is none of this part.
        links = [
            link
            for link in architecture.links.values()
            if (link.connects or any(each in placed_devices for each in link.devices))
            and all(each in hosts for each in link.connects)
        ]
        for link in links:
            self._add_link(link)
        for host in wanted_hosts:
            self._add_host(host, [link for link in links if host.id in link.connects])
        for container in architecture.containers.values():
            if container.host in hosts:
                self._add_container(container)
        devices: dict[str, list[Link]] = {}
        for link in links:
            for device in link.devices:
                devices.setdefault(device, []).append(link)
        self.links_by_device = {device: [link.id for link in device_links] for device, device_links in devices.items()}
        for component_id, device_links in devices.items():
            if component_id not in placed_devices:
                self._add_device(architecture, component_id, device_links)

    def name_bus(self, link_id: str) -> str:
        """Return the access to a link's bus, as packages elsewhere name it: `bus access hosts::lan`."""
        kind, _, name = self._buses[link_id].rpartition(" ")
        return f"{kind} {self._package_name}::{name}"

    def _add(self, kind: str, category: str, element_id: str, classifier: dict[str, Any]) -> str:
        name = self._system_names.take_name(element_id.rpartition(".")[2])
        self.names[kind, element_id] = name
        self.classifiers.append(classifier)
        self.subcomponents.append(make_item(name, f"{category} {self._package_name}::{classifier['name']}"))
        return name

    def _add_link(self, link: Link) -> None:
        hints = link.annotations.hints.get("aadl")
        is_virtual = isinstance(hints, Mapping) and hints.get("category") == "virtual bus"
        name = self._classifier_names.take_name(link.id)
        properties = make_named_properties(name, link.id, link.title)
        if link.worst and can_be_written(link.worst.value):
            lowest = link.best.value if link.best else Fraction(0)
            properties.append(make_property("Latency", write_range(lowest, link.worst.value)))
        if link.bandwidth and link.bandwidth.value and not is_virtual:
            per_byte = write_aadl_duration(Fraction(8 * 10**9) / link.bandwidth.value, round_up=True)
            value = f"[Fixed => 0 ns .. 0 ns; PerByte => {per_byte} .. {per_byte};]"
            properties.append(make_property("Transmission_Time", value))
        properties += make_text_properties(
            bandwidth=str(link.bandwidth) if link.bandwidth else None, protocol=link.protocol
        )
        category = "virtual bus" if is_virtual else "bus"
        self._buses[link.id] = f"{category} access {name}"
        self._add(
            "link",
            category,
            link.id,
            make_classifier(category, name, properties=properties, place=write_place(link.at)),
        )

    def _make_accesses(self, links: Collection[Link], names: NameSpace) -> list[dict[str, Any]]:
        """Return what has access to links, with the connections to them still open."""
        return [make_item(names.take_name(link.id), f"requires {self._buses[link.id]}") for link in links]

    def _join(self, owner: str, accesses: Collection[dict[str, Any]], links: Collection[Link]) -> None:
        for access, link in zip(accesses, links, strict=True):
            bus = self.names["link", link.id]
            kind = self._buses[link.id].rpartition(" ")[0]
            name = self._system_names.take_name(f"{owner}_{bus}")
            self.connections.append(make_item(name, f"{kind} {bus} -> {owner}.{access['name']}"))

    def _add_host(self, host: Host, links: Collection[Link]) -> None:
        hints = host.annotations.hints.get("aadl")
        is_virtual = isinstance(hints, Mapping) and hints.get("category") == "virtual processor" and not links
        name = self._classifier_names.take_name(host.id)
        accesses = self._make_accesses(links, NameSpace())
        properties = make_named_properties(name, host.id, host.title)
        if host.scheduling and host.scheduling in _SCHEDULING:
            properties.append(make_property("Scheduling_Protocol", f"({_SCHEDULING[host.scheduling]})"))
        elif host.scheduling:
            properties += make_text_properties(scheduling=host.scheduling)
        if host.cores is not None:
            properties.append(make_property("archgen::Cores", str(host.cores)))
        properties += make_text_properties(description=host.description)
        category = "virtual processor" if is_virtual else "processor"
        classifier = make_classifier(
            category, name, features=accesses, properties=properties, place=write_place(host.at)
        )
        self._join(self._add("host", category, host.id, classifier), accesses, links)

    def _add_container(self, container: Container) -> None:
        name = self._classifier_names.take_name(container.id)
        properties = make_named_properties(name, container.id, container.title)
        properties += make_text_properties(container=container.id, scheduling=container.scheduling)
        if container.threads is not None:
            properties.append(make_property("archgen::Threads", str(container.threads)))
        classifier = make_classifier("virtual processor", name, properties=properties, place=write_place(container.at))
        own_name = self._add("container", "virtual processor", container.id, classifier)
        self.properties.append(
            make_property(
                "Actual_Processor_Binding", f"(reference ({self.names['host', container.host or '']}))", own_name
            )
        )

    def _add_device(self, architecture: Architecture, component_id: str, links: Collection[Link]) -> None:
        component = architecture.find_component(component_id)
        if component is None:
            return
        name = self._classifier_names.take_name(component.name)
        # Its data passes through the process of the same component: the device is what stands on the cable.
        accesses = self._make_accesses(links, NameSpace())
        properties = make_text_properties(component=component_id, title=component.title)
        classifier = make_classifier(
            "device", name, features=accesses, properties=properties, place=write_place(component.at)
        )
        self._join(self._add("device", "device", component_id, classifier), accesses, links)
