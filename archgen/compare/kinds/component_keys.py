"""How the keys of components, of their ports and of their types are read for comparing."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.kinds.key_spec import ReadContext
from archgen.compare.normal_values import ElementTitle, freeze_value, normalize_text, normalize_title
from archgen.compare.version_pair import SOME_PORTS
from archgen.frozen import replace
from archgen.model.component import Component, ComponentType, Input, Output, PerformanceIndicator
from archgen.model.declared_timing import Timing
from archgen.model.generic_names import read_generic_name
from archgen.model.message_types import ConceptualType
from archgen.model.parameter import format_parameter
from archgen.model.path_resolver import title_from_id
from archgen.model.promise import Deprecation, Promise, format_range


def read_name_as_title(component: Component, _context: ReadContext) -> ElementTitle:
    """Return the title of a component, which is generated from the last part of its id."""
    return normalize_title(component.name, component.title)


def read_requirements(component: Component, context: ReadContext) -> frozenset[str]:
    """Return the requirements that a component serves: ids, and what it writes in words."""
    return context.common_ids("requirement", [use.text for use in component.requirements])


def read_inputs(component: Component, _context: ReadContext) -> str | None:
    """Return whether there are inputs: these are elements of their own."""
    return _describe_ports(component.inputs, is_known=component.inputs_known)


def read_outputs(component: Component, _context: ReadContext) -> str | None:
    """Return whether there are outputs: these are elements of their own."""
    return _describe_ports(component.outputs, is_known=component.outputs_known)


def _describe_ports(ports: Mapping[str, object], *, is_known: bool) -> str | None:
    return SOME_PORTS if ports else "none" if is_known else None


def read_medium(port: Input | Output, _context: ReadContext) -> str | None:
    """Return the medium that a port says itself."""
    return port.medium if port.medium_written else None


def find_indicators(component: Component, _context: ReadContext) -> Mapping[str, PerformanceIndicator]:
    """Return the indicators of performance, each by what stands before its keys."""
    return {f"{indicator.id}.": indicator for indicator in component.performance}


def find_node_timing(component: Component, context: ReadContext) -> Timing | None:
    """Return a component's timing: that of its node if it has exactly one, else what it says itself."""
    component_nodes = context.nodes_by_component.get(component.id, [])
    has_one_node = (
        len(component_nodes) == 1
        and context.matched_ids.common_id("component", component.id) not in context.split_components
    )
    return component_nodes[0].timing.get(component.id) if has_one_node else component.timing


def read_parameters(component: Component, _context: ReadContext) -> Mapping[str, object]:
    """Return the declared parameters: each value by the parameter's name, what else is declared by `name:key`."""
    values: dict[str, object] = {}
    for name, parameter in component.parameters.items():
        # Without a value there is a parameter all the same.
        values[name] = _freeze_parameter(parameter.value)
        facets = {
            "type": parameter.type,
            "unit": parameter.unit,
            "range": parameter.range and " to ".join(map(format_parameter, parameter.range)),
            "choices": parameter.choices and ", ".join(map(format_parameter, parameter.choices)),
            "description": normalize_text(parameter.description),
            "read_only": parameter.read_only or None,
            "visibility": parameter.visibility,
            "from": parameter.handed_from,
            "hints": format_parameter(parameter.hints) if parameter.hints else None,
        }
        values |= {f"{name}:{key}": freeze_value(value) for key, value in facets.items() if value is not None}
    return values


def _freeze_parameter(value: object) -> object:
    """Return a value for comparing; a list as a whole, since sentences would tell its items apart."""
    if value is None:
        return "no value"
    return format_parameter(value) if isinstance(value, list) else freeze_value(value)


def read_operations(component: Component, _context: ReadContext) -> Mapping[str, object]:
    """Return the operations: whether there is one by its id, what is said of it by `id:key`."""
    values: dict[str, object] = {}
    for name, operation in component.operations.items():
        values[name] = "there"
        facets = {
            "title": None if operation.title in {title_from_id(name), name} else operation.title,
            "request": operation.request,
            "response": operation.response,
            "call": operation.call,
            "visibility": operation.visibility,
            "description": normalize_text(operation.description),
        }
        values |= {f"{name}:{key}": _describe_types(value) for key, value in facets.items() if value is not None}
    return values


def _describe_types(value: str | Mapping[str, str]) -> str:
    return value if isinstance(value, str) else ", ".join(f"{name}: {type_name}" for name, type_name in value.items())


def is_mapped(component: Component, context: ReadContext) -> bool | None:
    """Whether a node that is written implements a component; None where none does."""
    return any(node.written for node in context.nodes_by_component.get(component.id, ())) or None


def name_common_type(type_text: str | None, context: ReadContext) -> str | None:
    """Return the name of a component type with common ids in it, `lib.filter<Pose>`; None for none."""
    return None if type_text is None else _name_with_common_ids(type_text.strip(), "component_type", context)


def _name_with_common_ids(text: str, kind: str, context: ReadContext) -> str:
    name, arguments = read_generic_name(text)
    bound_names = ", ".join(_name_with_common_ids(each, "type", context) for each in arguments)
    return f"{context.common_id(kind, name)}<{bound_names}>" if arguments else str(context.common_id(kind, name))


def read_component_type(component: Component, context: ReadContext) -> str | None:
    """Return the component type that a component is made from; one that is exactly it says so."""
    type_name = name_common_type(component.component_type, context)
    return f"exactly {type_name}" if component.is_reference else type_name


def read_base(component_type: ComponentType, context: ReadContext) -> str | None:
    """Return the component type that a component type is made from."""
    return name_common_type(component_type.base, context)


NO_DAY = "no day"
"""What is compared where something is deprecated and nobody has said until when."""


def read_range(promise: Promise, _context: ReadContext) -> str | None:
    """Return the promised least and greatest value."""
    return format_range(promise.range) if promise.range else None


def find_output_deprecation(output: Output, context: ReadContext) -> Deprecation | None:
    """Return until when an output is there, and what replaces it."""
    found = _find_deprecation(output.deprecated, "output", context)
    if found is None or found.use is None or not found.target or found.target.rpartition(".")[0] != output.component:
        return found
    # As people write it: instances of a type say the same of their own outputs.
    return replace(found, use=found.use.rpartition(".")[2])


def find_type_deprecation(conceptual_type: ConceptualType, context: ReadContext) -> Deprecation | None:
    """Return until when a type is there, and what replaces it."""
    return _find_deprecation(conceptual_type.deprecated, "type", context)


def find_component_type_deprecation(component_type: ComponentType, context: ReadContext) -> Deprecation | None:
    """Return until when a component type is there, and what replaces it."""
    return _find_deprecation(component_type.deprecated, "component_type", context)


def _find_deprecation(written: Deprecation | None, kind: str, context: ReadContext) -> Deprecation | None:
    if written is None:
        return None
    use = context.common_id(kind, written.target) if written.target else written.use
    return replace(written, until=written.until or NO_DAY, use=use)
