"""What the ports of a library's component types mean: they are offered to several projects, none of which uses them all."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.component import Component, Output
from archgen.model.port_media import is_physical


def is_offered_by_library(architecture: Architecture, output: Output) -> bool:
    """Whether a component type of a library has an output: what the project adds to a type is the project's."""
    component = architecture.components[output.component]
    bases = architecture.list_bases(component.type_name)
    library_type = next((each for each in bases if each.library is not None), None)
    return library_type is not None and output.name in library_type.outputs


def waits_for_calls(architecture: Architecture, component: Component) -> bool:
    """Whether a component of a library's type has services and actions only, which people and tools may call."""
    flows = {"physical" if is_physical(each) else architecture.flow_of(each) for each in component.outputs.values()}
    return not component.inputs and flows <= {"service", "action"} and any(architecture.list_libraries_of(component))
