"""Parameters and operations in documents and on cards: what a component declares, and what counts at a node."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.model.component import Component, ComponentType
from archgen.model.node import Node
from archgen.model.parameter import Operation, Parameter, describe_types, format_parameter
from archgen.model.parameter_values import (
    EVERY_PARAMETER,
    EffectiveParameter,
    describe_origin,
    find_effective_parameters,
)
from archgen.views.inline_text import to_code, to_inlines, topic_link
from archgen.views.lookup import Lookup
from archgen.views.shapes import Block, Column, Inlines, Table, Text, drop_empty_columns, make_columns


def make_parameter_blocks(component: Component | ComponentType) -> list[Block]:
    """Return the tables of the parameters of a component or a type, and of its operations, without those that would be empty."""
    return [table for table in (_make_parameter_table(component), _make_operation_table(component)) if table]


def list_equal_settings(component: Component, component_type: ComponentType) -> list[Block]:
    """Return those tables of an instance that say nothing else than the tables of its type."""
    is_set_equally = component.parameters == component_type.parameters and component.open == component_type.open
    tables = (
        _make_parameter_table(component) if is_set_equally else None,
        _make_operation_table(component) if component.operations == component_type.operations else None,
    )
    return [table for table in tables if table]


def _make_parameter_table(component: Component | ComponentType) -> Table | None:
    rows = tuple(
        (
            to_code(each.name),
            to_code(each.type),
            to_code(format_parameter(each.value))
            if each.value is not None
            else to_inlines(describe_missing_value(each)),
            to_inlines(each.unit),
            to_inlines(describe_limits(each)),
            to_inlines(_describe_remarks(each)),
        )
        for each in component.parameters.values()
    )
    rows += tuple(
        (to_code(_format_open_set(name)), (), (), (), to_inlines("any"), to_inlines("open set"))
        for name in component.open
    )
    columns = make_columns(("Parameter", 1.3), ("Type", 0.7), "Value", ("Unit", 0.5), "May be", ("Remarks", 1.6))
    caption = f"{component.title}: parameters"
    return drop_empty_columns(Table(f"table:set/{_place_of(component)}", caption, columns, rows)) if rows else None


def _make_operation_table(component: Component | ComponentType) -> Table | None:
    rows = tuple(
        (
            to_code(name),
            _type_cell(each.request),
            _type_cell(each.response),
            to_inlines("; ".join(filter(None, (each.call, each.visibility, _on_one_line(each.description))))),
        )
        for name, each in component.operations.items()
    )
    columns = (Column("Operation"), Column("Request", 1.2), Column("Response", 1.2), Column("Remarks", 1.6))
    caption = f"{component.title}: operations"
    return (
        drop_empty_columns(Table(f"table:operations/{_place_of(component)}", caption, columns, rows)) if rows else None
    )


def _place_of(component: Component | ComponentType) -> str:
    """Return what tells the tables of a component from those of a type that is called the same."""
    return f"type/{component.id}" if isinstance(component, ComponentType) else component.id


def _type_cell(types: str | Mapping[str, str] | None) -> Inlines:
    return () if types is None else to_inlines(describe_types(types))


def describe_missing_value(parameter: Parameter) -> str:
    """Say where the value of a parameter without one comes from."""
    return f"from {parameter.handed_from}" if parameter.handed_from else "still to be given"


def describe_limits(parameter: Parameter) -> str:
    """Say what values a parameter may have."""
    parts = []
    if parameter.range is not None:
        parts.append(f"{format_parameter(parameter.range[0])} to {format_parameter(parameter.range[1])}")
    if parameter.choices is not None:
        parts.append(", ".join(map(format_parameter, parameter.choices)))
    return "; ".join(parts)


def _describe_remarks(parameter: Parameter) -> str:
    read_only = "read-only" if parameter.read_only else ""
    return "; ".join(filter(None, (read_only, parameter.visibility, _on_one_line(parameter.description))))


def _on_one_line(text: str | None) -> str:
    return " ".join((text or "").split())


def make_effective_table(lookup: Lookup, node: Node) -> Table | None:
    """List the parameters of a node with the values that count; where they come from, if not all are the node's own."""
    parameters = find_effective_parameters(lookup.architecture, node)
    shows_origin = any(each.origin != "node" for each in parameters.values())
    rows = tuple(
        (
            to_code(each.name),
            to_inlines(_value_run(lookup, node, each)),
            *((to_inlines(name_origin(each)),) if shows_origin else ()),
        )
        for each in parameters.values()
    )
    columns = (Column("Parameter"), Column("Value"), *((Column("From"),) if shows_origin else ()))
    return Table(f"table:parameters/{node.id}", f"{node.id}: parameters", columns, rows) if rows else None


def _value_run(lookup: Lookup, node: Node, parameter: EffectiveParameter) -> Text:
    """Return a parameter's value, as a link where it is the name of a topic, service or action."""
    text = describe_value_text(node, parameter)
    if parameter.origin == "none":
        return Text(text, muted=True)
    return topic_link(text) if text in lookup.architecture.topics else Text(text, code=True)


def describe_value_text(node: Node, parameter: EffectiveParameter) -> str:
    """Return the value that counts as text, a command by its words; where nobody gives one, where it is to come from."""
    if parameter.origin == "none":
        return describe_missing_value(parameter.declaration) if parameter.declaration else ""
    if parameter.origin == "command":
        return " ".join(node.parameter_commands.get(parameter.name, ()))
    return format_parameter(parameter.value)


def name_origin(parameter: EffectiveParameter) -> str:
    """Return where a value comes from, in a word; a file by its path."""
    words = {"ros": "all nodes", "component": "component", "command": "output of a command", "node": "node", "none": ""}
    return parameter.at.file if parameter.origin == "file" else words[parameter.origin]


def list_parameter_lines(component: Component | ComponentType) -> Iterator[str]:
    """Yield what a component declares, one line a parameter, for its card."""
    for each in component.parameters.values():
        value = format_parameter(each.value) if each.value is not None else f"? ({describe_missing_value(each)})"
        details = ", ".join(filter(None, (each.type, describe_limits(each), "read-only" if each.read_only else "")))
        yield " ".join(filter(None, (f"{each.name} = {value}", each.unit, f"({details})" if details else "")))
    yield from (f"{_format_open_set(name)}: anything" for name in component.open)


def _format_open_set(name: str) -> str:
    return name if name == EVERY_PARAMETER else f"{name}.*"


def list_operation_lines(component: Component | ComponentType) -> Iterator[str]:
    """Yield the operations of a component, one a line, for its card."""
    return (_describe_operation(each) for each in component.operations.values())


def _describe_operation(operation: Operation) -> str:
    request = describe_types(operation.request) if operation.request else ""
    response = f" -> {describe_types(operation.response)}" if operation.response else ""
    return f"{operation.id}({request}){response}" + (f", {operation.call}" if operation.call else "")


def list_effective_lines(lookup: Lookup, node: Node) -> Iterator[str]:
    """Yield the values that count at a node, each with its place, for its card."""
    for each in find_effective_parameters(lookup.architecture, node).values():
        if each.origin == "none":
            yield f"{each.name} = ? ({describe_missing_value(each.declaration) if each.declaration else '?'})"
        else:
            yield f"{each.name} = {describe_value_text(node, each)} <- {describe_origin(each)}"
