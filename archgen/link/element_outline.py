"""List the groups, components and ports of the merged project, before any reference is resolved."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

from archgen.link import mapping_values
from archgen.model.component import Output
from archgen.syntax.yaml_tree import MappingEntry, MappingNode


@dataclass(slots=True)
class ElementOutline:
    """What the project declares on its high level. Inputs stay as written: what feeds them is not known yet."""

    groups: dict[str, MappingEntry] = field(default_factory=dict)
    components: dict[str, MappingEntry] = field(default_factory=dict)
    outputs: dict[str, dict[str, Output]] = field(default_factory=dict)
    """By component id and name."""
    inputs: dict[str, dict[str, MappingEntry]] = field(default_factory=dict)
    """By component id and name."""

    @property
    def port_names(self) -> Mapping[str, Mapping[str, Collection[str]]]:
        """The names of the ports by kind (`input`, `output`) and component id."""
        return {"input": self.inputs, "output": self.outputs}

    def list_outputs(self) -> Iterator[Output]:
        """Iterate over every output."""
        for outputs in self.outputs.values():
            yield from outputs.values()

    def list_used_types(self) -> Iterator[str]:
        """Yield the types that ports mention, with repetitions."""
        for component, outputs in self.outputs.items():
            for entry in self.inputs[component].values():
                type_text = mapping_values.get_text(mapping_values.get_body(entry), "type")
                if type_text:
                    yield mapping_values.normalise_type_name(type_text)
            yield from (output.type for output in outputs.values() if output.type)


def build_outline(root: MappingNode) -> ElementOutline:
    """Return the outline of a merged project, by complete ids."""
    element_outline = ElementOutline()
    for group_id, entry, body in mapping_values.iterate_elements(root, "groups"):
        element_outline.groups[group_id] = entry
        for name, component, component_body in mapping_values.iterate_elements(body, "components"):
            component_id = f"{group_id}.{name}"
            element_outline.components[component_id] = component
            element_outline.inputs[component_id] = {
                e.key: e for e in mapping_values.get_mapping(component_body, "inputs")
            }
            element_outline.outputs[component_id] = {
                e.key: _declare_output(component_id, e) for e in mapping_values.get_mapping(component_body, "outputs")
            }
    return element_outline


def _declare_output(component: str, entry: MappingEntry) -> Output:
    body = mapping_values.get_body(entry)
    type_text = mapping_values.get_text(body, "type")
    return Output(
        id=f"{component}.{entry.key}",
        name=entry.key,
        component=component,
        type=mapping_values.normalise_type_name(type_text) if type_text else None,
        external=mapping_values.get_text(body, "external"),
        physical=mapping_values.get_text(body, "medium") == "physical",
        frame=mapping_values.get_text(body, "frame"),
        description=mapping_values.get_text(body, "description"),
        at=entry.key_span,
        type_at=mapping_values.get_span(body, "type"),
        frame_at=mapping_values.get_span(body, "frame"),
    )
