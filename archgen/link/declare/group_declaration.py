"""Declare groups and components as model objects."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple, get_args

from archgen.link import mapping_values
from archgen.link.declare.parameter_declaration import declare_operations, declare_parameters
from archgen.link.declare.timing_declaration import declare_timing
from archgen.link.element_outline import ElementOutline
from archgen.link.input_wiring import InputWiring
from archgen.link.port_resolution import PortResolver
from archgen.link.reference_resolution import ReferenceResolver
from archgen.model.architecture import PortEdge
from archgen.model.component import Component, ComponentRole, Connection, Group, PerformanceIndicator, RequirementUse
from archgen.model.message_types import ConceptualType
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

_ROLES = frozenset(get_args(ComponentRole))


class DeclaredGroups(NamedTuple):
    """The high level: groups and components by complete id, and what connects the components' ports."""

    groups: dict[str, Group]
    components: dict[str, Component]
    connections: tuple[Connection, ...]
    edges: tuple[PortEdge, ...]


def declare_groups(
    outline: ElementOutline, resolver: ReferenceResolver, types: Mapping[str, ConceptualType]
) -> DeclaredGroups:
    """Declare every group with its components, and wire their inputs."""
    wiring = InputWiring(outline, resolver, types)
    group_declarer = _GroupDeclarer(outline, resolver, wiring)
    groups = {name: group_declarer.declare_group(name, entry) for name, entry in outline.groups.items()}
    components = {component.id: component for group in groups.values() for component in group.components.values()}
    return DeclaredGroups(groups, components, tuple(wiring.connections), tuple(wiring.edges))


@dataclass(frozen=True, slots=True)
class _GroupDeclarer:
    """What the declaration of a group needs."""

    outline: ElementOutline
    resolver: ReferenceResolver
    wiring: InputWiring

    def declare_group(self, group_id: str, entry: MappingEntry) -> Group:
        body = mapping_values.get_body(entry)
        # Owners are inherited: a component without owners has those of its group, a node those of its components.
        owners = self.resolver.resolve_owners(body, group_id, ())
        components = {
            part.key: self._declare_component(group_id, part, owners)
            for part in mapping_values.get_mapping(body, "components")
        }
        return Group(
            id=group_id,
            title=mapping_values.get_title(body, group_id),
            description=mapping_values.get_text(body, "description"),
            owner=next(iter(owners), None),
            co_owners=owners[1:],
            tags=mapping_values.get_texts(body, "tags"),
            urls=mapping_values.get_text_mapping(body, "urls"),
            layout=mapping_values.get_layout(body),
            components=components,
            at=entry.key_span,
        )

    def _declare_component(self, group_id: str, entry: MappingEntry, inherited_owners: tuple[str, ...]) -> Component:
        body, component_id = mapping_values.get_body(entry), f"{group_id}.{entry.key}"
        owners = self.resolver.resolve_owners(body, component_id, inherited_owners)
        inputs = self.outline.inputs[component_id]
        return Component(
            id=component_id,
            name=entry.key,
            group=group_id,
            title=mapping_values.get_title(body, entry.key),
            functionality=mapping_values.get_text(body, "functionality"),
            description=mapping_values.get_text(body, "description"),
            owner=next(iter(owners), None),
            co_owners=owners[1:],
            role=_read_role(body),
            requirements=tuple(_read_requirements(body)),
            requirements_known=body.get("requirements") is not None,
            performance=tuple(_read_performance(body)),
            inputs={name: self.wiring.declare_input(component_id, port) for name, port in inputs.items()},
            # Absent means not known yet, `{}` means known to be none: three of these flags keep the difference.
            inputs_known=body.get("inputs") is not None,
            outputs=self.outline.outputs[component_id],
            outputs_known=body.get("outputs") is not None,
            parameters=declare_parameters(body),
            open=mapping_values.get_texts(body, "open"),
            operations=declare_operations(body),
            timing=declare_timing(
                entry,
                PortResolver(self.resolver, component_id, (component_id,), self.outline.port_names),
                self.resolver.diagnostics,
            ),
            tags=mapping_values.get_texts(body, "tags"),
            urls=mapping_values.get_text_mapping(body, "urls"),
            layout=mapping_values.get_layout(body),
            at=entry.key_span,
            role_at=mapping_values.get_span(body, "role"),
        )


def _read_role(body: MappingNode) -> ComponentRole | None:
    role = mapping_values.get_text(body, "role")
    return role if role in _ROLES else None  # type: ignore[return-value]


def _read_requirements(body: MappingNode) -> Iterator[RequirementUse]:
    """Yield the entries of `requirements`: one that contains a blank is free text, any other is an id."""
    for scalar in mapping_values.get_scalars(body, "requirements"):
        text = scalar.text.strip()
        yield RequirementUse(text, not any(letter.isspace() for letter in text), scalar.span)


def _read_performance(body: MappingNode) -> Iterator[PerformanceIndicator]:
    for name, entry, indicator_body in mapping_values.iterate_elements(body, "performance"):
        yield PerformanceIndicator(
            id=name,
            title=mapping_values.get_title(indicator_body, name),
            accuracy=mapping_values.get_text(indicator_body, "accuracy"),
            execution_time=mapping_values.get_quantity(indicator_body, "execution_time", "duration"),
            at=entry.key_span,
        )
