"""The view `components`: what each component is made of, as data: its ports with what they read, its values, where it runs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics import Span
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.code_names import make_camel_name
from archgen.model.component import Component, Input, Output
from archgen.model.node import Node
from archgen.model.parameter import Parameter
from archgen.model.parameter_values import canonical_name, find_effective_parameters
from archgen.model.port_media import word_of_medium
from archgen.model.ros_distro import is_ros_1
from archgen.views.generation.generation_context import GeneratedView, GenerationContext, write_place
from archgen.views.records.record_sources import to_plain


@dataclass(frozen=True, slots=True)
class SetParameter:
    """A parameter of a component with the value that counts, as its node has it; None while nobody gives one.

    `path` is the names of its sets and its own name.
    """

    path: tuple[str, ...]
    value: object
    declaration: Parameter | None
    at: Span


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the components that hold no others, in their order, and the word for the project's middleware."""
    architecture = context.architecture
    data = {
        "project": {"id": architecture.project.id, "title": architecture.project.title},
        "middleware": architecture.project.middleware,
        "components": [
            _record_component(context, architecture.components[component_id])
            for component_id in context.wanted_components
        ],
    }
    return GeneratedView(data)


def list_set_parameters(architecture: Architecture, component: Component, node: Node | None) -> Iterator[SetParameter]:
    """Yield what a component declares, with the values of its node, and what only its node and its files give."""
    ros_1 = is_ros_1(architecture.distro)
    effective = find_effective_parameters(architecture, node) if node else {}
    declared_names = set[str]()
    for written_name, parameter in component.parameters.items():
        name = canonical_name(written_name, ros_1=ros_1)
        declared_names.add(name)
        given = effective.get(name)
        # Components of one node may declare the same name: the node's value counts, and else each has its own.
        is_given = given is not None and given.origin not in {"component", "none"}
        value, span = (given.value, given.at) if given and is_given else (parameter.value, parameter.value_at)
        yield from _list_leaves(tuple(name.split(".")), value, parameter, span)
    if node and len(node.implements) == 1:
        for name, given in effective.items():
            if name not in declared_names and given.origin in {"file", "node", "command"}:
                yield from _list_leaves(tuple(name.split(".")), given.value, None, given.at)


def _list_leaves(
    path: tuple[str, ...], value: object, declaration: Parameter | None, span: Span
) -> Iterator[SetParameter]:
    if isinstance(value, Mapping) and value:
        for key, item in value.items():
            yield from _list_leaves((*path, str(key)), item, None, span)
    else:
        yield SetParameter(path, value, declaration, span)


def read_own_hints(hints: Mapping[str, object], backend: str) -> Mapping[str, object]:
    """Return what the hints of an element say to a backend; nothing where that is no mapping."""
    own_hints = hints.get(backend)
    return own_hints if isinstance(own_hints, Mapping) else {}


def name_tag(hints: Mapping[str, object], backend: str, name: str) -> str:
    """Return the tag that the hints of an element have for a backend; without one its name in words: `LeftArm`."""
    tag = read_own_hints(hints, backend).get("tag")
    return tag if isinstance(tag, str) and tag else make_camel_name(name)


def name_program_tag(component: Component, backend: str) -> str:
    """Return the tag of the program that a component is: all instances of a component type have the same."""
    program = component.type_name.rpartition(".")[2] or component.name
    return name_tag(component.annotations.hints, backend, program)


def _record_component(context: GenerationContext, component: Component) -> dict[str, object]:
    architecture, backend = context.architecture, context.backend
    node = context.nodes_by_component.get(component.id)
    return {
        "id": component.id,
        "name": component.name,
        "tag": name_program_tag(component, backend),
        "group": component.group,
        "title": component.title,
        "place": write_place(component.at),
        "type": component.component_type,
        "is_reference": component.is_reference,
        "functionality": component.functionality,
        "role": component.role,
        "status": component.status,
        "owners": list(component.owners),
        "node": node.id if node else None,
        "host": node.host if node else None,
        "package": node.package if node else None,
        "executable": node.executable if node else None,
        "inputs": [_record_input(context, port) for port in component.inputs.values()],
        "outputs": [_record_output(context, port) for port in component.outputs.values()],
        "parameters": [_record_parameter(each, backend) for each in list_set_parameters(architecture, component, node)],
        "hints": to_plain(read_own_hints(component.annotations.hints, backend)),
    }


def _record_port(context: GenerationContext, port: Input | Output, component: Component) -> dict[str, object]:
    hints = port.annotations.hints
    return {
        "id": port.id,
        "name": port.name,
        "tag": name_tag(hints, context.backend, port.name),
        "component": component.name,
        "place": write_place(port.at),
        "type": port.type,
        "medium": word_of_medium(port),
        "external": port.external,
        "hints": to_plain(read_own_hints(hints, context.backend)),
    }


def _record_input(context: GenerationContext, port: Input) -> dict[str, object]:
    component = context.architecture.components[port.component]
    outputs = dict.fromkeys(output for each in port.connections for output in each.outputs)
    sources = [_record_source(context, context.architecture.outputs[output]) for output in outputs]
    return {**_record_port(context, port, component), "optional": port.optional, "sources": sources}


def _record_output(context: GenerationContext, port: Output) -> dict[str, object]:
    message = context.architecture.message_of(port)
    return {**_record_port(context, port, context.architecture.components[port.component]), "message": message}


def _record_source(context: GenerationContext, port: Output) -> dict[str, object]:
    """Return an output that is read, with the host of its component; it need not be one that is generated for."""
    node = context.nodes_by_component.get(port.component)
    return {**_record_output(context, port), "host": node.host if node else None}


def _record_parameter(parameter: SetParameter, backend: str) -> dict[str, object]:
    declaration = parameter.declaration
    return {
        "name": ".".join(parameter.path),
        "path": list(parameter.path),
        "tags": list_parameter_tags(parameter, backend),
        "value": to_plain(parameter.value),
        "type": declaration.type if declaration else None,
        "unit": declaration.unit if declaration else None,
        "description": declaration.description if declaration else None,
        "place": write_place(parameter.at),
    }


def list_parameter_tags(parameter: SetParameter, backend: str) -> list[str]:
    """Return the tags of the sets that a parameter stands in, the outermost first, and its own."""
    *sets, name = parameter.path
    hints = parameter.declaration.hints if parameter.declaration else {}
    return [*map(make_camel_name, sets), name_tag(hints, backend, name)]


def find_type_words(architecture: Architecture, component: Component) -> str | None:
    """Return the component type that a component is made from, in words; of what stands inside of an instance the type with
    the names behind it. None for a component without a type.
    """
    parts: list[str] = []
    around: Component | None = component
    while around is not None:
        if around.component_type is not None:
            type_name = around.type_name if not around.component_type.endswith(">") else around.component_type
            return " ".join([type_name.replace("<", " of "), *reversed(parts)])
        parts.append(around.name)
        around = architecture.shells.get(around.parent or "")
    return None
