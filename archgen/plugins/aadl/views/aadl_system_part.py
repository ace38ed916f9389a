"""A group or a composed component as a system of AADL, with what grows in it: features, subcomponents, connections, flows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin.generating import write_place
from archgen.plugin.model import Component, Group
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    list_tags,
    make_classifier,
    make_item,
    make_named_properties,
    make_text_properties,
)

_Place = tuple[str, object]
"""A port of a composed component with what it carries, or a node with the key of its port."""


class SystemPart:
    """A system: the launch of everything, a group, or a composed component; it grows as connections and flows are found."""

    def __init__(
        self, name: str, classifier: str, parent: SystemPart | None, element: Group | Component | None
    ) -> None:
        """Begin with nothing inside; `name` is what it is called in the system around it."""
        self.name, self.classifier, self.parent, self.element = name, classifier, parent, element
        self.names = NameSpace()
        self.features: dict[_Place, str] = {}
        self.feature_items: list[dict[str, Any]] = []
        self.subcomponents: list[dict[str, Any]] = []
        self.connections: list[dict[str, Any]] = []
        self.flow_specs: list[dict[str, Any]] = []
        self.flows: list[dict[str, Any]] = []
        self.properties: list[AadlProperty] = []
        self._joined: dict[tuple[str, str], str] = {}
        self.accesses: dict[str, str] = {}
        """The names of its accesses to what something inside needs of the outermost system."""

    @property
    def path(self) -> tuple[SystemPart, ...]:
        """The systems that lead here, from the outermost on."""
        return (*(self.parent.path if self.parent else ()), self)

    def name_inside(self, scope: SystemPart, name: str) -> str:
        """Return how something of this system is named from a system around it: `group.arm.motor`."""
        steps = self.path[len(scope.path) :]
        return ".".join((*(each.name for each in steps), name))

    def connect(self, name: str, text: str, properties: list[AadlProperty]) -> str:
        """Add a connection; return its name."""
        own_name = self.names.take_name(name)
        self.connections.append(make_item(own_name, text, properties))
        return own_name

    def join_ends(self, name: str, kind: str, ends: tuple[str, str], properties: list[AadlProperty]) -> str:
        """Join two ends that may be joined already; return the connection's name."""
        if ends not in self._joined:
            self._joined[ends] = self.connect(name, f"{kind} {ends[0]} -> {ends[1]}", properties)
        return self._joined[ends]

    def make_classifiers(self, properties: list[AadlProperty]) -> list[dict[str, Any]]:
        """Return its type, with further properties, and its implementation."""
        own_type = make_classifier("system", self.classifier, features=self.feature_items, flows=self.flow_specs)
        own_type.update(properties=properties, place=write_place(self.element.at) if self.element else "")
        implementation = make_classifier("system", f"{self.classifier}.impl")
        implementation.update(
            subcomponents=self.subcomponents,
            connections=self.connections,
            flows=self.flows,
            properties=self.properties,
        )
        return [own_type, implementation]


def list_system_properties(element: Group | Component) -> list[AadlProperty]:
    """Return what a group or a composed component says of itself."""
    own_id = element.id.rpartition(".")[2]
    texts: Mapping[str, str | None] = {
        "description": element.description,
        "functionality": getattr(element, "functionality", None),
        "owner": element.owner,
    }
    return [
        *(each for each in make_named_properties(own_id, own_id, element.title)),
        *make_text_properties(**texts),
        *list_tags(element),
    ]
