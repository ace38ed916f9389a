"""Declare groups and components as model objects, and component types with their ports and settings."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, TypeVar

from archgen.compose import ExpandedProject
from archgen.compose.expanded_project import ComponentShell
from archgen.compose.library_types import library_of_type
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.link import mapping_values
from archgen.link.declare.handed_parameters import HandedParameters, declare_parameters
from archgen.link.declare.promise_declaration import PromisedOutputs
from archgen.link.declare.timing_declaration import declare_timing
from archgen.link.element_outline import ElementOutline
from archgen.link.input_wiring import InputWiring
from archgen.link.link_memory import LinkedLeaf, LinkMemory
from archgen.link.port_resolution import PortResolver
from archgen.link.promise_reading import read_deprecation
from archgen.link.reference_resolution import ReferenceResolver
from archgen.link.value_readers import read_element, read_operations, read_values
from archgen.model.architecture import PortEdge, list_leaf_ports
from archgen.model.component import Component, ComponentType, Connection, Group, Input, Output
from archgen.model.coordinate_frames import Frame
from archgen.model.message_types import ConceptualType
from archgen.model.path_resolver import title_from_id
from archgen.model.promise import Deprecation
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

if TYPE_CHECKING:
    from archgen.link.port_sources import OpenShells


def declare_component_types(expansion: ExpandedProject, resolver: ReferenceResolver) -> dict[str, ComponentType]:
    """Return the component types of a project, by id. Owners of its own types that are no partners are reported.

    Whose a library's types are, those know who check the library by itself.
    """
    types: dict[str, ComponentType] = {}
    if not expansion.type_entries:
        return types
    from archgen.compose.type_table import is_abstract, list_generic_names

    for name, entry in expansion.type_entries.items():
        body, whole_body = mapping_values.get_body(entry), expansion.type_bodies[name]
        library = library_of_type(name)
        if library is None:
            resolver.resolve_owners(body, name, ())
        values = read_values("component_type", ComponentType, whole_body)
        # What a type does not inherit.
        values["title"] = mapping_values.get_title(body, name.rpartition(".")[2])
        values["version"] = mapping_values.get_text(body, "version")
        types[name] = ComponentType(
            **values,
            id=name,
            owner=mapping_values.get_text(body, "owner"),
            base=mapping_values.get_text(body, "is"),
            library=library,
            generic=list_generic_names(entry),
            is_abstract=is_abstract(entry),
            deprecated=_name_replacement(read_deprecation(body, name, resolver.diagnostics), expansion),
            inputs=_read_port_types(whole_body, "inputs"),
            outputs=_read_port_types(whole_body, "outputs"),
            components=tuple(mapping_values.get_mapping(whole_body, "components").entries),
            parameters=declare_parameters(whole_body),
            frames=tuple(_read_frames(whole_body)),
            inner_types=frozenset(_list_inner_types(whole_body)),
            at=entry.key_span,
        )
    return types


def _name_replacement(deprecation: Deprecation | None, expansion: ExpandedProject) -> Deprecation | None:
    """Return a deprecation with the type that replaces it, if there is one; what is not there was reported."""
    if deprecation is None or deprecation.use not in expansion.type_entries:
        return deprecation
    return replace(deprecation, target=deprecation.use)


def _read_port_types(body: MappingNode, side: str) -> dict[str, str | None]:
    """Return the types of ports by id; those of outputs that are passed on are not known here."""
    return {
        name: mapping_values.normalise_type_name(text) if (text := mapping_values.get_text(port, "type")) else None
        for name, _, port in mapping_values.iterate_elements(body, side)
    }


def _list_inner_types(body: MappingNode) -> Iterator[str]:
    """Yield the types that components inside name as they are written: instances of them are in no group."""
    for _, _, part in mapping_values.iterate_elements(body, "components"):
        for side in ("inputs", "outputs"):
            yield from filter(None, _read_port_types(part, side).values())
        for operation in read_operations(part, "operations").values():
            yield from operation.type_names
        for key in ("is", "same_as"):
            expression = mapping_values.get_text(part, key) or ""
            if "<" in expression:  # what generic names stand for
                yield mapping_values.normalise_type_name(expression)
        yield from _list_inner_types(part)


def _read_frames(body: MappingNode) -> Iterator[Frame]:
    """Yield the frames as they are written: what their names stand for, and who writes them, each instance says."""
    for _, entry, frame in mapping_values.iterate_elements(body, "frames"):
        rate = mapping_values.get_quantity(frame, "rate", "frequency")
        yield Frame(**read_element("frame", Frame, entry, frame), rate=rate)


_Port = TypeVar("_Port", Input, Output)


class DeclaredGroups(NamedTuple):
    """The high level: groups and components by complete id, and what connects the components' ports."""

    groups: dict[str, Group]
    components: dict[str, Component]
    shells: dict[str, Component]
    shell_ports: dict[str, tuple[str, ...]]
    connections: tuple[Connection, ...]
    edges: tuple[PortEdge, ...]

    def list_leaves(self, component_id: str) -> tuple[str, ...]:
        """Return the leaves inside of a composed component, or the component itself, by complete ids."""
        shell = self.shells.get(component_id)
        own = (component_id,) if component_id in self.components else ()
        return (*own, *(leaf for child in shell.children for leaf in self.list_leaves(child))) if shell else own

    def list_leaf_ports(self, kind: str, port_id: str) -> tuple[str, ...]:
        """Return the ports of leaves that carry a port: itself, or those behind that of a composed component."""
        return tuple(list_leaf_ports(self.shells, self.shell_ports, kind, port_id)) or (port_id,)


def declare_groups(
    outline: ElementOutline,
    resolver: ReferenceResolver,
    types: Mapping[str, ConceptualType],
    parameters: HandedParameters,
    memory: LinkMemory | None = None,
) -> DeclaredGroups:
    """Declare every group with its components, and wire their inputs.

    Components that `memory` knows are taken over; it is for projects in which no component holds others.
    """
    sources = open_shells = None
    if outline.expansion:
        # Imported here: in most projects no component holds others.
        from archgen.link.automatic_connections import join_ports
        from archgen.link.port_sources import OpenShells, PortSources

        sources = PortSources(outline, resolver, types)
        join_ports(outline, sources, resolver)
        sources.spread_media()
        open_shells = OpenShells(outline, sources)
    wiring = InputWiring(outline, resolver, types, sources)
    group_declarer = _GroupDeclarer(
        outline,
        resolver,
        wiring,
        parameters,
        promised_outputs=PromisedOutputs(outline, sources, parameters, resolver),
        outside_readers=sources.list_given_outside() if sources else {},
        memory=None if sources else memory,
    )
    groups = {name: group_declarer.declare_group(name, entry, open_shells) for name, entry in outline.groups.items()}
    components = {component.id: component for group in groups.values() for component in group.components.values()}
    shells = {shell.id: group_declarer.declare_shell(shell) for shell in outline.shells.values()}
    return DeclaredGroups(
        groups,
        components,
        shells,
        open_shells.list_carried_ports() if open_shells else {},
        tuple(wiring.connections),
        tuple(wiring.edges),
    )


@dataclass(frozen=True, slots=True)
class _GroupDeclarer:
    """What the declaration of a group needs."""

    outline: ElementOutline
    resolver: ReferenceResolver
    wiring: InputWiring
    parameters: HandedParameters
    promised_outputs: PromisedOutputs
    owners: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """The owners of groups and composed components, by complete id."""
    outside_readers: Mapping[str, MappingNode] = field(default_factory=dict)
    """The outputs of composed components that go outside of the system, by the leaf's output that they pass on."""
    memory: LinkMemory | None = None

    def declare_group(self, group_id: str, entry: MappingEntry, open_shells: OpenShells | None) -> Group:
        body = mapping_values.get_body(entry)
        # Owners are inherited: a component without owners has those of its group, a node those of its components.
        owners = self.resolver.resolve_owners(body, group_id, ())
        self.owners[group_id] = owners
        components = {
            part.key: self._declare_leaf(group_id, part) for part in mapping_values.get_mapping(body, "components")
        }
        if open_shells:
            for shell in open_shells.list_in_group(group_id):
                path = shell.id.removeprefix(f"{group_id}.")
                components[path] = self._declare_rest(shell, open_shells)
        return Group(
            **read_element("group", Group, entry, body),
            owner=next(iter(owners), None),
            co_owners=owners[1:],
            components=components,
        )

    def declare_shell(self, shell: ComponentShell) -> Component:
        """Declare a composed component, with all of its ports."""
        inputs = {
            name: self.wiring.declare_input(shell.id, port, is_leaf=False)
            for name, port in self.outline.inputs[shell.id].items()
        }
        outputs = {name: self._follow_output(output) for name, output in self.outline.outputs[shell.id].items()}
        return replace(
            self._declare_component(shell.group, shell.entry, inputs, outputs),
            children=tuple(child for child in shell.children if child in self.resolver.spans["component"]),
        )

    def _follow_output(self, output: Output) -> Output:
        """Return an output of a composed component with what follows from what it passes on."""
        sources = self.wiring.sources
        if sources is None:
            return output
        given = sources.list_sources(("output", output.id))
        is_made = bool(given) and all(source.is_made for source in given)
        return replace(output, type=sources.type_of_output(output.id), is_made=is_made)

    def _declare_leaf(self, group_id: str, entry: MappingEntry) -> Component:
        if self.memory is None:
            return self._declare_written(group_id, entry)
        component_id, resolver, wiring = f"{group_id}.{entry.key}", self.resolver, self.wiring
        outputs = self.outline.outputs[component_id]
        for known in self.memory.leaves.list_known(component_id):
            if (
                known.entry is entry
                and known.outputs is outputs
                and known.group_owners == self.owners[group_id]
                and (known.names is resolver.all_names or resolver.gives_answers(known.answers, known.names))
                and wiring.brings_same(known.component)
                and known.source_media == wiring.list_source_media(known.component)
                and resolver.tell_again(known.references)
            ):
                wiring.take_over(known.component)
                self.owners[component_id] = known.component.owners
                return known.component
        with resolver.listen() as heard:
            component = self._declare_written(group_id, entry)
        # The outputs are those of another version only where nothing else is said of them: see `_recall_ports`.
        if heard.is_flawless:
            media, owners = wiring.list_source_media(component), self.owners[group_id]
            linked = LinkedLeaf(
                entry, outputs, owners, media, resolver.all_names, tuple(heard.answers), component, heard.references
            )
            self.memory.leaves.keep_part(component_id, linked)
        return component

    def _declare_written(self, group_id: str, entry: MappingEntry) -> Component:
        component_id = f"{group_id}.{entry.key}"
        inputs = self.outline.inputs[component_id]
        return self._declare_component(
            group_id,
            entry,
            {name: self.wiring.declare_input(component_id, port) for name, port in inputs.items()},
            {name: self._add_outside(output) for name, output in self.outline.outputs[component_id].items()},
        )

    def _add_outside(self, output: Output) -> Output:
        """Return an output with the reader outside of the system that a composed component passes it on to."""
        body = self.outside_readers.get(output.id)
        return (
            replace(output, external=mapping_values.get_text(body, "external"))
            if body and not output.external
            else output
        )

    def _declare_rest(self, shell: ComponentShell, open_shells: OpenShells) -> Component:
        """Declare what is not designed yet of a composed component: the ports that nothing inside carries."""
        inputs = {
            name: self.wiring.declare_input(shell.id, port)
            for name, port in self.outline.inputs[shell.id].items()
            if open_shells.is_open(("input", f"{shell.id}.{name}"))
        }
        outputs = {
            name: output
            for name, output in self.outline.outputs[shell.id].items()
            if open_shells.is_open(("output", output.id))
        }
        component = self._declare_component(shell.group, shell.entry, inputs, outputs)
        return replace(component, requirements=(), requirements_known=True, performance=(), timing=None)

    def _fill_in_frame(self, port: _Port) -> _Port:
        """Return a port whose frame is named by parameters of its component: `$(self.prefix)base_link`."""
        if port.frame is None or "$" not in port.frame:
            return port
        return replace(port, frame=self.parameters.fill_in_name(port.frame, port.component, port.frame_at))

    def _find_owners(self, component_id: str, group_id: str, entry: MappingEntry) -> tuple[str, ...]:
        """Return a component's owners: those written, else those of the component around it, else of its group."""
        if component_id not in self.owners:
            parent_id = self.outline.expansion.parents.get(component_id) if self.outline.expansion else None
            parent = self.outline.shells[parent_id] if parent_id else None
            inherited_owners = self._find_owners(parent.id, group_id, parent.entry) if parent else self.owners[group_id]
            body = mapping_values.get_body(entry)
            self.owners[component_id] = self.resolver.resolve_owners(body, component_id, inherited_owners)
        return self.owners[component_id]

    def _declare_component(
        self, group_id: str, entry: MappingEntry, inputs: Mapping[str, Input], outputs: Mapping[str, Output]
    ) -> Component:
        body, component_id = mapping_values.get_body(entry), f"{group_id}.{entry.key}"
        name = entry.key.rpartition(".")[2]
        owners = self._find_owners(component_id, group_id, entry)
        expansion = self.outline.expansion
        origin = expansion.instances.get(component_id) if expansion else None
        values = {"title": title_from_id(name), **read_values("component", Component, body)}
        return Component(
            **values,
            id=component_id,
            name=name,
            group=group_id,
            parent=expansion.parents.get(component_id) if expansion else None,
            component_type=str(origin.expression) if origin else None,
            is_reference=origin.is_reference if origin else False,
            owner=next(iter(owners), None),
            co_owners=owners[1:],
            requirements_known=body.get("requirements") is not None,
            inputs={port_name: self._fill_in_frame(port) for port_name, port in inputs.items()},
            # Absent means not known yet, `{}` means known to be none: three of these flags keep the difference.
            inputs_known=body.get("inputs") is not None,
            outputs={
                port_name: self.promised_outputs.complete_output(self._fill_in_frame(port))
                for port_name, port in outputs.items()
            },
            outputs_known=body.get("outputs") is not None,
            parameters=self.parameters.find_parameters(component_id),
            timing=declare_timing(
                entry,
                PortResolver(self.resolver, component_id, (component_id,), self.outline.port_names),
                self.resolver.diagnostics,
            ),
            at=entry.key_span,
        )
