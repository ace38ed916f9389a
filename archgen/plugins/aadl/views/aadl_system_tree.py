"""The systems of a launch in AADL as one tree, and the ways that data takes through their borders."""

from __future__ import annotations

from archgen.plugin import dataclass
from archgen.plugin.model import Architecture, Component, Group
from archgen.plugins.aadl.views.aadl_ports import PortPart, find_outer_port
from archgen.plugins.aadl.views.aadl_processes import NodeProcess, SystemPart
from archgen.plugins.aadl.views.aadl_words import (
    AadlProperty,
    NameSpace,
    make_item,
    make_named_properties,
    make_property,
    make_text_properties,
)


@dataclass(frozen=True, slots=True)
class Route:
    """How data gets from one process to another: out of systems, over a connection where the ways meet, and into others."""

    outward: tuple[tuple[SystemPart, str, str], ...]
    """Each system that it leaves, the innermost first, with the feature and the connection inside that leads there."""
    scope: SystemPart
    joint: str
    inward: tuple[tuple[SystemPart, str, str], ...]
    """Each system that it enters, the outermost first."""


class SystemTree:
    """All systems of a launch, made as something stands in them."""

    def __init__(self, architecture: Architecture, package_name: str, root: SystemPart) -> None:
        """Begin with the launch; `package_name` is that of the systems."""
        self.root = root
        self.parts: dict[str, SystemPart] = {}
        """Groups and composed components by complete id."""
        self._architecture = architecture
        self._package_name = package_name
        self._classifiers = NameSpace((root.classifier,))

    def find_home(self, process: NodeProcess) -> tuple[SystemPart, str]:
        """Return the system that a process stands in, and the component that it is there; nothing for one of several."""
        components = [found for each in process.node.implements if (found := self._architecture.find_component(each))]
        whole = process.whole
        if whole is not None:
            return self._open_system(whole.parent or whole.group), whole.id
        homes = dict.fromkeys(each.parent or each.group for each in components)
        groups = dict.fromkeys(each.group for each in components)
        home = next(iter(homes)) if len(homes) == 1 else next(iter(groups)) if len(groups) == 1 else None
        system = self._open_system(home) if home else self.root
        return system, components[0].id if len(components) == 1 else ""

    def _open_system(self, element_id: str) -> SystemPart:
        if element_id not in self.parts:
            shell = self._architecture.shells.get(element_id)
            element: Group | Component = shell or self._architecture.groups[element_id]
            around = self._open_system(shell.parent or shell.group) if shell else self.root
            own_id = element_id.rpartition(".")[2]
            name = around.names.take_name(own_id)
            classifier = self._classifiers.take_name(element_id.replace(".", "_"))
            part = SystemPart(name, classifier, around, element)
            item = make_item(
                name, f"system {self._package_name}::{classifier}.impl", make_named_properties(name, own_id)
            )
            around.subcomponents.append(item)
            self.parts[element_id] = part
        return self.parts[element_id]

    def join(
        self,
        source: tuple[NodeProcess, PortPart],
        reader: tuple[NodeProcess, PortPart],
        properties: list[AadlProperty],
    ) -> Route:
        """Join the ports of two processes, through the borders of all systems between them."""
        (sender, output), (receiver, part) = source, reader
        ways = [list(process.home.path) for process in (sender, receiver)]
        shared = 0
        while all(len(way) > shared for way in ways) and ways[0][shared] is ways[1][shared]:
            shared += 1
        end, outward = f"{sender.name_in_system}.{sender.features[output.key]}", []
        for system in reversed(ways[0][shared:]):
            feature, inner = self._cross(system, sender, output, end)
            outward.append((system, feature, inner))
            end = f"{system.name}.{feature}"
        own_end, inward = f"{receiver.name_in_system}.{receiver.features[part.key]}", []
        for system in reversed(ways[1][shared:]):
            feature, inner = self._cross(system, receiver, part, own_end)
            inward.append((system, feature, inner))
            own_end = f"{system.name}.{feature}"
        scope = ways[0][shared - 1]
        name = f"{end}_to_{own_end.partition('.')[0]}".replace(".", "_")
        joint = scope.join_ends(name, output.connection_kind, (end, own_end), properties)
        return Route(tuple(outward), scope, joint, tuple(reversed(inward)))

    def _cross(self, system: SystemPart, process: NodeProcess, part: PortPart, inner_end: str) -> tuple[str, str]:
        """Return the feature of a system for a port inside, and the connection inside that leads there."""
        shell_port = self._find_shell_port(system, part)
        place = (shell_port or process.node.id, part.text if shell_port else part.key)
        if place not in system.features:
            wanted = shell_port or inner_end.replace(".", "_")
            name = system.features[place] = system.names.take_name(wanted)
            properties = make_named_properties(name, wanted) if shell_port else []
            properties += make_text_properties(medium=part.port.medium if part.port.medium != "ros" else None)
            if part.is_call_data:
                properties = [make_property("archgen::Is_Call", "true")]
            system.feature_items.append(make_item(name, part.text, properties))
        name = system.features[place]
        ends = (inner_end, name) if part.is_output else (name, inner_end)
        return name, system.join_ends(f"{name}_link", part.connection_kind, ends, [])

    def _find_shell_port(self, system: SystemPart, part: PortPart) -> str | None:
        """Return the port of a composed component that passes a port inside on."""
        shell = system.element
        if not isinstance(shell, Component):
            return None
        return find_outer_port(self._architecture, shell, part)

    def lead_access(self, process: NodeProcess, feature: str, accessed: str, name: str) -> None:
        """Lead the access to something of the outermost system, `data access ros::tf`, by systems to a process' feature."""
        kind = accessed.rpartition(" ")[0]
        wanted_name = feature
        for system, inner in zip(process.home.path, process.home.path[1:], strict=False):
            if accessed not in inner.accesses:
                inner_name = inner.accesses[accessed] = inner.names.take_name(wanted_name)
                inner.feature_items.append(make_item(inner_name, f"requires {accessed}"))
                system.connect(f"{inner.name}_{inner_name}", f"{kind} {name} -> {inner.name}.{inner_name}", [])
            name = inner.accesses[accessed]
        end = f"{process.name_in_system}.{feature}"
        process.home.connect(end.replace(".", "_"), f"{kind} {name} -> {end}", [])
