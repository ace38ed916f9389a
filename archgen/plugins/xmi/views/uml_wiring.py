"""Connections as interfaces that ports realize and use, and as connectors inside of composed components."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from archgen.plugin.generating import make_camel_name
from archgen.plugin.model import Architecture, Connection, Input
from archgen.plugins.xmi.views.uml_components import PortPath, UmlComponents, name_output_interface
from archgen.plugins.xmi.views.uml_types import (
    TYPE_PREFIX,
    IdRegistry,
    UmlTree,
    UmlTypes,
    list_names,
    make_tree,
    read_hints,
    read_mapping,
)


class UmlWiring:
    """Writes interfaces with who realizes and uses them, and the connectors of what stands inside."""

    def __init__(
        self, architecture: Architecture, registry: IdRegistry, types: UmlTypes, components: UmlComponents
    ) -> None:
        self._architecture, self._registry, self._types = architecture, registry, types
        self._components = components
        self._interfaces: dict[PortPath, str] = {}
        self.relations: list[UmlTree] = []
        self.connectors: dict[str, list[UmlTree]] = {}
        """The connectors of composed components and types, by path."""

    def write_outputs(self) -> None:
        """Write an interface for each output of a component. Those of component types need none."""
        for (path, name), hints in self._components.outputs.items():
            if (path, name) in self._components.port_ids and not _is_type(path):
                for number, each in enumerate(list_names(read_hints(hints), "interface") or [""]):
                    self._write_interface((path, name), each, is_first=number == 0)

    def _write_interface(self, port: PortPath, name: str, *, is_first: bool) -> None:
        path = ".".join(port)
        interface_id = self._registry.claim(f"{'interface' if name else 'made_interface'}.{path}")
        interface = make_tree("packagedElement", "Interface", interface_id, name or name_output_interface(*port))
        operation_id = self._registry.claim(f"getter.{path}")
        operation = make_tree("ownedOperation", "Operation", operation_id, f"get{make_camel_name(port[1])}")
        shell = self._architecture.shells.get(port[0])
        output = self._architecture.outputs.get(path) or (shell.outputs.get(port[1]) if shell else None)
        if output is not None and output.type:
            answer_id = self._registry.claim(f"argument.{operation_id}.return")
            answer_type = self._types.refer(output.type)
            answer = make_tree("ownedParameter", "Parameter", answer_id, "return", type=answer_type, direction="return")
            operation["children"].append(answer)
        interface["children"].append(operation)
        realization_id = self._registry.claim(f"realizes.{path}")
        port_id = self._components.port_ids[port]
        realization = make_tree("packagedElement", "Realization", realization_id, client=port_id, supplier=interface_id)
        self.relations += [interface, realization]
        if is_first:
            self._interfaces[port] = interface_id

    def write_inputs(self, bodies: Mapping[str, Any]) -> None:
        """Write what each input reads. `bodies` are the packed component types, for references inside of them."""
        samples = self._components.samples
        for (path, name), hints in self._components.inputs.items():
            if (path, name) not in self._components.port_ids:
                continue
            place = path
            if _is_type(path):
                type_name, inner = _split_type(path, bodies)
                place = f"{samples[type_name]}.{inner}" if inner and type_name in samples else ""
            reader = self._architecture.inputs.get(f"{place}.{name}") or self._find_shell_input(place, name)
            sources = (
                list(dict.fromkeys(s for each in reader.connections for s in _list_sources(each))) if reader else []
            )
            self._connect((path, name), place, sources, hints)

    def _find_shell_input(self, place: str, name: str) -> Input | None:
        shell = self._architecture.shells.get(place)
        return shell.inputs.get(name) if shell else None

    def _connect(self, port: PortPath, place: str, sources: list[str], hints: object) -> None:
        path = port[0]
        owner, owner_place = path.rpartition(".")[0], place.rpartition(".")[0]
        is_joined = False
        for source in sources:
            component, _, output = source.rpartition(".")
            if owner_place and component == owner_place and (owner, output) in self._components.port_ids:
                self._join(owner, (owner, output), port)
                is_joined = True
            elif component.rpartition(".")[0] == owner_place and "." in owner and owner_place:
                sibling = (f"{owner}.{component.rpartition('.')[2]}", output)
                if sibling in self._components.port_ids:
                    self._join(owner, sibling, port)
                    is_joined = True
            elif not _is_type(path) and (interface := self._interfaces.get((component, output))):
                self._use(port, interface)
                is_joined = True
        if _is_type(path) and not is_joined:
            # No instance shows what is read there, or its own input reads nothing.
            for written in _read_references(owner, self._components.written_sources.get(port), around=owner):
                if written in self._components.port_ids:
                    self._join(owner, written, port)
                    is_joined = True
        if not is_joined:
            self._leave_open(port, hints)

    def _join(self, owner: str, first: PortPath, second: PortPath) -> None:
        """Write a connector between two ports inside of a composed component, or one of them its own."""
        connector_id = self._registry.claim(f"connector.{'.'.join(second)}")
        ends = [
            make_tree("end", "ConnectorEnd", f"{connector_id}.end{number}", role=self._components.port_ids[port])
            for number, port in enumerate((first, second), 1)
        ]
        connector = make_tree("ownedConnector", "Connector", connector_id, "", ends)
        self.connectors.setdefault(owner, []).append(connector)
        # A connector says which way the data goes only where one of its ends does.
        if second in self._components.inputs:
            self._leave_open(second, None)

    def _use(self, port: PortPath, interface_id: str) -> None:
        usage_id = self._registry.claim(f"usage.{'.'.join(port)}")
        client = self._components.port_ids[port]
        usage = make_tree("packagedElement", "Usage", usage_id, client=client, supplier=interface_id)
        self.relations.append(usage)

    def _leave_open(self, port: PortPath, hints: object) -> None:
        """Let an input use an interface that nobody realizes: else it would be taken for an output."""
        kept = read_hints(hints).get("interface")
        path = ".".join(port)
        interface_id = self._registry.claim(f"{'interface' if kept else 'made_interface'}.needed.{path}")
        name = kept if isinstance(kept, str) and kept else name_output_interface(*port)
        self.relations.append(make_tree("packagedElement", "Interface", interface_id, name))
        self._use(port, interface_id)

    def write_delegations(self, composed: Iterator[tuple[str, Mapping[str, Any]]]) -> None:
        """Write what outputs of composed components pass on. `composed` are these with their paths."""
        for path, body in composed:
            place = self._components.samples.get(path.removeprefix(TYPE_PREFIX), "") if _is_type(path) else path
            for name, port in read_mapping(body.get("outputs")).items():
                given = self._architecture.shell_ports.get(f"output {place}.{name}", ()) if place else ()
                inner = [(_move_path(each, place, path), each.rpartition(".")[2]) for each in given]
                for each in inner or _read_references(path, read_mapping(port).get("from")):
                    if each in self._components.port_ids and (path, name) in self._components.port_ids:
                        self._join(path, (path, name), each)


def _move_path(output: str, place: str, path: str) -> str:
    """Return the path of an output's component inside of a type, for that inside of an instance."""
    component = output.rpartition(".")[0]
    return f"{path}.{component.rpartition('.')[2]}" if component.rpartition(".")[0] == place else ""


def _read_references(path: str, written: object, around: str = "") -> list[PortPath]:
    """Return the ports inside of a component that references name by their last two words; `self.x` is one of `around`."""
    references = [written] if isinstance(written, str) else written if isinstance(written, list) else []
    words = [str(each).split(".") for each in references]
    return [
        (around if each[-2] == "self" and around else f"{path}.{each[-2]}", each[-1]) for each in words if len(each) > 1
    ]


def _is_type(path: str) -> bool:
    return path.startswith(TYPE_PREFIX)


def _split_type(path: str, bodies: Mapping[str, Any]) -> tuple[str, str]:
    """Return the component type of a path in it, and the path inside."""
    words = path.removeprefix(TYPE_PREFIX).split(".")
    for length in (2, 1):
        name = ".".join(words[:length])
        if name in bodies:
            return name, ".".join(words[length:])
    return "", ""


def _list_sources(connection: Connection) -> tuple[str, ...]:
    """Return the ports that a connection reads, by complete ids: those of composed components where they are written."""
    if connection.shell_port is not None and connection.shell_port.count(".") > 1:
        return (connection.shell_port,)
    return (connection.target,) if connection.kind == "output" else connection.outputs
