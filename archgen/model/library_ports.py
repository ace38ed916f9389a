"""What the ports of a library's component types mean: they are offered to several projects, none of which uses them all."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Output
from archgen.model.message_types import flow_of


def is_offered_by_library(architecture: Architecture, output: Output) -> bool:
    """Whether a component type of a library has an output: what the project adds to a type is the project's."""
    component = architecture.components[output.component]
    component_type = architecture.component_types.get((component.component_type or "").partition("<")[0])
    seen_types: set[str] = set()
    # Types that are made from themselves are reported elsewhere.
    while component_type is not None and component_type.library is None and component_type.id not in seen_types:
        seen_types.add(component_type.id)
        component_type = architecture.component_types.get((component_type.base or "").partition("<")[0])
    return component_type is not None and component_type.library is not None and output.name in component_type.outputs


def waits_for_calls(architecture: Architecture, component: Component) -> bool:
    """Whether a component of a library's type has services and actions only, which people and tools may call."""
    flows = {
        "physical" if each.physical else flow_of(architecture.message_of(each)) for each in component.outputs.values()
    }
    return not component.inputs and flows <= {"service", "action"} and any(architecture.list_libraries_of(component))
