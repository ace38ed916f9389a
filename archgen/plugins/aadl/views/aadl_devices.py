"""Sensors, motors and other things that no program is: devices of AADL, with their ports and the buses that they are on."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from archgen.plugin.generating import write_place
from archgen.plugin.model import Architecture, Component, Node, is_physical
from archgen.plugins.aadl.views.aadl_behaviours import Behaviour
from archgen.plugins.aadl.views.aadl_hints import list_own_sources
from archgen.plugins.aadl.views.aadl_processes import NodeProcess
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    list_component_words,
    make_classifier,
    make_item,
    make_named_properties,
    make_text_properties,
)

_DEVICE_TAG = "device"


def is_device(architecture: Architecture, node: Node, linked_devices: Collection[str]) -> bool:
    """Return whether a node is only planned, for what is no program: a device by its tag, on a link, or by its ports."""
    component = architecture.find_component(node.implements[0]) if len(node.implements) == 1 else None
    if node.written or component is None:
        return False
    is_all_physical = bool(component.ports) and all(map(is_physical, component.ports))
    return _DEVICE_TAG in component.tags or component.id in linked_devices or is_all_physical


class NodeDevice(NodeProcess):
    """A component that is a device: as a process to all that is joined to it, but without threads and without ROS."""

    category = "device"
    reserved_names = ()
    may_use_tf = False

    @property
    def classifier(self) -> str:
        """What its subcomponent is made from, within its package."""
        return self.name

    @property
    def component(self) -> Component:
        """The component that is the device."""
        return next(iter(self.behaviours.values())).component

    def _add_thread(self, behaviour: Behaviour, package_names: NameSpace, *, is_only: bool) -> None:
        """Say of the device itself what would be said of its thread."""
        del package_names, is_only
        properties = behaviour.list_properties()
        jitter = behaviour.timing.jitter
        if jitter:
            # AADL has a jitter for threads alone.
            properties = [each for each in properties if each["name"] != "Dispatch_Jitter"]
            properties += make_text_properties(jitter=str(jitter))
        self.properties += properties
        features = {behaviour.port_names[part.key]: self.features[part.key] for part in behaviour.parts}
        self.properties += [
            {**each, "applies_to": features[each["applies_to"]]} for each in self._list_queue_sizes(behaviour)
        ]

    def add_bus_access(self, wanted_name: str, bus: str) -> str:
        """Add access to a bus, `bus access hosts::lan`; return what it is called."""
        name = self.names.take_name(wanted_name)
        self.feature_items.append(make_item(name, f"requires {bus}"))
        return name

    def list_words(self) -> list[AadlProperty]:
        """Return what it says of itself beside its ports and its timing."""
        component = self.component
        properties = make_named_properties(component.id, component.id, component.title)
        return properties + list_component_words(component, component.role, self.find_own_owner(component))

    def make_classifiers(self) -> list[dict[str, Any]]:
        """Return its type; what it consists of is not said."""
        properties = [*self.list_words(), *list_own_sources(self._hints), *self.properties]
        device = make_classifier("device", self.name, properties=properties, place=write_place(self.component.at))
        return [{**device, "features": self.feature_items, "flows": self.flows}]
